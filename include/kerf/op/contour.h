// Contours: the tool follows outlines, or the boundary of a region on one side of it.
//
//   const auto made = contour(part, tool, {.cut = {.depth = mm(3), .feed = mm_per_min(600)},
//       .side = ContourSide::outside}, diagnostics);
//
// Holes and inner parts are cut before what surrounds them.
#pragma once

#include <optional>
#include <vector>

#include "kerf/op/operation.h"

namespace kerf {

enum class ContourSide : std::uint8_t {
  outside,  ///< the region is the part that remains: around it, and inside its holes
  inside    ///< the region is cut out: along its walls
};
/// The end of an open or closed path on which a tool enters and leaves the wall.
struct Lead {
  Length radius{};  ///< of a quarter circle tangent to the wall; 0: none. Left out where it does not fit
};

struct ContourOptions {
  CutOptions cut{.entry = {.kind = EntryKind::ramp}};
  ContourSide side = ContourSide::outside;
  Lead lead{};
};
std::optional<Operation> contour(const Region& region, const Tool& tool, const ContourOptions& options,
                                 Diagnostics& diagnostics);

/// The axis of the tool follows the outlines, open or closed, in their direction; CutOptions::direction and
/// allowance have no effect.
std::optional<Operation> contour_on(const std::vector<Outline>& outlines, const Tool& tool,
                                    const CutOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
