// Holes: drilled at points by cycles, or bored larger than the tool by helices.
//
//   const auto made = drill(points, tool, {.kind = DrillKind::peck, .depth = mm(12), .peck = mm(3),
//       .feed = mm_per_min(100)}, diagnostics);
//
// Frame and errors as in operation.h. Holes are in the order of short rapid travel.
#pragma once

#include <optional>
#include <vector>

#include "kerf/drill.h"
#include "kerf/op/operation.h"

namespace kerf {

struct DrillOptions {
  DrillKind kind = DrillKind::plain;  ///< plain, dwell, chip_break, peck, bore or dwell_bore
  double top = 0.0;                   ///< Z of the surface
  Length depth{};                     ///< below `top`, > 0, to the tip of the tool
  Length peck{};                      ///< depth of a peck
  Duration dwell{};                   ///< at the bottom
  Feed feed{};                        ///< > 0
  double retract_plane = 5.0;         ///< Z of rapids between holes
  Length clearance = mm(0.5);         ///< above `top`, where the tool changes from rapid to feed
  std::string name{};
  Origin where{};
};
std::optional<Operation> drill(const std::vector<Point2>& points, const Tool& tool,
                               const DrillOptions& options, Diagnostics& diagnostics);

struct BoreOptions {
  CutOptions cut{};       ///< stepdown: the pitch of the helix; 0: by Entry::angle
  double stepover = 0.4;  ///< of the helices of a wide bore
};
/// Circular holes with a flat bottom, by a helix to the depth and a full circle there; one helix after the
/// other, from the inside, where the hole is wider than two tools.
std::optional<Operation> bore(const std::vector<Circle>& holes, const Tool& tool, const BoreOptions& options,
                              Diagnostics& diagnostics);

}  // namespace kerf
