// Arcs, quarter circles and circles, cut and drawn.
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "design/commands/entities.h"
#include "design/commands/rows.h"

namespace kerf::design {
namespace {

using ArcBetween = Machine::ArcBetween;

constexpr double kArcError = 1e-3;  // mm by which a given radius may differ

double angle_of(Point2 p, Point2 centre) {
  return std::atan2(p.y - centre.y, p.x - centre.x) * 180 / std::numbers::pi;
}

/// barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc
ArcBetween arc_given(Call& call, Turn turn) {
  ArcBetween arc;
  arc.turn = turn;
  arc.start = call.number(0);
  arc.end = call.number(1);
  arc.centre = call.point2(2);
  arc.radius = positive(call.number(4), "radius");
  arc.rise = call.number(5);
  positive(call.number(6), "stepsizearc");
  return arc;
}

template <Turn turn>
void cut_arc(Machine& machine, Call& call) {
  machine.arc(arc_given(call, turn));
}
template <Turn turn>
void cut_arc_dxf(Machine& machine, Call& call) {
  cut_and_draw_arc(machine, arc_given(call, turn));
}

/// An arc of less than a turn from the present position: ex, ey, ez, xcenter, ycenter, radius. Returns its
/// angles in counter-clockwise order.
struct Angles {
  Point2 centre;
  double radius = 0.0, low = 0.0, high = 0.0;
};
Angles cut_arc_about(Machine& machine, Call& call, Turn turn) {
  const Point3 end = call.point3(0);
  Angles angles;
  angles.centre = call.point2(3);
  angles.radius = positive(call.number(5), "radius");
  const auto check = [&](Point2 p, const char* name) {
    const double off = distance(p, angles.centre);
    if (std::abs(off - angles.radius) > kArcError)
      refuse(fmt::format("radius: {} is {:.4f} mm from the centre, not {:.4f} mm", name, off, angles.radius));
  };
  check(machine.position().xy(), "the current position");
  check(end.xy(), "(ex, ey)");
  const double start = angle_of(machine.position().xy(), angles.centre);
  const double close = angle_of(end.xy(), angles.centre);
  machine.arc_to(end, angles.centre, turn);
  angles.low = turn == Turn::ccw ? start : close;
  angles.high = turn == Turn::ccw ? close : start;
  return angles;
}

template <Turn turn>
void arc_about(Machine& machine, Call& call) {
  cut_arc_about(machine, call, turn);
}
template <Turn turn>
void arc_about_dxf(Machine& machine, Call& call) {
  const Angles made = cut_arc_about(machine, call, turn);
  draw_arc(machine, machine.tool().given, made.centre, made.radius, made.low, made.high);
}

/// The quarter circle from `low` degrees on, in either direction: ex, ey, ez, radius.
template <int low, Turn turn>
ArcBetween quarter_given(const Machine& machine, Call& call) {
  const Point3 end = call.point3(0);
  ArcBetween arc;
  arc.turn = turn;
  arc.radius = positive(call.number(3), "radius");
  arc.start = turn == Turn::ccw ? low : low + 90;
  arc.end = turn == Turn::ccw ? low + 90 : low;
  constexpr int kQuarter = (turn == Turn::ccw ? low + 90 : low) / 90 % 4;
  constexpr double kCosine = kQuarter == 0 ? 1 : kQuarter == 2 ? -1 : 0;
  constexpr double kSine = kQuarter == 1 ? 1 : kQuarter == 3 ? -1 : 0;
  arc.centre = {end.x - arc.radius * kCosine, end.y - arc.radius * kSine};
  arc.rise = end.z - machine.position().z;
  return arc;
}
template <int low, Turn turn>
void quarter(Machine& machine, Call& call) {
  machine.arc(quarter_given<low, turn>(machine, call));
}
template <int low, Turn turn>
void quarter_dxf(Machine& machine, Call& call) {
  cut_and_draw_arc(machine, quarter_given<low, turn>(machine, call));
}

/// xcenter, ycenter, bz, ez, radius
template <Turn turn>
void cut_circle(Machine& machine, Call& call) {
  const Point2 centre = call.point2(0);
  const double radius = positive(call.number(4), "radius"), bottom = call.number(3);
  const Point3 start{centre.x + radius, centre.y, call.number(2)};
  if (distance(start, machine.position()) > kFar) machine.cut(start);
  machine.arc_to({start.x, start.y, bottom}, centre, turn);
}
template <Turn turn>
void cut_circle_dxf(Machine& machine, Call& call) {
  cut_circle<turn>(machine, call);
  draw_circle(machine, machine.tool().given, call.point2(0), call.number(4));
}

void gcodearc(Machine& machine, Call& call) {
  ArcBetween arc;
  arc.centre = call.point2(1);
  arc.radius = positive(call.number(3), "radius");
  arc.start = call.number(4);
  arc.end = call.number(5);
  machine.arc(arc);
}

constexpr const char* kArc = "barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc=1";
constexpr const char* kAbout = "ex, ey, ez, xcenter, ycenter, radius";
constexpr const char* kQuarter = "ex, ey, ez, radius";
constexpr const char* kCircle = "xcenter, ycenter, bz, ez, radius";

/// The four commands of a quadrant and a direction, such as "NE" and "CC".
struct QuadrantNames {
  const char *quadrant, *quarter, *quarter_dxf, *arc_dxf, *arc_dxfgc;
};
template <int low, Turn turn>
void add_quadrant(Rows& rows, const QuadrantNames& names) {
  const char* way = turn == Turn::ccw ? "counter-clockwise" : "clockwise";
  const std::string quarter_text =
      fmt::format("Cut the {} quarter of a circle {}; it ends at (ex, ey, ez)", names.quadrant, way);
  const std::string arc_text = fmt::format(
      "Cut an arc in the {} quadrant {} to (ex, ey, ez), also in the drawing.", names.quadrant, way);
  rows.push_back(motion<quarter<low, turn>>(names.quarter, kQuarter, quarter_text + "."));
  rows.push_back(
      motion<quarter_dxf<low, turn>>(names.quarter_dxf, kQuarter, quarter_text + ", also in the drawing."));
  rows.push_back(motion<arc_about_dxf<turn>>(names.arc_dxf, kAbout, arc_text));
  rows.push_back(motion<arc_about_dxf<turn>>(names.arc_dxfgc, kAbout, arc_text));
}

void add_quadrants(Rows& rows) {
  constexpr Turn kLeft = Turn::ccw, kRight = Turn::cw;
  add_quadrant<0, kLeft>(rows,
                         {"NE", "cutquarterCCNE", "cutquarterCCNEdxf", "cutarcNECCdxf", "cutarcNECCdxfgc"});
  add_quadrant<90, kLeft>(rows,
                          {"NW", "cutquarterCCNW", "cutquarterCCNWdxf", "cutarcNWCCdxf", "cutarcNWCCdxfgc"});
  add_quadrant<180, kLeft>(rows,
                           {"SW", "cutquarterCCSW", "cutquarterCCSWdxf", "cutarcSWCCdxf", "cutarcSWCCdxfgc"});
  add_quadrant<270, kLeft>(rows,
                           {"SE", "cutquarterCCSE", "cutquarterCCSEdxf", "cutarcSECCdxf", "cutarcSECCdxfgc"});
  add_quadrant<0, kRight>(rows,
                          {"NE", "cutquarterCWNE", "cutquarterCWNEdxf", "cutarcNECWdxf", "cutarcNECWdxfgc"});
  add_quadrant<90, kRight>(rows,
                           {"NW", "cutquarterCWNW", "cutquarterCWNWdxf", "cutarcNWCWdxf", "cutarcNWCWdxfgc"});
  add_quadrant<180, kRight>(
      rows, {"SW", "cutquarterCWSW", "cutquarterCWSWdxf", "cutarcSWCWdxf", "cutarcSWCWdxfgc"});
  add_quadrant<270, kRight>(
      rows, {"SE", "cutquarterCWSE", "cutquarterCWSEdxf", "cutarcSECWdxf", "cutarcSECWdxfgc"});
}

}  // namespace

void add_arc_commands(Rows& rows) {
  rows.push_back(motion<cut_arc<Turn::ccw>>(
      "cutarcCC", kArc,
      "Cut counter-clockwise from the angle `barc` to `earc`, degrees, while Z changes by "
      "`tpzreldim`."));
  rows.push_back(motion<cut_arc<Turn::cw>>(
      "cutarcCW", kArc,
      "Cut clockwise from the angle `barc` down to `earc`, degrees, while Z changes by "
      "`tpzreldim`."));
  rows.push_back(
      motion<cut_arc_dxf<Turn::ccw>>("cutarcCCdxf", kArc, "As cutarcCC, and the arc in the drawing."));
  rows.push_back(
      motion<cut_arc_dxf<Turn::cw>>("cutarcCWdxf", kArc, "As cutarcCW, and the arc in the drawing."));
  rows.push_back(motion<cut_arc<Turn::ccw>>("extrudearcCC", kArc, "As cutarcCC."));
  rows.push_back(
      motion<arc_about<Turn::ccw>>("arcCCgc", kAbout, "Cut counter-clockwise to a point about a centre."));
  rows.push_back(motion<arc_about<Turn::cw>>("arcCWgc", kAbout, "Cut clockwise to a point about a centre."));
  rows.push_back(
      tool_may_be_left_out(motion<gcodearc>("gcodearc", "tn, xcenter, ycenter, radius, anglebegin, endangle",
                                            "Cut an arc counter-clockwise at the current depth."),
                           5));
  rows.push_back(motion<cut_circle<Turn::ccw>>(
      "cutcircleCC", kCircle,
      "Cut a circle counter-clockwise from its right-most point, from the depth `bz` to the "
      "depth `ez`."));
  rows.push_back(motion<cut_circle<Turn::cw>>(
      "cutcircleCW", kCircle,
      "Cut a circle clockwise from its right-most point, from the depth `bz` to the depth `ez`."));
  rows.push_back(motion<cut_circle_dxf<Turn::ccw>>("cutcircleCCdxf", kCircle,
                                                   "As cutcircleCC, and the circle in the drawing."));
  rows.push_back(motion<cut_circle_dxf<Turn::cw>>("cutcircleCWdxf", kCircle,
                                                  "As cutcircleCW, and the circle in the drawing."));
  add_quadrants(rows);
}

}  // namespace kerf::design
