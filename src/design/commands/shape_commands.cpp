// Shapes of the plane: made, drawn, cut along or beside, and pocketed; slots of finger joints.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "design/commands/entities.h"
#include "design/commands/outline_values.h"
#include "design/commands/rows.h"
#include "op/mill/pocket_rings.h"

#include "kerf/base/limits.h"
#include "kerf/geom/fit.h"
#include "kerf/geom/offset.h"
#include "kerf/geom/shapes.h"
#include "kerf/op/mill.h"

namespace kerf::design {
namespace {

constexpr Length kCurve = mm(0.005);  // between a Bezier curve and its arcs

template <class T>
T required(std::optional<T> value) {
  if (!value) throw Reported{};
  return std::move(*value);
}

Region region_of(Machine& machine, const std::vector<Outline>& outlines) {
  return required(make_region(outlines, FillRule::even_odd, machine.region_options(), machine.diagnostics()));
}
Region shifted(Machine& machine, const Region& region, double by) {
  return required(offset(region, mm(by), machine.region_options(), machine.diagnostics())).region;
}

// ---- values

std::vector<std::string> shape_list() {
  std::vector<std::string> names;
  for (const PlaneShape& shape : plane_shapes()) names.emplace_back(shape.name);
  return names;
}

Value shape(Machine& machine, Call& call) {
  static const std::vector<std::string> names = shape_list();
  const PlaneShape& made = plane_shapes()[choice(call.text(0), names, "name")];
  std::vector<double> values;
  for (std::size_t i = 1; i < call.size(); ++i) values.push_back(call.number(i));
  return Outlines{{required(make_plane_shape(made, values, machine.where(), machine.diagnostics()))}, true};
}

/// x, y, outer, inner
Value annulus(Machine&, Call& call) {
  const Point2 centre = call.point2(0);
  const double outer = positive(call.number(2), "outer"), inner = positive(call.number(3), "inner");
  if (inner >= outer) refuse(fmt::format("inner must be below outer, not {:g}", inner));
  return Outlines{{as_outline(Circle{centre, mm(outer)}), as_outline(Circle{centre, mm(inner)})}};
}

/// Offset inwards, outwards twice as far, and inwards again: all corners become arcs.
Value round_corners(Machine& machine, Call& call) {
  const double r = positive(call.number(1), "radius");
  Region region = region_of(machine, outlines_given(call, 0));
  for (const double by : {-r, 2 * r, -r}) region = shifted(machine, region, by);
  if (region.empty()) refuse(fmt::format("radius: {:g} mm does not fit into the outline", r));
  return Outlines{std::move(region.loops)};
}

Outline bezier_of(Machine& machine, const Value& control, Length within) {
  FitOptions options;
  options.name = "control";
  options.where = machine.where();
  const std::vector<Point2> points = points_of(control, "control");
  if (points.size() < 3) refuse("control: at least three points are required");
  return required(fit_bezier(points, within, options, machine.diagnostics()));
}
Value bezier(Machine& machine, Call& call) {
  return Outlines{{bezier_of(machine, call[0], mm(positive(call.number(1), "within")))}, true};
}

// ---- drawn and cut

void dxfoutline(Machine& machine, Call& call) {
  const int tool = tool_number(machine, call, 0);
  for (const Outline& outline : outlines_given(call, 1)) draw_outline(machine, tool, outline);
}

/// The region with corners that the tool in use clears; `style` is the argument "corners".
Region relieved(Machine& machine, const Region& region, const std::optional<std::string>& style,
                const Region* limits = nullptr) {
  if (!style) return region;
  ReliefOptions relief;
  relief.diameter = mm(machine.tool().diameter());
  relief.limits = limits;
  const auto named = relief_style_named(*style);
  if (!named) refuse(fmt::format("corners must be \"dog-bone\" or \"t-bone\", not \"{}\"", *style));
  relief.style = *named;
  return required(relieve_corners(region, relief, machine.region_options(), machine.diagnostics()));
}

/// outline, bz, zdepth, offset, corners
void cutoutline(Machine& machine, Call& call) {
  std::vector<Outline> outlines = outlines_given(call, 0);
  const std::size_t side = choice(call.text(3), {"none", "outside", "inside"}, "offset");
  const double z = bottom_of(machine, call.number(1), call.number(2));
  const auto corners = call.optional_text(4);
  if (corners && side != 2) refuse("corners requires the offset \"inside\"");
  const double radius = machine.tool().diameter() / 2;
  if (side != 0) {
    const Region region = relieved(machine, region_of(machine, outlines), corners);
    outlines = shifted(machine, region, side == 1 ? radius : -radius).loops;
  }
  if (outlines.empty())
    refuse(fmt::format("offset: the tool of {:g} mm does not fit into the outline", 2 * radius));
  machine.cut_outlines(outlines, z);
}

using op_detail::Rings;

/// The rings of a cell, those inside of it first.
void cut_cell(Machine& machine, const Rings& rings, std::uint32_t cell, double z) {
  for (const std::uint32_t inner : rings.cells[cell].inner) cut_cell(machine, rings, inner, z);
  machine.cut_outlines(rings.cells[cell].loops, z);
}

/// Rings from the inside to the outside, those of operations: nothing is left between them.
void cut_rings(Machine& machine, const Region& region, double z, double stepover) {
  if (!(stepover > 0.0 && stepover <= 1.0))
    refuse(fmt::format("stepover must be above 0 and at most 1, not {:g}", stepover));
  const double diameter = machine.tool().diameter();
  const Region axis = shifted(machine, region, -diameter / 2);
  if (axis.empty()) refuse(fmt::format("outline: the tool of {:g} mm does not fit into it", diameter));
  CutOptions options;
  options.name = machine.region_options().name;
  options.where = machine.where();
  options.progress = machine.options().progress;
  const Rings rings = required(
      op_detail::pocket_rings(axis, mm(stepover * diameter), diameter / 2, options, machine.diagnostics()));
  for (const std::uint32_t cell : rings.roots) cut_cell(machine, rings, cell, z);
}

CutOptions cut_options(Machine& machine, DepthBelow depth) {
  CutOptions options;
  options.top = depth.top;
  options.depth = mm(depth.depth);
  options.feed = mm_per_min(machine.feed);
  options.plunge = mm_per_min(machine.plunge);
  options.retract_plane = std::max(machine.retract_height, depth.top + options.clearance.mm());
  options.name = machine.region_options().name;
  options.where = machine.where();
  options.progress = machine.options().progress;
  return options;
}

/// The motions of an operation that starts where the tool is.
void run_piece(Machine& machine, const Toolpath& piece) {
  for (const Step& step : piece.steps()) {
    if (!step.is_motion()) continue;
    Point3 to = step.to();
    for (int axis = 0; axis < 3; ++axis)
      if ((step.unknown_axes() >> axis & 1u) != 0) to[axis] = machine.position()[axis];
    if (step.kind() == StepKind::rapid) {
      machine.rapid(to);
    } else if (step.kind() == StepKind::arc) {
      const step::Arc arc = step.arc();
      machine.arc_to(to, arc.centre, arc.turn, arc.extra_turns);
    } else {
      machine.cut(to);
    }
  }
}

/// By the operation of Kerf, which enters on a ramp or a helix, or by loops.
void pocket_by_operation(Machine& machine, const Region& region, DepthBelow depth, double stepover,
                         std::size_t entry) {
  PocketOptions options;
  options.cut = cut_options(machine, depth);
  options.stepover = stepover;
  options.cut.entry.kind = entry == 1 ? EntryKind::ramp : EntryKind::helix;
  if (entry == 3) options.pattern = PocketPattern::adaptive;
  run_piece(machine, required(pocket(region, machine.tool().tool, options, machine.diagnostics())).path);
  machine.lift();
}

/// outline, bz, zdepth, stepover, corners, entry
void cutpocket(Machine& machine, Call& call) {
  const Region region = relieved(machine, region_of(machine, outlines_given(call, 0)), call.optional_text(4));
  const double top = call.number(1), z = bottom_of(machine, top, call.number(2));
  const std::size_t entry = choice(call.text(5), {"plunge", "ramp", "helix", "trochoidal"}, "entry");
  if (entry == 0)
    cut_rings(machine, region, z, call.number(3));
  else
    pocket_by_operation(machine, region, {top, top - z}, call.number(3), entry);
}

/// tool_num, bx, by, bz, xwidth, yheight, zdepth, radius
void cutpocketrectangleround(Machine& machine, Call& call) {
  constexpr double kStepover = 0.4;
  tool_number(machine, call, 0);
  const double z = bottom_of(machine, call.number(3), call.number(6));
  const double radius = positive(call.number(7), "radius");
  const Outline outline = rectangle_outline(rectangle_given(call, 1, 4), Corners::fillet, radius);
  cut_rings(machine, region_of(machine, {outline}), z, kStepover);
}
void cutpocketrectanglerounddxf(Machine& machine, Call& call) {
  cutpocketrectangleround(machine, call);
  draw_rectangle(machine, tool_number(machine, call, 0), rectangle_given(call, 1, 4), Corners::fillet,
                 call.number(7));
}

/// Turned by half a turn about the midpoint of a board's lower edge.
Region turned(const Region& region, double width) { return rotated(region, {width / 2, 0.0}, degrees(180)); }

/// width, depth, count, bz, zdepth, first, fit, corners, bx, by, edge, stepover
void cutfingers(Machine& machine, Call& call) {
  FingerJoint joint;
  joint.width = mm(positive(call.number(0), "width"));
  joint.depth = mm(positive(call.number(1), "depth"));
  joint.count = whole(call.number(2), "count", 3, limits::kMaxHoles);
  joint.ends = call.truth(5) ? FingerJoint::Ends::fingers : FingerJoint::Ends::slots;
  joint.fit = mm(call.number(6));
  joint.overhang = mm(machine.tool().diameter());
  const Point2 at = call.point2(8);
  const bool upper = choice(call.text(10), {"lower", "upper"}, "edge") == 1;
  const double width = joint.width.mm(), z = bottom_of(machine, call.number(3), call.number(4));
  Region slots = required(finger_slots(joint, machine.region_options(), machine.diagnostics()));
  const double slot = joint.width.mm() / joint.count + joint.fit.mm();
  if (slot < machine.tool().diameter() - kFar)
    refuse(fmt::format("count: the tool of {:g} mm does not fit into slots of {:g} mm",
                       machine.tool().diameter(), slot));
  const auto rectangle = make_plane_shape(*plane_shape("rectangle"), {0.0, 0.0, width, 2 * joint.depth.mm()},
                                          machine.where(), machine.diagnostics());
  Region board = region_of(machine, {required(rectangle)});
  if (upper) slots = turned(slots, width), board = turned(board, width);
  const Region cleared = relieved(machine, slots, call.optional_text(7), &board);
  cut_rings(machine, placed(cleared, Placement{at}), z, call.number(11));
}

// ---- curves

/// control, bz, zdepth
void cutbezier(Machine& machine, Call& call) {
  const double z = bottom_of(machine, call.number(1), call.number(2));
  machine.cut_outlines({bezier_of(machine, call[0], kCurve)}, z);
}
void dxfbezier(Machine& machine, Call& call) {
  draw_outline(machine, tool_number(machine, call, 0), bezier_of(machine, call[1], kCurve));
}

}  // namespace

void cut_trochoidal(Machine& machine, const Outline& outline, DepthBelow depth, double width) {
  constexpr double kUsualWidth = 1.5;  // of the tool's diameter
  TrochoidalSlotOptions options;
  options.cut = cut_options(machine, depth);
  options.width = mm(width > 0.0 ? width : kUsualWidth * machine.tool().diameter());
  const auto made = trochoidal_slot({outline}, machine.tool().tool, options, machine.diagnostics());
  run_piece(machine, required(std::move(made)).path);
  machine.lift();
}

void add_shape_commands(Rows& rows) {
  rows.push_back(
      with_further(making<shape>("shape", "name", "The outline of a shape by its name and sizes.")));
  rows.push_back(
      making<annulus>("annulus", "x, y, outer, inner", "Two outlines: the ring between two radii."));
  rows.push_back(making<round_corners>(
      "round_corners", "outline, radius",
      "The rounded form: convex corners by arcs of `radius`, concave ones too.\n"
      "\n"
      "Returns the outlines of a `kerf.Region`: the shape offset inwards, outwards twice as "
      "far, and inwards\n"
      "again."));
  rows.push_back(making<bezier>(
      "bezier", "control, within=0.005",
      "A Bézier curve of any degree through its control points as arcs: a point, then arcs and "
      "segments."));
  rows.push_back(tool_may_be_left_out(
      row<dxfoutline>("dxfoutline", "tool_num, outline=undef", "Draw an outline as a closed polyline."), 0));
  rows.push_back(motion<cutoutline>(
      "cutoutline", "outline=undef, bz=0, zdepth, offset=\"none\", corners=undef",
      "Cut along an outline, `zdepth` mm below `bz`; offset: 'none', 'outside' or 'inside' by "
      "the tool's\n"
      "radius. With corners 'dog-bone' or 't-bone' the tool clears the inner corners of a cut "
      "inside."));
  rows.push_back(motion<cutpocket>(
      "cutpocket", "outline=undef, bz=0, zdepth, stepover=0.4, corners=undef, entry=\"plunge\"",
      "Clear the inside of an outline, `zdepth` mm below `bz`; the stepover is a fraction of "
      "the tool's\n"
      "diameter. With corners 'dog-bone' or 't-bone' a square part fits into it. With the entry 'ramp' or "
      "'helix' the\n"
      "tool does not plunge; 'trochoidal': from a helix outwards by loops of limited engagement."));
  constexpr const char* kRound = "tool_num, bx, by, bz, xwidth, yheight, zdepth, radius";
  rows.push_back(tool_may_be_left_out(
      motion<cutpocketrectangleround>(
          "cutpocketrectangleround", kRound,
          "Clear the inside of a rectangle with round corners, `zdepth` mm (above 0) below `bz`."),
      7));
  rows.push_back(tool_may_be_left_out(
      motion<cutpocketrectanglerounddxf>("cutpocketrectanglerounddxf", kRound,
                                         "As cutpocketrectangleround, and the rectangle in the drawing."),
      7));
  rows.push_back(motion<cutfingers>(
      "cutfingers",
      "width, depth, count, bz, zdepth, first=true, fit=0, corners=\"dog-bone\", "
      "bx=0, by=0, edge=\"lower\", stepover=0.4",
      "Cut the slots of a finger joint along an edge of a board, whose left end is (bx, by).\n"
      "\n"
      "`count` fingers and slots together (odd); the boards of a joint are cut with `first` "
      "True (fingers\n"
      "at both ends) and False. `depth` is the thickness of the other board, `fit` the "
      "clearance between a\n"
      "finger and each side of its slot, mm; `edge` is 'lower' or 'upper'."));
  rows.push_back(motion<cutbezier>("cutbezier", "control, bz, zdepth",
                                   "Cut along a Bézier curve, `zdepth` mm below `bz`; it is run as arcs."));
  rows.push_back(tool_may_be_left_out(
      row<dxfbezier>("dxfbezier", "tool_num, control", "Draw a Bézier curve as a polyline of arcs."), 0));
}

}  // namespace kerf::design
