// Arcs, quarter circles and circles, cut and drawn.
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "front/scad/commands/bindings.h"
#include "front/scad/commands/entities.h"

namespace kerf::scad {
namespace {

using ArcBetween = MachineState::ArcBetween;

constexpr double kArcError = 1e-3;  // mm by which a given radius may differ

double angle_of(Point2 p, Point2 centre) {
  return std::atan2(p.y - centre.y, p.x - centre.x) * 180 / std::numbers::pi;
}

/// barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc
ArcBetween arc_given(Call& call, Turn turn) {
  ArcBetween arc;
  arc.turn = turn;
  arc.start = number(call, 0);
  arc.end = number(call, 1);
  arc.centre = point2(call, 2);
  arc.radius = positive(number(call, 4), "radius");
  arc.rise = number(call, 5);
  positive(number(call, 6), "stepsizearc");
  return arc;
}

template <Turn turn>
void cut_arc(MachineState& machine, Call& call) {
  machine.arc(arc_given(call, turn));
}
template <Turn turn>
void cut_arc_dxf(MachineState& machine, Call& call) {
  cut_and_draw_arc(machine, arc_given(call, turn));
}

/// An arc of less than a turn from the present position: ex, ey, ez, xcenter, ycenter, radius. Returns its
/// angles in counter-clockwise order.
struct Angles {
  Point2 centre;
  double radius = 0.0, low = 0.0, high = 0.0;
};
Angles cut_arc_about(MachineState& machine, Call& call, Turn turn) {
  const Point3 end = point3(call, 0);
  Angles angles;
  angles.centre = point2(call, 3);
  angles.radius = positive(number(call, 5), "radius");
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
void arc_about(MachineState& machine, Call& call) {
  cut_arc_about(machine, call, turn);
}
template <Turn turn>
void arc_about_dxf(MachineState& machine, Call& call) {
  const Angles made = cut_arc_about(machine, call, turn);
  draw_arc(machine, machine.tool().given, made.centre, made.radius, made.low, made.high);
}

/// The quarter circle from `low` degrees on, in either direction: ex, ey, ez, radius.
template <int low, Turn turn>
ArcBetween quarter_given(const MachineState& machine, Call& call) {
  const Point3 end = point3(call, 0);
  ArcBetween arc;
  arc.turn = turn;
  arc.radius = positive(number(call, 3), "radius");
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
void quarter(MachineState& machine, Call& call) {
  machine.arc(quarter_given<low, turn>(machine, call));
}
template <int low, Turn turn>
void quarter_dxf(MachineState& machine, Call& call) {
  cut_and_draw_arc(machine, quarter_given<low, turn>(machine, call));
}

/// xcenter, ycenter, bz, ez, radius
template <Turn turn>
void cut_circle(MachineState& machine, Call& call) {
  const Point2 centre = point2(call, 0);
  const double radius = positive(number(call, 4), "radius"), bottom = number(call, 3);
  const Point3 start{centre.x + radius, centre.y, number(call, 2)};
  if (distance(start, machine.position()) > kFar) machine.cut(start);
  machine.arc_to({start.x, start.y, bottom}, centre, turn);
}
template <Turn turn>
void cut_circle_dxf(MachineState& machine, Call& call) {
  cut_circle<turn>(machine, call);
  draw_circle(machine, machine.tool().given, point2(call, 0), number(call, 4));
}

void gcodearc(MachineState& machine, Call& call) {
  ArcBetween arc;
  arc.centre = point2(call, 1);
  arc.radius = positive(number(call, 3), "radius");
  arc.start = number(call, 4);
  arc.end = number(call, 5);
  machine.arc(arc);
}

constexpr const char* kArc = "barc, earc, xcenter, ycenter, radius, tpzreldim, stepsizearc=1";
constexpr const char* kAbout = "ex, ey, ez, xcenter, ycenter, radius";
constexpr const char* kQuarter = "ex, ey, ez, radius";
constexpr const char* kCircle = "xcenter, ycenter, bz, ez, radius";

/// The four commands of a quadrant and a direction, such as "NE" and "CC".
struct QuadrantNames {
  const char *quarter, *quarter_dxf, *arc_dxf, *arc_dxfgc;
};
template <int low, Turn turn>
void add_quadrant(Rows& rows, const QuadrantNames& names) {
  rows.push_back(row<quarter<low, turn>>(names.quarter, kQuarter));
  rows.push_back(row<quarter_dxf<low, turn>>(names.quarter_dxf, kQuarter));
  rows.push_back(row<arc_about_dxf<turn>>(names.arc_dxf, kAbout));
  rows.push_back(row<arc_about_dxf<turn>>(names.arc_dxfgc, kAbout));
}

void add_quadrants(Rows& rows) {
  constexpr Turn kLeft = Turn::ccw, kRight = Turn::cw;
  add_quadrant<0, kLeft>(rows, {"cutquarterCCNE", "cutquarterCCNEdxf", "cutarcNECCdxf", "cutarcNECCdxfgc"});
  add_quadrant<90, kLeft>(rows, {"cutquarterCCNW", "cutquarterCCNWdxf", "cutarcNWCCdxf", "cutarcNWCCdxfgc"});
  add_quadrant<180, kLeft>(rows, {"cutquarterCCSW", "cutquarterCCSWdxf", "cutarcSWCCdxf", "cutarcSWCCdxfgc"});
  add_quadrant<270, kLeft>(rows, {"cutquarterCCSE", "cutquarterCCSEdxf", "cutarcSECCdxf", "cutarcSECCdxfgc"});
  add_quadrant<0, kRight>(rows, {"cutquarterCWNE", "cutquarterCWNEdxf", "cutarcNECWdxf", "cutarcNECWdxfgc"});
  add_quadrant<90, kRight>(rows, {"cutquarterCWNW", "cutquarterCWNWdxf", "cutarcNWCWdxf", "cutarcNWCWdxfgc"});
  add_quadrant<180, kRight>(rows,
                            {"cutquarterCWSW", "cutquarterCWSWdxf", "cutarcSWCWdxf", "cutarcSWCWdxfgc"});
  add_quadrant<270, kRight>(rows,
                            {"cutquarterCWSE", "cutquarterCWSEdxf", "cutarcSECWdxf", "cutarcSECWdxfgc"});
}

}  // namespace

void add_arc_commands(Rows& rows) {
  rows.push_back(row<cut_arc<Turn::ccw>>("cutarcCC", kArc));
  rows.push_back(row<cut_arc<Turn::cw>>("cutarcCW", kArc));
  rows.push_back(row<cut_arc_dxf<Turn::ccw>>("cutarcCCdxf", kArc));
  rows.push_back(row<cut_arc_dxf<Turn::cw>>("cutarcCWdxf", kArc));
  rows.push_back(row<cut_arc<Turn::ccw>>("extrudearcCC", kArc));
  rows.push_back(row<arc_about<Turn::ccw>>("arcCCgc", kAbout));
  rows.push_back(row<arc_about<Turn::cw>>("arcCWgc", kAbout));
  rows.push_back(row<gcodearc>("gcodearc", "tn, xcenter, ycenter, radius, anglebegin, endangle"));
  rows.push_back(row<cut_circle<Turn::ccw>>("cutcircleCC", kCircle));
  rows.push_back(row<cut_circle<Turn::cw>>("cutcircleCW", kCircle));
  rows.push_back(row<cut_circle_dxf<Turn::ccw>>("cutcircleCCdxf", kCircle));
  rows.push_back(row<cut_circle_dxf<Turn::cw>>("cutcircleCWdxf", kCircle));
  add_quadrants(rows);
}

}  // namespace kerf::scad
