// The simulator: what a toolpath leaves of the stock, what it touches that it should not, and which step made
// which surface.
//
//   auto path = std::make_shared<const Toolpath>(std::move(program.path));
//   std::optional<Simulation> result = simulate({path, tools, stock}, diagnostics);
//
// What is left is a Workpiece (workpiece.h). Its surface is a mesh (mesh.h, with exact edges exact_mesh.h),
// which can be drawn (render.h).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/sim/workpiece.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

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
