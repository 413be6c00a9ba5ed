// Fixtures: clamps, vices, screws. No part of a tool may touch them, neither at feed nor at rapid speed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

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

}  // namespace kerf
