// The rows of the operations of mills and drills.
#include "op/mill/rows.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/reach.h"
#include "op/base/row_keys.h"
#include "op/mill/thread_table.h"

#include "kerf/op/holes.h"
#include "kerf/op/mill.h"

namespace kerf::op_detail {
namespace {

constexpr double kMinFloor = 0.1;  // mm2, of a floor that is reported
constexpr std::string_view kTwoHoles =
    "[[shape]]                 # shapes of the job itself, besides those of art\n"
    "name = \"left\"\n"
    "circle = [10, 20, 10]     # x, y, diameter\n\n"
    "[[shape]]\n"
    "name = \"right\"\n"
    "circle = [50, 20, 10]\n\n";
constexpr std::string_view kTrackAndPad =
    "[[shape]]                 # the copper, besides that of art\n"
    "name = \"track\"\n"
    "rectangle = [9, 9, 20, 11]\n"
    "corner = 1                # radius\n\n"
    "[[shape]]\n"
    "name = \"neighbour\"\n"
    "circle = [10, 13, 2]      # x, y, diameter\n\n";
// ------------------------------------------------------------------------------- pockets, contours, faces

struct RestPocketOptions : PocketOptions {
  std::optional<int> rest_tool;
};

/// A pocket, or what an earlier tool has left of it.
std::optional<Operation> pocketed(const Region& region, const PocketOptions& options,
                                  const std::optional<int>& rest_tool, const CutWork& work, Diagnostics& d) {
  if (!rest_tool) return pocket(region, *work.tool, options, d);
  const Tool* earlier = work.tool_of(*rest_tool, d);
  return earlier != nullptr ? rest_pocket(region, *earlier, *work.tool, options, d) : std::nullopt;
}

CutKeyText engagement_text() {
  return {.name = "engagement",
          .meaning = "maximum engagement angle of adaptive pockets and trochoidal slots",
          .example = "60",
          .range = within(15, 90)};
}

/// The keys of pockets behind those of all mills.
template <class Options>
Keys<Options>& pocket_keys(Keys<Options>& keys) {
  return keys
      .add(
          {.name = "pattern", .meaning = "paths of the pocket"},
          [](Options & o) -> auto& { return o.pattern; },
          Names<PocketPattern>{{"offset", PocketPattern::offset},
                               {"spiral", PocketPattern::spiral},
                               {"zigzag", PocketPattern::zigzag},
                               {"adaptive", PocketPattern::adaptive}})
      .add(
          engagement_text(), [](Options & o) -> auto& { return o.engagement; })
      .add(
          {.name = "angle", .meaning = "direction of the lines, from +X", .example = "0"},
          [](Options & o) -> auto& { return o.angle; })
      .finish();
}

template <class Options>
Keys<Options>& bone_keys(Keys<Options>& keys) {
  return keys
      .add(
          {.name = "bones",
           .meaning = "cuts beyond inner corners, so that square ones fit: along the bisector, or an edge"},
          [](Options & o) -> auto& { return o.bones.kind; },
          Names<BoneKind>{
              {"none", BoneKind::none}, {"dog-bone", BoneKind::dog_bone}, {"t-bone", BoneKind::t_bone}})
      .add(
          {.name = "bone-edge", .meaning = "edge of the corner along which a t-bone goes", .needs = "bones"},
          [](Options & o) -> auto& { return o.bones.edge; },
          Names<BoneEdge>{{"longer", BoneEdge::longer}, {"shorter", BoneEdge::shorter}})
      .add(
          {.name = "bone-angle",
           .meaning = "corners wider than this have no bone",
           .example = "150",
           .range = within(1, 179),
           .needs = "bones"},
          [](Options & o) -> auto& { return o.bones.angle; });
}

CutRow pocket_row() {
  using Options = RestPocketOptions;
  Keys<Options> keys;
  keys.selection().tool().levels().stepdown().stepover().rates().allowance().direction().entry().combine();
  bone_keys(pocket_keys(keys)).rest_tool();
  return row_of({.name = "pocket",
                 .sentence = "Cut all inside a region; its holes are islands.",
                 .cuts = "what is cut out; outlines as in `Region`",
                 .example = {.shapes = kPlateShapes}},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return pocketed(*work.region, o, o.rest_tool, work, d);
                });
}

struct LeadContourOptions : ContourOptions, LeadKeys {};

CutRow contour_row() {
  using Options = LeadContourOptions;
  Keys<Options> keys;
  keys.selection().tool().levels().stepdown().rates().allowance().direction().entry().combine();
  keys.side("side of the outlines that is cut").finish().leads("0").tabs();
  bone_keys(keys);
  return row_of(
      {.name = "contour",
       .sentence = "Cut along the boundary of a region.",
       .cuts = "the part (side 'outside': around it and inside its holes) or the opening ('inside')",
       .example = {.shapes = kPlateShapes},
       .cuts_out = true},
      keys, [](Options o, const CutWork& work, Diagnostics& d) {
        o.lead_in = o.in(), o.lead_out = o.out();
        return contour(*work.region, *work.tool, o, d);
      });
}

CutRow isolation_row() {
  using Options = IsolationOptions;
  Keys<Options> keys;
  keys.selection().tool().levels("0.1").stepdown("0").rates().direction().entry().combine();
  keys.add(
          {.name = "passes",
           .meaning = "number of passes beside each other",
           .example = "2",
           .range = within(1, 1000)},
          [](Options & o) -> auto& { return o.passes; })
      .add(
          {.name = "width",
           .meaning = "width of the isolation around the copper; 0: by passes",
           .example = "0",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.width; })
      .add(
          {.name = "overlap",
           .meaning = "overlap of neighbouring passes, as a fraction of the diameter of the tool",
           .example = "0.5",
           .range = within(0, 0.95)},
          [](Options & o) -> auto& { return o.overlap; });
  return row_of({.name = "isolation",
                 .sentence = "Isolate the copper of a circuit board by cuts around it.",
                 .cuts = "the copper that stays",
                 .example = {.shapes = kTrackAndPad, .tool = "V d=3 angle=30 tip=0.2"}},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return isolation(*work.region, *work.tool, o, d);
                });
}

struct LeadChamferOptions : ChamferOptions, LeadKeys {};

CutRow chamfer_row() {
  using Options = LeadChamferOptions;
  Keys<Options> keys;
  keys.selection().tool().top().add(
      {.name = "width",
       .meaning = "width of the chamfer, seen from above; 0: by depth",
       .example = "1",
       .range = at_least(0)},
      [](Options & o) -> auto& { return o.width; });
  keys.own_depth("0", "by width")
      .add(
          {.name = "tip-offset",
           .meaning = "how far the tip is below the chamfer, which the flank cuts",
           .example = "0.2",
           .range = above(0)},
          [](Options & o) -> auto& { return o.tip_offset; })
      .stepdown("0")
      .rates()
      .direction()
      .entry()
      .combine()
      .side("side of the outlines that is cut")
      .leads("0");
  return row_of(
      {.name = "chamfer",
       .sentence = "Chamfer or deburr the edges of a region, by the flank of a V tool.",
       .cuts = "the part (side 'outside': its edge and those of its holes) or the opening ('inside')",
       .example = {.shapes = kPlateShapes, .tool = "V d=6 angle=90"}},
      keys, [](Options o, const CutWork& work, Diagnostics& d) {
        o.lead_in = o.in(), o.lead_out = o.out();
        return chamfer(*work.region, *work.tool, o, d);
      });
}

struct EngraveOptions {
  CutOptions cut = ContourOptions{}.cut;
};

CutRow engrave_row() {
  using Options = EngraveOptions;
  Keys<Options> keys;
  keys.selection().tool().levels().stepdown().rates().entry();
  return row_of({.name = "engrave",
                 .sentence = "Cut along outlines, open or closed, with the axis of the tool.",
                 .cuts = "lists of points and arcs as in `Region`; `text_outlines` makes those of texts",
                 .input = CutInput::outlines,
                 .example = {.shapes = kLineAndText}},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return contour_on(work.outlines(), *work.tool, o.cut, d);
                });
}

CutRow face_row() {
  using Options = FacingOptions;
  Keys<Options> keys;
  keys.selection().tool().levels().stepdown().stepover().rates().entry().combine().add(
      {.name = "angle", .meaning = "direction of the lines, from +X", .example = "0"},
      [](Options & o) -> auto& { return o.angle; });
  return row_of({.name = "face",
                 .sentence = "Cut all above a region with parallel lines that leave it on all sides.",
                 .cuts = "the surface",
                 .input = CutInput::region_or_stock,
                 .example = {.shapes = kFrameShape}},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return facing(*work.region, *work.tool, o, d);
                });
}

// ------------------------------------------------------------------------------------------- holes, slots

/// Which of the selected circles are holes of the operation, and their size.
struct HoleKeys {
  std::optional<Length> min_diameter{}, max_diameter{};
  std::string thread;  ///< empty: none

  bool selects() const { return min_diameter || max_diameter; }
};

template <class Options>
Keys<Options>& hole_keys(Keys<Options>& keys, std::string_view of_thread) {
  return keys
      .add(
          {.name = "min-diameter",
           .meaning = "only circles of at least this diameter",
           .example = "0",
           .range = at_least(0),
           .as_comment = true},
          [](Options & o) -> auto& { return o.holes.min_diameter; })
      .add(
          {.name = "max-diameter",
           .meaning = "only circles of at most this diameter",
           .example = "6",
           .range = at_least(0),
           .as_comment = true},
          [](Options & o) -> auto& { return o.holes.max_diameter; })
      .add(
          {.name = "thread", .meaning = of_thread, .example = "\"M6\"", .as_comment = true},
          [](Options & o) -> auto& { return o.holes.thread; });
}

/// The circles within the diameters. False, with an error, where these are given and there is none.
bool select_circles(const HoleKeys& holes, const CutOptions& cut, std::vector<Circle>& circles,
                    Diagnostics& d) {
  if (!holes.selects()) return true;
  const double rounding = cut.tolerance.chord.mm();
  const double low = holes.min_diameter.value_or(Length{}).mm() - rounding;
  const double high = holes.max_diameter ? holes.max_diameter->mm() + rounding : INFINITY;
  std::erase_if(circles, [&](const Circle& c) {
    const double diameter = 2.0 * c.radius.mm();
    return diameter < low || diameter > high;
  });
  return !circles.empty() ||
         fail(cut, codes::op_empty, "no circle is within min-diameter and max-diameter", d);
}

/// Circles of one size at all points, once where circles of the art are concentric.
std::vector<Circle> circles_at(const std::vector<Point2>& points, Length diameter) {
  constexpr double kSame = 1e-3;  // mm
  std::vector<Circle> circles;
  std::set<std::pair<double, double>> done;
  for (const Point2 p : points)
    if (done.emplace(std::round(p.x / kSame), std::round(p.y / kSame)).second)
      circles.push_back({p, 0.5 * diameter});
  return circles;
}
std::vector<Point2> centres_of(const std::vector<Circle>& circles) {
  std::vector<Point2> points;
  for (const Circle& c : circles) points.push_back(c.centre);
  return points;
}

struct DrillRowOptions : DrillOptions {
  std::optional<DrillDepth> given_depth_of{};
  HoleKeys holes{};
};

/// Whether a drill is the one for a thread.
bool drills_for(const std::string& name, const Tool& tool, const CutOptions& cut, Diagnostics& d) {
  constexpr double kOff = 0.1;  // of the pitch
  const auto thread = thread_size(name, cut, d);
  if (!thread) return false;
  if (std::abs(tool.diameter.mm() - thread->tap_drill.mm()) <= kOff * thread->pitch.mm()) return true;
  return fail(cut, codes::op_option,
              fmt::format("tool {} of {:.4g} mm is not the drill for the thread {}, which has {:.4g} mm",
                          tool.number, tool.diameter.mm(), name, thread->tap_drill.mm()),
              d);
}

std::optional<Operation> drilled(const DrillRowOptions& o, const CutWork& work, Diagnostics& d) {
  CutOptions cut;  // what messages need
  cut.name = o.name, cut.where = o.where;
  if (!o.holes.thread.empty() && !drills_for(o.holes.thread, *work.tool, cut, d)) return std::nullopt;
  std::vector<Circle> circles = work.circles;
  if (!select_circles(o.holes, cut, circles, d)) return std::nullopt;
  return drill(o.holes.selects() ? centres_of(circles) : work.points, *work.tool, o, d);
}

CutRow drill_row() {
  using Options = DrillRowOptions;
  Keys<Options> keys;
  keys.selection().tool().levels().feed().retract().clearance();
  keys.add(
          {.name = "depth-of",
           .meaning = "what reaches the depth: the tip of the drill, or its full diameter",
           .example = "\"tip\"",
           .otherwise = "tip; with through: diameter"},
          [](Options & o) -> auto& { return o.given_depth_of; },
          Names<std::optional<DrillDepth>>{{"tip", DrillDepth::tip}, {"diameter", DrillDepth::diameter}})
      .add(
          {.name = "cycle", .meaning = "cycle of the holes", .example = "\"peck\""},
          [](Options & o) -> auto& { return o.kind; },
          Names<DrillKind>{{"plain", DrillKind::plain},
                           {"dwell", DrillKind::dwell},
                           {"peck", DrillKind::peck},
                           {"chip-break", DrillKind::chip_break},
                           {"bore", DrillKind::bore},
                           {"dwell-bore", DrillKind::dwell_bore}})
      .add(
          {.name = "peck", .meaning = "depth of a peck", .example = "2", .range = at_least(0)},
          [](Options & o) -> auto& { return o.peck; })
      .add(
          {.name = "dwell",
           .meaning = "at the bottom of a hole",
           .example = "0",
           .range = within(0, limits::kMaxDwellSeconds)},
          [](Options & o) -> auto& { return o.dwell; });
  hole_keys(keys, "thread for which is drilled; other drills are refused");
  return row_of({.name = "drill",
                 .sentence = "Drill holes.",
                 .cuts = "centres of the holes",
                 .input = CutInput::points,
                 .example = {.shapes = kTwoHoles, .tool = "drill d=3 angle=118"}},
                keys, [](Options o, const CutWork& work, Diagnostics& d) {
                  const auto usual = work.operation.through ? DrillDepth::diameter : DrillDepth::tip;
                  o.depth_of = o.given_depth_of.value_or(usual);
                  return drilled(o, work, d);
                });
}

struct BoreRowOptions : BoreOptions {
  HoleKeys holes{};
};

std::optional<Operation> bored(const BoreRowOptions& o, const CutWork& work, Diagnostics& d) {
  std::vector<Circle> circles = work.circles;
  if (!select_circles(o.holes, o.cut, circles, d)) return std::nullopt;
  if (!o.holes.thread.empty()) {
    const auto thread = thread_size(o.holes.thread, o.cut, d);
    if (!thread) return std::nullopt;
    circles = circles_at(o.holes.selects() ? centres_of(circles) : work.points, thread->tap_drill);
  }
  return bore(circles, *work.tool, o, d);
}

CutRow bore_row() {
  using Options = BoreRowOptions;
  Keys<Options> keys;
  keys.selection().tool().levels().stepdown().stepover().rates().allowance().direction().entry_angle();
  hole_keys(keys, "thread for which holes are made, at points too: the diameter is that of its drill");
  return row_of({.name = "bore",
                 .sentence = "Mill round holes by helices.",
                 .cuts = "the holes: x, y and radius",
                 .input = CutInput::circles,
                 .example = {.shapes = kTwoHoles}},
                keys,
                [](const Options& o, const CutWork& work, Diagnostics& d) { return bored(o, work, d); });
}

CutRow keyhole_row() {
  using Options = KeyholeOptions;
  Keys<Options> keys;
  keys.selection()
      .tool()
      .levels()
      .rates()
      .direction()
      .add(
          {.name = "length",
           .meaning = "length of the keyhole, from its entry",
           .example = "12",
           .range = above(0),
           .required = true},
          [](Options & o) -> auto& { return o.length; })
      .add(
          {.name = "angle", .meaning = "direction of the keyhole from its entry, from +X", .example = "0"},
          [](Options & o) -> auto& { return o.angle; })
      .add(
          {.name = "slot-clearance",
           .meaning = "by which the keyhole is wider than its tool",
           .example = "0.2",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.clearance; });
  return row_of({.name = "keyhole",
                 .sentence = "Cut keyholes: down, along a slot, back, and up.",
                 .cuts = "where the tool goes down",
                 .input = CutInput::points,
                 .example = {.shapes = kTwoHoles, .tool = "keyhole d=9.5 head=4 neck=4.8"}},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return keyhole(work.points, *work.tool, o, d);
                });
}

CutRow slot_row() {
  using Options = SlotOptions;
  Keys<Options> keys;
  keys.selection().tool().levels().stepover().rates().direction().add(
      {.name = "width",
       .meaning = "width of the slot where the tool is widest; 0: the diameter",
       .example = "0",
       .range = at_least(0)},
      [](Options & o) -> auto& { return o.width; });
  return row_of(
      {.name = "slot",
       .sentence = "Cut slots between edges of the material, with dovetail or T-slot tools.",
       .cuts = "open outlines from edge to edge; the tool goes down and up outside",
       .input = CutInput::outlines,
       .example = {.shapes = "[[shape]]                 # shapes of the job itself, besides those of art\n"
                             "name = \"groove\"\n"
                             "line = [[0, 20], [60, 20]]\n\n",
                   .tool = "dovetail d=12.7 flute=9 angle=14",
                   .stock = "0,0,-12 to 60,40,0"}},
      keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
        return slot(work.open, *work.tool, o, d);
      });
}

CutRow trochoidal_slot_row() {
  using Options = TrochoidalSlotOptions;
  Keys<Options> keys;
  keys.selection()
      .tool()
      .levels()
      .stepdown()
      .stepover()
      .rates()
      .direction()
      .entry_angle()
      .add(
          engagement_text(), [](Options & o) -> auto& { return o.engagement; })
      .add(
          {.name = "width",
           .meaning = "width of the slot",
           .example = "9",
           .range = above(0),
           .required = true},
          [](Options & o) -> auto& { return o.width; });
  return row_of(
      {.name = "trochoidal-slot",
       .sentence =
           "Cut slots wider than the tool along outlines, by loops within a limit of the engagement angle.",
       .cuts = "centre lines of the slots, open or closed",
       .input = CutInput::outlines,
       .example = {.shapes = "[[shape]]                 # shapes of the job itself, besides those of art\n"
                             "name = \"path\"\n"
                             "line = [[0, 0], [40, 0], [60, 20]]\n\n"},
       .cuts_out = true},
      keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
        return trochoidal_slot(work.outlines(), *work.tool, o, d);
      });
}

// ----------------------------------------------------------------------------------- threads, countersinks

constexpr CutExample kThreadExample{
    .shapes =
        "[[shape]]                 # shapes of the job itself, besides those of art\n"
        "name = \"hole\"\n"
        "circle = [10, 20, 8.7]    # x, y, diameter\n\n"
        "[[shape]]\n"
        "name = \"thread\"\n"
        "circle = [10, 20, 10]     # the major diameter\n\n",
    .tool = "thread mill minor_diameter=4.6 major_diameter=6 pitch=1.4 length=15",
    .second_tool = "square d=6",
    .before =
        "[[operation]]\n"
        "op = \"bore\"\n"
        "outlines = [\"hole\"]\n"
        "tool = 2\n"
        "depth = 7\n"
        "rpm = 12000\n"
        "feed = 600\n\n"};

struct ThreadRowOptions : ThreadOptions {
  std::string thread;
};

std::optional<Operation> threaded(ThreadRowOptions o, const CutWork& work, Diagnostics& d) {
  if (o.thread.empty() == !(o.pitch > Length{})) {
    fail(o.cut, codes::op_option, "a thread has either a pitch or a name, such as thread = \"M6\"", d);
    return std::nullopt;
  }
  if (o.thread.empty()) return thread(work.circles, *work.tool, o, d);
  const auto size = thread_size(o.thread, o.cut, d);
  if (!size) return std::nullopt;
  o.pitch = size->pitch;
  return thread(circles_at(work.points, size->major), *work.tool, o, d);
}

CutRow thread_row() {
  using Options = ThreadRowOptions;
  Keys<Options> keys;
  keys.selection({.name = "outlines",
                  .meaning = "names of the outlines that are used, as kerf outline reports them",
                  .example = "[\"thread\"]"})
      .tool()
      .levels()
      .rates()
      .direction()
      .add(
          {.name = "side", .meaning = "threads of holes, or of rods"},
          [](Options & o) -> auto& { return o.side; },
          Names<ThreadSide>{{"outside", ThreadSide::outside}, {"inside", ThreadSide::inside}})
      .add(
          {.name = "pitch",
           .meaning = "pitch of the thread; 0: by thread",
           .example = "1.25",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.pitch; })
      .add(
          {.name = "thread",
           .meaning = "the pitch and the diameter by their name; then the circles and points are the centres",
           .example = "\"M6\"",
           .as_comment = true},
          [](Options & o) -> auto& { return o.thread; })
      .add(
          {.name = "hand", .meaning = "hand of the thread"}, [](Options & o) -> auto& { return o.hand; },
          Names<ThreadHand>{{"right", ThreadHand::right}, {"left", ThreadHand::left}})
      .add(
          {.name = "thread-passes",
           .meaning = "number of passes, deeper each time",
           .example = "1",
           .range = within(1, 100)},
          [](Options & o) -> auto& { return o.passes; })
      .add(
          {.name = "thread-teeth",
           .meaning = "number of teeth of the thread mill, one pitch apart",
           .example = "1",
           .range = within(1, 1000)},
          [](Options & o) -> auto& { return o.teeth; });
  return row_of({.name = "thread",
                 .sentence = "Cut threads with a thread mill. The hole or rod must be there.",
                 .cuts = "major diameters: x, y and radius",
                 .input = CutInput::circles,
                 .example = kThreadExample},
                keys,
                [](const Options& o, const CutWork& work, Diagnostics& d) { return threaded(o, work, d); });
}

CutRow countersink_row() {
  using Options = CountersinkOptions;
  Keys<Options> keys;
  keys.selection().tool().levels("3").rates().direction().add(
      {.name = "cone-angle",
       .meaning = "angle of the cone between its sides",
       .example = "90",
       .range = within(10, 170)},
      [](Options & o) -> auto& { return o.angle; });
  return row_of({.name = "countersink",
                 .sentence = "Cut cones from circles down to a depth, with a ball mill.",
                 .cuts = "the circles at the surface: x, y and radius",
                 .input = CutInput::circles,
                 .example = {.shapes = kTwoHoles, .tool = "ball d=6"}},
                keys, [](const Options& o, const CutWork& work, Diagnostics& d) {
                  return countersink(work.circles, *work.tool, o, d);
                });
}

// ---------------------------------------------------------------------------------- V-carving and inlays

enum class InlayPart : std::uint8_t { pocket, plug };

struct CarveOptions : InlayOptions {
  InlayPart part = InlayPart::pocket;
  std::optional<int> floor_tool;
};
struct FloorOptions : RestPocketOptions {
  InlayPart part = InlayPart::pocket;
  Length glue_gap{}, base_gap{}, margin{};
  int carve_tool = 0;

  InlayOptions plug() const { return {cut, glue_gap, base_gap, margin}; }
};

template <class Options>
Keys<Options>& inlay_keys(Keys<Options>& keys) {
  return keys
      .add(
          {.name = "part", .meaning = "part of an inlay: what is carved, or what fits into it, mirrored"},
          [](Options & o) -> auto& { return o.part; },
          Names<InlayPart>{{"pocket", InlayPart::pocket}, {"plug", InlayPart::plug}})
      .add(
          {.name = "glue-gap",
           .meaning = "between the face of a plug and the floor of its pocket",
           .example = "0.3",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.glue_gap; })
      .add(
          {.name = "base-gap",
           .meaning = "between the surfaces around a plug and around its pocket",
           .example = "0.5",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.base_gap; })
      .add(
          {.name = "margin",
           .meaning = "width of the floor around a plug; 0: twice the diameter",
           .example = "0",
           .range = at_least(0)},
          [](Options & o) -> auto& { return o.margin; });
}

/// The operations of the job that clear the floor that an operation carves.
std::vector<const CutOperation*> clearing(const CarveOptions& options, const CutWork& work) {
  std::vector<const CutOperation*> found;
  const CutOperation& own = work.operation;
  for (const CutOperation& other : work.job)
    if (const auto* floor = std::any_cast<FloorOptions>(&other.options);
        floor != nullptr && floor->carve_tool == own.tool && floor->part == options.part &&
        floor->cut.depth == options.cut.depth && other.layers == own.layers && other.outlines == own.outlines)
      found.push_back(&other);
  return found;
}

/// What a tool that clears a floor leaves of it: all where it does not fit in.
Region left_by(const Tool& tool, const Region& floor, const CutOptions& cut) {
  Diagnostics of_other;  // the operation with that tool has its own messages
  auto reached = reach(floor, tool, ReachSide::inside, cut, of_other);
  return reached ? std::move(reached->unreached) : floor;
}

/// What `floor-tool` or the operations of the job leave of the floor.
std::optional<Region> left_of_floor(const CarveOptions& options, const CutWork& work, Diagnostics& d) {
  const bool plug = options.part == InlayPart::plug;
  std::vector<std::pair<const Tool*, Length>> tools;  // with the allowance
  if (options.floor_tool) {
    const Tool* tool = work.tool_of(*options.floor_tool, d);
    if (tool == nullptr) return std::nullopt;
    tools.emplace_back(tool, Length{});
  } else {
    for (const CutOperation* operation : clearing(options, work))
      if (const auto tool = work.tools.find(operation->tool); tool != work.tools.end())
        tools.emplace_back(&tool->second,
                           std::any_cast<const FloorOptions&>(operation->options).cut.allowance);
  }
  if (tools.empty()) return Region{};
  auto left = plug ? inlay_plug_floor(*work.region, *work.tool, options, d)
                   : v_carve_floor(*work.region, *work.tool, {.cut = options.cut}, d);
  if (!left || left->empty()) return left;
  const Region floor = *left;
  CutOptions cut = options.cut;
  if (plug) cut.depth = inlay_plug_depth(options);
  for (const auto& [tool, allowance] : tools) {
    cut.allowance = allowance;
    auto both = combine(*left, left_by(*tool, floor, cut), Boolean::intersect, region_options(cut), d);
    if (!both) return std::nullopt;
    left = std::move(both->region);
  }
  return left;
}

/// Reports the floor that a V-carving leaves, unless an operation of the job clears it.
void note_floor(const CarveOptions& options, const Operation& made, const CutWork& work, Diagnostics& d) {
  const double left = area(made.unreached);
  if (!(left > kMinFloor) || options.floor_tool || !clearing(options, work).empty()) return;
  d.note(codes::op_tool_wide, work.operation.where,
         fmt::format("{}: a floor of {:.4g} mm2 is left", work.operation.name, left))
      .hint = "op = \"vcarve-floor\" with another tool clears it";
}

/// A plug comes no nearer to the floor of the pocket than its gap: ridges may be half as high.
std::optional<Operation> carving(CarveOptions o, const CutWork& work, Diagnostics& d) {
  auto left = left_of_floor(o, work, d);
  if (!left) return std::nullopt;
  o.corners.left = std::move(*left);
  o.corners.ridge = std::max(o.corners.ridge, 0.5 * (o.part == InlayPart::plug ? o.base_gap : o.glue_gap));
  auto made = o.part == InlayPart::pocket
                  ? v_carve(*work.region, *work.tool, {.cut = o.cut, .corners = o.corners}, d)
                  : inlay_plug(*work.region, *work.tool, o, d);
  if (made) note_floor(o, *made, work, d);
  return made;
}

CutRow vcarve_row() {
  using Options = CarveOptions;
  Keys<Options> keys;
  keys.selection().tool().top().own_depth("3", "as deep as the outlines or the cone of the tool permit");
  keys.stepdown().rates().direction().entry().combine();
  inlay_keys(keys).add(
      {.name = "floor-tool",
       .meaning = "the tool that clears the floor: what it leaves is carved, too; else those of the job",
       .example = "1",
       .range = within(0, limits::kMaxToolNumber),
       .as_comment = true,
       .type = CutKeyText::Type::tool},
      [](Options & o) -> auto& { return o.floor_tool; });
  return row_of(
      {.name = "vcarve",
       .sentence = "Carve a region with a V tool: its edges at the surface are exactly those of the "
                   "region.",
       .cuts = "what is carved; with part 'plug' what fits into it, mirrored",
       .example = {.shapes = kStarShape, .tool = "V d=20 angle=60"}},
      keys, carving);
}

/// The floor that the carving tool leaves, by this one.
std::optional<Operation> carved_floor(FloorOptions o, const CutWork& work, Diagnostics& d) {
  const Tool* carver = work.tool_of(o.carve_tool, d);
  if (carver == nullptr) return std::nullopt;
  const bool plug = o.part == InlayPart::plug;
  const InlayOptions inlay = o.plug();
  const auto floor = plug ? inlay_plug_floor(*work.region, *carver, inlay, d)
                          : v_carve_floor(*work.region, *carver, {.cut = o.cut}, d);
  if (!floor) return std::nullopt;
  if (plug) o.cut.depth = inlay_plug_depth(inlay);
  return pocketed(*floor, o, o.rest_tool, work, d);
}

CutRow vcarve_floor_row() {
  using Options = FloorOptions;
  Keys<Options> keys;
  keys.selection().tool().levels("3").stepdown().stepover().rates().allowance().direction().entry().combine();
  inlay_keys(pocket_keys(keys))
      .rest_tool()
      .add(
          {.name = "carve-tool",
           .meaning = "the tool of the vcarve that leaves this floor",
           .example = "2",
           .range = within(0, limits::kMaxToolNumber),
           .required = true,
           .type = CutKeyText::Type::tool},
          [](Options & o) -> auto& { return o.carve_tool; });
  return row_of(
      {.name = "vcarve-floor",
       .sentence = "Clear the flat floor that `vcarve` leaves.",
       .cuts = "as of `vcarve`",
       .example = {.shapes = kStarShape,
                   .tool = "square d=3",
                   .second_tool = "V d=20 angle=60",
                   .before = "[[operation]]             # the walls, and the corners up to their points\n"
                             "op = \"vcarve\"\n"
                             "tool = 2\n"
                             "depth = 3\n"
                             "rpm = 16000\n"
                             "feed = 900\n\n"}},
      keys, carved_floor);
}

}  // namespace

std::vector<CutRow> mill_rows() {
  std::vector<CutRow> rows;
  for (const auto row : {pocket_row, contour_row, engrave_row, face_row, drill_row, bore_row, keyhole_row,
                         slot_row, trochoidal_slot_row, thread_row, countersink_row, chamfer_row,
                         isolation_row, vcarve_row, vcarve_floor_row})
    rows.push_back(row());
  return rows;
}

}  // namespace kerf::op_detail
