// V-carving: a tool with a sloping edge cuts a region so that its edges at the surface are exactly those of
// the region, with corners run out to their points. Also the two parts of an inlay.
//
//   const auto made = v_carve(letters, v_bit, {.cut = {.depth = mm(3), .feed = mm_per_min(900)}},
//   diagnostics); const auto floor = v_carve_floor(letters, v_bit, {.cut = {.depth = mm(3)}}, diagnostics);
//   const auto rest = pocket(*floor, mill, {.cut = {.depth = mm(3), .feed = mm_per_min(900)}}, diagnostics);
//
// At each point of the medial axis (medial_axis.h) the tool is as deep as its edge is as wide as the
// inscribed circle there. Where that is deeper than the depth, the tool follows the walls at the depth, and a
// flat floor is left to another tool.
#pragma once

#include <optional>

#include "kerf/op/operation.h"

namespace kerf {

struct VCarveOptions {
  /// depth: the maximum below `top`; 0: as deep as the edge of the tool gets wider. entry: of walls cut at
  /// the depth. allowance has no effect.
  CutOptions cut{.entry = {.kind = EntryKind::ramp}};
  /// Where the region has its exact shape, below `top`; above it the tool cuts wider.
  Length start{};
};
/// `unreached` is the flat floor less what the tip of the tool clears along the walls, and what is narrower
/// than a flat tip. Errors also for tools without a sloping edge and for a depth beyond that edge.
std::optional<Operation> v_carve(const Region& region, const Tool& tool, const VCarveOptions& options,
                                 Diagnostics& diagnostics);
/// The flat floor that v_carve leaves at the depth, as far as the walls: the region of a pocket for another
/// tool. Empty where all is narrower.
std::optional<Region> v_carve_floor(const Region& region, const Tool& tool, const VCarveOptions& options,
                                    Diagnostics& diagnostics);

/// The plug of an inlay, for a pocket that v_carve has cut with the same tool and depth. Turned over and
/// inserted, its walls lie on those of the pocket.
struct InlayOptions {
  CutOptions cut{.entry = {.kind = EntryKind::ramp}};  ///< depth: of the pocket, > 0
  Length glue_gap{};  ///< between the face of the plug and the floor of the pocket, >= 0
  Length base_gap{};  ///< between the material around the plug and the surface around the pocket, >= 0
  Length margin{};  ///< width of the floor around the plug; 0: twice the diameter of the tool. At least what
                    ///< the carving needs
};
/// The plug is mirrored in X about the centre of the region's bounding box: its outline at the depth less
/// the glue gap is that of the pocket. It is surrounded by walls down to the base gap below that.
std::optional<Operation> inlay_plug(const Region& region, const Tool& tool, const InlayOptions& options,
                                    Diagnostics& diagnostics);
/// The floor around the plug, at the depth of `inlay_plug_depth`: the region of a pocket for another tool.
std::optional<Region> inlay_plug_floor(const Region& region, const Tool& tool, const InlayOptions& options,
                                       Diagnostics& diagnostics);
Length inlay_plug_depth(const InlayOptions& options);

}  // namespace kerf
