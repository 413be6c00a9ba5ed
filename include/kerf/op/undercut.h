// Slots and keyholes: what undercutting tools make (dovetails, T-slots, keyhole bits), which can neither be
// plunged nor lifted where they cut.
//
//   const auto made = keyhole({{10, 20}}, bit, {.cut = {.depth = mm(6), .feed = mm_per_min(500)},
//       .length = mm(12), .angle = degrees(90)}, diagnostics);
//
// Frame and errors as in operation.h. The depth is cut in one pass.
#pragma once

#include <optional>
#include <vector>

#include "kerf/op/operation.h"

namespace kerf {

struct KeyholeOptions {
  CutOptions cut{};
  Length length{};     ///< from the entry to the end of the slot, > 0
  Angle angle{};       ///< direction of the slot from the entry, from +x
  Length clearance{};  ///< by which the slot is wider than the tool, cut by passes on both sides
};
/// At each point the tool goes down, along the slot, back to the point, and up.
std::optional<Operation> keyhole(const std::vector<Point2>& points, const Tool& tool,
                                 const KeyholeOptions& options, Diagnostics& diagnostics);

struct SlotOptions {
  CutOptions cut{};
  double stepover = 0.4;  ///< of passes beside each other, as a fraction of the tool's diameter
  Length width{};         ///< of the slot where the tool is widest; 0: the diameter
  /// How far the tool's axis goes beyond both ends, as a fraction of its diameter: it goes down and up there,
  /// outside of the material.
  double overhang = 0.6;
};
/// Along open outlines that start and end at the edge of the material: first the centre line, then wider.
std::optional<Operation> slot(const std::vector<Outline>& outlines, const Tool& tool,
                              const SlotOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
