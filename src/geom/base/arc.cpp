// Arcs as walks in their plane.
#include <cassert>
#include <numbers>

#include "kerf/geom/geometry.h"

namespace kerf {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Ends closer than this in angle close the circle; the same rule as the interpreters that programs are made
/// for.
constexpr double kFullCircleAngle = 1e-9;  // radians

}  // namespace

Point3 ArcWalk::at(double t) const {
  const PlaneAxes axes = axes_of(plane);
  const double angle = start_angle + t * sweep;
  const double radius = start_radius + t * (end_radius - start_radius);
  Point3 p;
  p[axes.u] = u + radius * std::cos(angle);
  p[axes.v] = v + radius * std::sin(angle);
  p[axes.w] = start_w + t * (end_w - start_w);
  return p;
}

double ArcWalk::length() const {
  return std::hypot(0.5 * (start_radius + end_radius) * sweep, end_w - start_w);
}

int ArcWalk::chords(Length chord, int limit) const {
  const double radius = std::max(start_radius, end_radius);
  if (!(radius > 0.0) || sweep == 0.0) return 1;
  const double sagitta = std::min(std::max(chord.mm(), 1e-12 * radius), radius);
  const double step = 2.0 * std::acos(1.0 - sagitta / radius);
  const double count = std::ceil(std::abs(sweep) / step);
  return count >= limit ? limit : std::max(1, static_cast<int>(count));
}

Box3 ArcWalk::bounds() const {
  Box3 box;
  box.add(at(0.0));
  box.add(at(1.0));
  // The extremes in the plane lie where the angle is a whole number of quarter turns.
  const double quarter = kTurn / 4.0;
  const double low = std::min(start_angle, start_angle + sweep);
  const double high = std::max(start_angle, start_angle + sweep);
  if (sweep == 0.0 || !std::isfinite(low) || !std::isfinite(high)) return box;
  const double first = std::ceil(low / quarter);
  const double last = std::min(std::floor(high / quarter), first + 8);  // two turns show every extreme
  for (double k = first; k <= last; k += 1.0) box.add(at((k * quarter - start_angle) / sweep));
  if (high - low > kTurn) {  // a spiral of many turns: its last turn may reach furthest
    const double back = std::floor(high / quarter);
    for (double k = back; k > back - 5; k -= 1.0)
      if (k * quarter >= low) box.add(at((k * quarter - start_angle) / sweep));
  }
  return box;
}

ArcWalk walk_arc(Point3 from, Point3 to, Point2 centre, Plane plane, Turn turn, int extra_turns) {
  assert(extra_turns >= 0);
  const PlaneAxes axes = axes_of(plane);
  ArcWalk walk;
  walk.plane = plane;
  const Point2 about = in_name_order(plane, centre);
  walk.u = about.x;
  walk.v = about.y;
  const double start_u = from[axes.u] - walk.u, start_v = from[axes.v] - walk.v;
  const double end_u = to[axes.u] - walk.u, end_v = to[axes.v] - walk.v;
  walk.start_radius = std::hypot(start_u, start_v);
  walk.end_radius = std::hypot(end_u, end_v);
  walk.start_angle = std::atan2(start_v, start_u);
  double sweep = std::atan2(end_v, end_u) - walk.start_angle;
  if (turn == Turn::ccw) {
    while (sweep <= kFullCircleAngle) sweep += kTurn;
    sweep += kTurn * extra_turns;
  } else {
    while (sweep >= -kFullCircleAngle) sweep -= kTurn;
    sweep -= kTurn * extra_turns;
  }
  walk.sweep = sweep;
  walk.start_w = from[axes.w];
  walk.end_w = to[axes.w];
  return walk;
}

}  // namespace kerf
