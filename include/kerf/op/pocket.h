// Pockets: all material inside a region, down to a floor. Holes of the region are islands that remain. Slots
// along outlines, and facing.
//
//   const auto made = pocket(region, tool, {.cut = {.depth = mm(6), .stepdown = mm(2),
//       .feed = mm_per_min(900)}, .stepover = 0.4}, diagnostics);
//
// The tool's axis stays at least the tool's radius inside the region, so that nothing outside of it is cut.
// All that the tool can reach is removed, at any stepover: see docs/manual/operations.md.
#pragma once

#include <optional>
#include <vector>

#include "kerf/op/operation.h"

namespace kerf {

enum class PocketPattern : std::uint8_t {
  offset,   ///< rings parallel to the walls, from the inside to the outside
  spiral,   ///< rings that lie around one another as one path outwards, others as for offset
  zigzag,   ///< parallel lines in alternating directions, then a ring along the walls
  adaptive  ///< from a helix outwards, with an engagement angle within a limit: loops in slots and corners,
            ///< fronts elsewhere. Slots narrower than 1.125 diameters are left, with a warning
};

struct PocketOptions {
  CutOptions cut{};
  double stepover = 0.4;  ///< distance of neighbouring paths as a fraction of the tool's diameter, (0, 1]
  PocketPattern pattern = PocketPattern::offset;
  Angle angle{};    ///< of the lines of a zigzag, from +x
  Length finish{};  ///< left on the walls, and then removed by one pass at the full depth
  /// Of an adaptive pocket: the maximum engagement angle, between the point of the tool's circle that cuts
  /// deepest into the wall and the last one in material; from 15 to 90 degrees. Entries are not within it.
  Angle engagement = degrees(60);
};
std::optional<Operation> pocket(const Region& region, const Tool& tool, const PocketOptions& options,
                                Diagnostics& diagnostics);

/// Rest machining: only what a pocket of the same region by an earlier tool has left, with the same options
/// but for the tool. Also cuts what is up to the tool's diameter around that. op_empty if nothing is left
/// that the tool could reach.
std::optional<Operation> rest_pocket(const Region& region, const Tool& earlier, const Tool& tool,
                                     const PocketOptions& options, Diagnostics& diagnostics);

struct TrochoidalSlotOptions {
  CutOptions cut{};
  Length width{};                  ///< of the slot, at least 1.125 times the tool's diameter
  double stepover = 0.4;           ///< maximum distance of neighbouring loops, as of a pocket
  Angle engagement = degrees(60);  ///< the maximum, as of an adaptive pocket
};
/// A slot wider than the tool along outlines, open or closed, by trochoidal loops: all within half the width
/// of an outline, so that the ends are round and half the width beyond those of an open one. Outlines that
/// intersect themselves or each other make one slot.
std::optional<Operation> trochoidal_slot(const std::vector<Outline>& outlines, const Tool& tool,
                                         const TrochoidalSlotOptions& options, Diagnostics& diagnostics);

struct FacingOptions {
  CutOptions cut{};
  double stepover = 0.4;  ///< as of a pocket
  double overhang =
      0.6;        ///< how far the tool's axis leaves the region, as a fraction of its diameter: >= 0.5
  Angle angle{};  ///< of the lines, from +x
};
/// Removes all above a region with parallel lines; the tool leaves the region on all sides, and its outline
/// is no wall.
std::optional<Operation> facing(const Region& region, const Tool& tool, const FacingOptions& options,
                                Diagnostics& diagnostics);

}  // namespace kerf
