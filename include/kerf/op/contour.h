// Contours: the tool follows outlines, or the boundary of a region on one side of it.
//
//   const auto made = contour(part, tool, {.cut = {.depth = mm(3), .feed = mm_per_min(600)},
//       .side = ContourSide::outside}, diagnostics);
//
// Holes and inner parts are cut before what surrounds them. With tabs, parts stay connected to the material
// around them.
#pragma once

#include <optional>
#include <vector>

#include "kerf/op/operation.h"
#include "kerf/op/tabs.h"

namespace kerf {

struct ContourOptions {
  CutOptions cut{.entry = {.kind = EntryKind::ramp}};
  ContourSide side = ContourSide::outside;
  Lead lead_in{}, lead_out{};
  Length overlap{};   ///< how far the tool continues along a wall beyond its start
  Length finish{};    ///< left by all passes, and then removed by one pass at the full depth
  TabOptions tabs{};  ///< where the height is above 0
};
std::optional<Operation> contour(const Region& region, const Tool& tool, const ContourOptions& options,
                                 Diagnostics& diagnostics);

/// The axis of the tool follows the outlines, open or closed, in their direction; CutOptions::direction and
/// allowance have no effect.
std::optional<Operation> contour_on(const std::vector<Outline>& outlines, const Tool& tool,
                                    const CutOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
