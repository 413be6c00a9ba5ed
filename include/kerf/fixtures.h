// Fixtures: clamps, vices, screws. No part of a tool may touch them, neither at feed nor at rapid speed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/progress.h"
#include "kerf/simulation_options.h"
#include "kerf/stock.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"

namespace kerf {

struct Fixture {
  std::string name;  // as the user told it, for messages
  Stock solid;       // a block, or a body
};

/// A step that meets a fixture. One entry a step, fixture and part of the tool.
struct FixtureContact {
  std::size_t fixture = 0;       // index among the fixtures
  std::uint32_t step = 0;        // index in the toolpath
  std::optional<ToolPart> part;  // nothing in rapid moves, where it is the tool as a whole
  Point3 at;                     // mm, the first place met along the move
  Length depth;                  // largest, below the fixture's surface as it stands above
  Volume met;                    // of the fixture, by its columns
};

/// Looks for contacts; in order of steps, each step as if it were the first. A block is tested by its shape,
/// so that no contact over `options.hazard_depth` is missed, and 40,000 columns say how much is met. Of a
/// body a contact can be missed that is less than half a column sideways; its columns are at most
/// `options.resolution` apart (0: as fine as a million of them allows). Appends errors, and returns nothing,
/// as `simulate` does; nothing without an error if stopped.
std::optional<std::vector<FixtureContact>> find_fixture_contacts(const Toolpath& path, const ToolTable& tools,
                                                                 std::span<const Fixture> fixtures,
                                                                 const SimulationOptions& options,
                                                                 Diagnostics& diagnostics,
                                                                 Progress* progress = nullptr);

}  // namespace kerf
