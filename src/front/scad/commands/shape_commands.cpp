// Shapes of the plane: made, drawn, cut along or beside, and pocketed; slots of finger joints.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "front/scad/commands/bindings.h"
#include "front/scad/commands/entities.h"
#include "front/scad/commands/outline_values.h"

#include "kerf/base/limits.h"
#include "kerf/geom/fit.h"
#include "kerf/geom/offset.h"
#include "kerf/geom/shapes.h"

namespace kerf::scad {
namespace {

constexpr Length kCurve = mm(0.005);  // between a Bezier curve and its arcs
constexpr std::size_t kMaxRings = 100'000;

template <class T>
T required(std::optional<T> value) {
  if (!value) throw Reported{};
  return std::move(*value);
}

Region region_of(MachineState& machine, const std::vector<Outline>& outlines) {
  return required(make_region(outlines, FillRule::even_odd, machine.region_options(), machine.diagnostics()));
}
Region shifted(MachineState& machine, const Region& region, double by) {
  return required(offset(region, mm(by), machine.region_options(), machine.diagnostics())).region;
}

// ---- values

std::vector<std::string> shape_list() {
  std::vector<std::string> names;
  for (const PlaneShape& shape : plane_shapes()) names.emplace_back(shape.name);
  return names;
}

Value shape(MachineState& machine, Call& call) {
  static const std::vector<std::string> names = shape_list();
  const PlaneShape& made = plane_shapes()[choice(text(call, 0), names, "name")];
  std::vector<double> values;
  for (std::size_t i = 1; i < call.size(); ++i) values.push_back(number(call, i));
  return value_of(required(make_plane_shape(made, values, machine.where(), machine.diagnostics())));
}

/// x, y, outer, inner
Value annulus(MachineState&, Call& call) {
  const Point2 centre = point2(call, 0);
  const double outer = positive(number(call, 2), "outer"), inner = positive(number(call, 3), "inner");
  if (inner >= outer) refuse(fmt::format("inner must be below outer, not {:g}", inner));
  return value_of(
      std::vector<Outline>{as_outline(Circle{centre, mm(outer)}), as_outline(Circle{centre, mm(inner)})});
}

/// Offset inwards, outwards twice as far, and inwards again: all corners become arcs.
Value round_corners(MachineState& machine, Call& call) {
  const double r = positive(number(call, 1), "radius");
  Region region = region_of(machine, outlines_given(call, 0));
  for (const double by : {-r, 2 * r, -r}) region = shifted(machine, region, by);
  if (region.empty()) refuse(fmt::format("radius: {:g} mm does not fit into the outline", r));
  return value_of(region.loops);
}

Outline bezier_of(MachineState& machine, const Value& control, Length within) {
  FitOptions options;
  options.name = "control";
  options.where = machine.where();
  const std::vector<Point2> points = points_of(control, "control");
  if (points.size() < 3) refuse("control: at least three points are required");
  return required(fit_bezier(points, within, options, machine.diagnostics()));
}
Value bezier(MachineState& machine, Call& call) {
  return value_of(bezier_of(machine, call[0], mm(positive(number(call, 1), "within"))));
}

// ---- drawn and cut

void dxfoutline(MachineState& machine, Call& call) {
  const int tool = tool_number(call, 0);
  for (const Outline& outline : outlines_given(call, 1)) draw_outline(machine, tool, outline);
}

/// The region with corners that the tool in use clears; `style` is the argument "corners".
Region relieved(MachineState& machine, const Region& region, const std::optional<std::string>& style,
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
void cutoutline(MachineState& machine, Call& call) {
  std::vector<Outline> outlines = outlines_given(call, 0);
  const std::size_t side = choice(text(call, 3), {"none", "outside", "inside"}, "offset");
  const double z = bottom_of(machine, number(call, 1), number(call, 2));
  const auto corners = optional_text(call, 4);
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

/// Rings from the inside to the outside.
void cut_rings(MachineState& machine, const Region& region, double z, double stepover) {
  if (!(stepover > 0.0 && stepover <= 1.0))
    refuse(fmt::format("stepover must be above 0 and at most 1, not {:g}", stepover));
  const double diameter = machine.tool().diameter();
  std::vector<Region> rings;
  Region rest = shifted(machine, region, -diameter / 2);
  while (!rest.empty()) {
    if (rings.size() >= kMaxRings) refuse(fmt::format("more than {} rings", kMaxRings));
    rings.push_back(rest);
    rest = shifted(machine, rest, -stepover * diameter);
  }
  if (rings.empty()) refuse(fmt::format("outline: the tool of {:g} mm does not fit into it", diameter));
  for (auto ring = rings.rbegin(); ring != rings.rend(); ++ring) machine.cut_outlines(ring->loops, z);
}

/// outline, bz, zdepth, stepover, corners
void cutpocket(MachineState& machine, Call& call) {
  const Region region = region_of(machine, outlines_given(call, 0));
  const double z = bottom_of(machine, number(call, 1), number(call, 2));
  cut_rings(machine, relieved(machine, region, optional_text(call, 4)), z, number(call, 3));
}

/// Turned by half a turn about the midpoint of a board's lower edge.
Region turned(const Region& region, double width) { return rotated(region, {width / 2, 0.0}, degrees(180)); }

/// width, depth, count, bz, zdepth, first, fit, corners, bx, by, edge, stepover
void cutfingers(MachineState& machine, Call& call) {
  FingerJoint joint;
  joint.width = mm(positive(number(call, 0), "width"));
  joint.depth = mm(positive(number(call, 1), "depth"));
  joint.count = whole(number(call, 2), "count", 3, limits::kMaxHoles);
  joint.ends = truth(call, 5) ? FingerJoint::Ends::fingers : FingerJoint::Ends::slots;
  joint.fit = mm(number(call, 6));
  joint.overhang = mm(machine.tool().diameter());
  const Point2 at = point2(call, 8);
  const bool upper = choice(text(call, 10), {"lower", "upper"}, "edge") == 1;
  const double width = joint.width.mm(), z = bottom_of(machine, number(call, 3), number(call, 4));
  Region slots = required(finger_slots(joint, machine.region_options(), machine.diagnostics()));
  const auto rectangle = make_plane_shape(*plane_shape("rectangle"), {0.0, 0.0, width, 2 * joint.depth.mm()},
                                          machine.where(), machine.diagnostics());
  Region board = region_of(machine, {required(rectangle)});
  if (upper) slots = turned(slots, width), board = turned(board, width);
  const Region cleared = relieved(machine, slots, optional_text(call, 7), &board);
  cut_rings(machine, placed(cleared, Placement{at}), z, number(call, 11));
}

// ---- curves

/// control, bz, zdepth
void cutbezier(MachineState& machine, Call& call) {
  const double z = bottom_of(machine, number(call, 1), number(call, 2));
  machine.cut_outlines({bezier_of(machine, call[0], kCurve)}, z);
}
void dxfbezier(MachineState& machine, Call& call) {
  draw_outline(machine, tool_number(call, 0), bezier_of(machine, call[1], kCurve));
}

}  // namespace

void add_shape_commands(Rows& rows) {
  rows.push_back(asking<shape, Needs::nothing>("shape", "name", FurtherArguments::taken));
  rows.push_back(asking<annulus, Needs::nothing>("annulus", "x, y, outer, inner"));
  rows.push_back(asking<round_corners, Needs::nothing>("round_corners", "outline, radius"));
  rows.push_back(asking<bezier, Needs::nothing>("bezier", "control, within=0.005"));
  rows.push_back(row<dxfoutline>("dxfoutline", "tool_num, outline=undef"));
  rows.push_back(
      row<cutoutline>("cutoutline", "outline=undef, bz=0, zdepth, offset=\"none\", corners=undef"));
  rows.push_back(row<cutpocket>("cutpocket", "outline=undef, bz=0, zdepth, stepover=0.4, corners=undef"));
  rows.push_back(row<cutfingers>("cutfingers",
                                 "width, depth, count, bz, zdepth, first=true, fit=0, corners=\"dog-bone\", "
                                 "bx=0, by=0, edge=\"lower\", stepover=0.4"));
  rows.push_back(row<cutbezier>("cutbezier", "control, bz, zdepth"));
  rows.push_back(row<dxfbezier>("dxfbezier", "tool_num, control"));
}

}  // namespace kerf::scad
