// Operations of end mills and engravers: pockets, contours, V-carving, undercuts, threads. Holes are in
// holes.h.
//
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

/// Cuts beyond inner corners, which a tool leaves round, so that square corners of another part fit.
enum class BoneKind : std::uint8_t {
  none,
  dog_bone,  ///< along the bisector until the tool touches the corner
  t_bone     ///< along one of the edges until the tool touches the corner
};
enum class BoneEdge : std::uint8_t { longer, shorter };
struct BoneOptions {
  BoneKind kind = BoneKind::none;
  BoneEdge edge = BoneEdge::longer;  ///< of a T-bone: along which of the two edges
  Angle angle = degrees(150);        ///< wider corners have none
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
  BoneOptions bones{};  ///< of an adaptive pocket only with `finish`, whose pass cuts them
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

// Contours: the tool follows outlines, or the boundary of a region on one side of it.
//
//   const auto made = contour(part, tool, {.cut = {.depth = mm(3), .feed = mm_per_min(600)},
//       .side = ContourSide::outside}, diagnostics);
//
// Holes and inner parts are cut before what surrounds them. With tabs, parts stay connected to the material
// around them.

struct ContourOptions {
  CutOptions cut{.entry = {.kind = EntryKind::ramp}};
  ContourSide side = ContourSide::outside;
  Lead lead_in{}, lead_out{};
  Length overlap{};   ///< how far the tool continues along a wall beyond its start
  Length finish{};    ///< left by all passes, and then removed by one pass at the full depth
  TabOptions tabs{};  ///< where the height is above 0
  BoneOptions bones{};
};
std::optional<Operation> contour(const Region& region, const Tool& tool, const ContourOptions& options,
                                 Diagnostics& diagnostics);

/// The axis of the tool follows the outlines, open or closed, in their direction; CutOptions::direction and
/// allowance have no effect.
std::optional<Operation> contour_on(const std::vector<Outline>& outlines, const Tool& tool,
                                    const CutOptions& options, Diagnostics& diagnostics);

struct IsolationOptions {
  CutOptions cut{};  ///< allowance has no effect
  int passes = 1;    ///< around each copper, beside each other; `width` precedes them
  Length width{};    ///< of the isolation; 0: by `passes`
  double overlap =
      0.5;  ///< of neighbouring passes, as a fraction of the tool's diameter at the depth, [0, 1)
};
/// Cuts around copper, outside of it and inside of its holes, as wide as the passes are. What then remains
/// between coppers and is narrower than the tool is cut as well. Gaps between coppers that are narrower than
/// the tool stay, with one warning.
std::optional<Operation> isolation(const Region& copper, const Tool& tool, const IsolationOptions& options,
                                   Diagnostics& diagnostics);

struct ChamferOptions {
  CutOptions cut{.entry = {.kind = EntryKind::ramp}};  ///< depth: of the chamfer; 0: by `width`
  Length width{};                                      ///< seen from above; 0: by the depth
  Length tip_offset = mm(0.2);  ///< of the tip below the chamfer, > 0: the flank cuts, not the tip
  ContourSide side = ContourSide::outside;
  Lead lead_in{}, lead_out{};
  Length overlap{};
};
/// Cuts along the edges of a region at `top`, on the side without material: the flank of a tool with
/// a cone makes a chamfer at the angle of that cone. Errors also for tools without a cone there.
std::optional<Operation> chamfer(const Region& region, const Tool& tool, const ChamferOptions& options,
                                 Diagnostics& diagnostics);

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

/// Of a carved surface, along its normal seen from above: from the cone through the boundary of the region.
inline constexpr Length kCarvingTolerance = mm(0.005);

/// What another tool leaves of a flat floor, to be carved as well: rings at the depth, with ridges between.
struct FloorCorners {
  Region left{};            ///< `unreached` of the operation that clears the floor
  Length ridge = mm(0.05);  ///< the height of ridges above the floor, at most
};

struct VCarveOptions {
  /// depth: the maximum below `top`; 0: as deep as the edge of the tool gets wider. entry: of walls cut at
  /// the depth. allowance has no effect.
  CutOptions cut{.entry = {.kind = EntryKind::ramp}};
  /// Where the region has its exact shape, below `top`; above it the tool cuts wider.
  Length start{};
  Length tolerance = kCarvingTolerance;
  FloorCorners corners{};
};
/// `unreached` is the flat floor less what the tip of the tool clears along the walls and less the corners,
/// and what is narrower than a flat tip. Errors also for tools without a sloping edge and for a depth beyond
/// that edge.
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
  Length tolerance = kCarvingTolerance;
  FloorCorners corners{};
};
/// The plug is mirrored in X about the centre of the region's bounding box: its outline at the depth less
/// the glue gap is that of the pocket. It is surrounded by walls down to the base gap below that.
std::optional<Operation> inlay_plug(const Region& region, const Tool& tool, const InlayOptions& options,
                                    Diagnostics& diagnostics);
/// The floor around the plug, at the depth of `inlay_plug_depth`: the region of a pocket for another tool.
std::optional<Region> inlay_plug_floor(const Region& region, const Tool& tool, const InlayOptions& options,
                                       Diagnostics& diagnostics);
Length inlay_plug_depth(const InlayOptions& options);

// Slots and keyholes: what undercutting tools make (dovetails, T-slots, keyhole bits), which can neither be
// plunged nor lifted where they cut.
//
//   const auto made = keyhole({{10, 20}}, bit, {.cut = {.depth = mm(6), .feed = mm_per_min(500)},
//       .length = mm(12), .angle = degrees(90)}, diagnostics);
//
// Frame and errors as in operation.h. The depth is cut in one pass.

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
  /// How far the tool's axis goes beyond both ends, as a fraction of its diameter, and at least as far as
  /// wide slots need to be cleared there: it goes down and up outside of the material.
  double overhang = 0.6;
};
/// Along open outlines that start and end at the edge of the material: first the centre line, then wider.
std::optional<Operation> slot(const std::vector<Outline>& outlines, const Tool& tool,
                              const SlotOptions& options, Diagnostics& diagnostics);

// Threads by a thread mill, and countersinks by a ball mill.
//
//   const auto made = thread({{{10, 20}, mm(4)}}, mill, {.cut = {.depth = mm(10), .feed = mm_per_min(200)},
//       .pitch = mm(1.25)}, diagnostics);
//
// The hole or rod of a thread must be there: the tool goes down in the hole, or one pitch beside the rod, by
// a rapid where it cannot plunge. Frame and errors as in operation.h.

enum class ThreadHand : std::uint8_t { right, left };
enum class ThreadSide : std::uint8_t {
  inside,  ///< of a hole: the circle is the major diameter, which the tips of the tool reach
  outside  ///< of a rod: the circle is the major diameter, the tips reach 0.6134 pitches below it (ISO 68-1)
};
struct ThreadOptions {
  CutOptions cut{};  ///< depth: of the thread. direction: climb or conventional; stepdown has no effect
  Length pitch{};    ///< > 0
  ThreadHand hand = ThreadHand::right;
  ThreadSide side = ThreadSide::inside;
  int passes = 1;  ///< of equal depth, at increasing depth of the thread
  int teeth = 1;   ///< of the tool, one pitch apart: it turns once for as many pitches
};
std::optional<Operation> thread(const std::vector<Circle>& circles, const Tool& tool,
                                const ThreadOptions& options, Diagnostics& diagnostics);

struct CountersinkOptions {
  CutOptions cut{};           ///< depth: of the cone, from its wide end at `top`. stepdown has no effect
  Angle angle = degrees(90);  ///< of the cone, between its sides
  Length scallop = mm(0.02);  ///< maximum height of material left between two circles
};
/// Cones with the given circles at the top, by circles of a ball mill from the inside out.
std::optional<Operation> countersink(const std::vector<Circle>& circles, const Tool& tool,
                                     const CountersinkOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
