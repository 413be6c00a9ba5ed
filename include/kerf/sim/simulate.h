// The simulator: what a toolpath leaves of the stock, what it touches that it should not, and which step made
// which surface.
//
//   auto path = std::make_shared<const Toolpath>(std::move(program.path));
//   std::optional<Simulation> result = simulate({path, tools, stock}, diagnostics);
//
// What is left is a Workpiece (workpiece.h). Its surface is a mesh (mesh.h, with exact edges exact_mesh.h),
// which can be drawn (render.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/sim/workpiece.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

// Fixtures: clamps, vices, screws. No part of a tool may touch them, neither at feed nor at rapid speed.

struct Fixture {
  std::string name;  // as specified by the user, for messages
  Stock solid;       // a block, or a body
};

/// A step that touches a fixture. One entry per step, fixture and part of the tool.
struct FixtureContact {
  std::size_t fixture = 0;       // index among the fixtures
  std::uint32_t step = 0;        // index in the toolpath
  std::optional<ToolPart> part;  // nothing for rapids: the whole tool
  Point3 at;                     // mm, the first point touched along the motion
  Length depth;                  // maximum, below the original surface of the fixture
  Volume met;                    // volume of the fixture that is touched, by its columns
};

/// Finds contacts, in the order of steps, each step as if it were the first. A block is tested by its shape,
/// so that no contact above `options.hazard_depth` is missed; about 40,000 columns measure the volume
/// touched. Of a body, a contact can be missed that is less than half a column wide; the pitch of its columns
/// is at most `options.resolution` (0: chosen for about a million columns). Appends errors, and returns
/// nothing, as `simulate` does; nothing without an error if stopped.
std::optional<std::vector<FixtureContact>> find_fixture_contacts(const Toolpath& path, const ToolTable& tools,
                                                                 std::span<const Fixture> fixtures,
                                                                 const SimulationOptions& options,
                                                                 Diagnostics& diagnostics,
                                                                 Progress* progress = nullptr);

/// What a simulation is made from. The toolpath is shared, because the result keeps it.
struct SimulationJob {
  std::shared_ptr<const Toolpath> path;
  ToolTable tools;
  Stock stock;
  SimulationOptions options = {};
};
/// A toolpath that is not owned: it must remain unchanged as long as the simulation of it is used.
inline std::shared_ptr<const Toolpath> borrowed(const Toolpath& path) {
  return {std::shared_ptr<const Toolpath>(), &path};
}

struct Simulation {
  SimulationJob job;  // what it was made from
  Workpiece workpiece;
  Volume stock, removed;
  std::vector<Hazard> hazards;         // in order of steps
  std::vector<float> removed_by_step;  // mm3, one per step of the toolpath
  double seconds = 0.0;                // of the simulation alone
  bool stopped = false;                // interrupted: all is as it was at that moment
  /// The tools as solids and, of a path that is not too long, its sweeps: for meshes with exact edges.
  struct Plan;
  std::shared_ptr<const Plan> plan;
};

/// Cuts the toolpath out of the stock. Appends errors (unknown tool, too many columns) and returns nothing
/// where it cannot run. Steps without effect on material (dwell, notes) are skipped.
std::optional<Simulation> simulate(SimulationJob job, Diagnostics& diagnostics, Progress* progress = nullptr);
/// The same for a toolpath by value, which is copied unless it is moved in.
std::optional<Simulation> simulate(Toolpath path, ToolTable tools, Stock stock,
                                   const SimulationOptions& options, Diagnostics& diagnostics,
                                   Progress* progress = nullptr);

}  // namespace kerf
