// A line or an arc in the plane by itself, with both of its ends: what offsets, intersections and distances
// are computed on. An outline's Segment starts at the end of the segment before it.
//
// Frame as in outline.h: mm, y up, counter-clockwise is positive. For what is computed often, types derive
// from LineArc and add what they need (Carrier, region_detail::Edge and the runs of an offset).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "kerf/geom/geometry.h"

namespace kerf {

/// Length without hypot's care for extremes, for coordinates whose squares are finite.
inline double norm(Point2 v) { return std::sqrt(dot(v, v)); }

struct LineArc {
  Point2 from, to;
  Point2 centre;        // of an arc, relative to `from`, which keeps large circles accurate
  double radius = 0.0;  // of an arc
  double turn = 0.0;    // 0 a line, +1 counter-clockwise, -1 clockwise

  bool is_arc() const { return turn != 0.0; }
  Point2 chord() const { return to - from; }
  Point2 circle_centre() const { return from + centre; }
};

inline LineArc line_between(Point2 from, Point2 to) { return {from, to, {}, 0.0, 0.0}; }
/// An arc about `centre` (not relative); its radius is that of its end.
LineArc arc_about(Point2 centre, Point2 from, Point2 to, Turn turn);

/// Unit directions of travel at both ends; none (0, 0) for a line or a circle without size.
Point2 start_direction(const LineArc& element);
Point2 end_direction(const LineArc& element);
/// The angle from the start of an arc to a point as seen from its centre, in the arc's sense: radians, above
/// 0 and at most a full turn.
double sweep_to(const LineArc& arc, Point2 point);
/// The point of an element that is nearest to another.
Point2 nearest_point(const LineArc& element, Point2 p);
double distance_to(const LineArc& element, Point2 p);
/// The point at a fraction of an element's length, from 0 to 1.
Point2 point_at(const LineArc& element, double fraction);
/// The area between an arc and its chord; the sweep in radians, above 0.
double segment_area(double radius, double sweep);
/// The smallest box around an element.
Box2 bounds(const LineArc& element);

/// The element at the distance `to_left` (mm, below 0: to the right) from each point of another. Nothing for
/// an arc whose radius would not be more than `min_radius`.
std::optional<LineArc> offset(const LineArc& element, double to_left, double min_radius);

/// Points that two carriers, the endless line or the whole circle of an element, have in common.
struct Crossings {
  int count = 0;
  Point2 at[2];
};
/// Carriers that miss each other by no more than `touch` (mm) touch in one point, which is given twice where
/// one is a circle. Lines need a length; the start of an arc must lie on its circle.
Crossings carriers_cross(const LineArc& e, const LineArc& f, double touch);

/// Points of two elements that are as near to each other as any are; the same where they intersect.
struct ClosestPoints {
  Point2 first, second;
};
ClosestPoints closest_points(const LineArc& e, const LineArc& f);

/// The centre, relative to the start of a chord, of the circle of `radius` over it; on the left of the chord
/// for side = +1, on its right for -1. A radius below half of the chord counts as that.
inline Point2 centre_over_chord(Point2 chord, double radius, double side) {
  const double c2 = dot(chord, chord);
  const double height = std::sqrt(std::max(0.0, radius * radius - 0.25 * c2));
  return 0.5 * chord + (side * height / std::sqrt(c2)) * left_of(chord);
}

/// The circle through three points: its centre relative to the first, and the sense in which they follow each
/// other, 0 where they curve by less than `flat` (radians, above 0) and count as a line.
struct CircleThrough {
  Point2 centre;
  double turn = 0.0;
};
/// `second` and `third` are relative to the first point. Computed about the second, whose two chords are the
/// best conditioned differences there are.
inline CircleThrough circle_through(Point2 second, Point2 third, double flat) {
  const Point2 u = -second, v = third - second;
  const double twice_area = cross(u, v);
  const double uu = dot(u, u), vv = dot(v, v);
  if (!(twice_area * twice_area > flat * flat * uu * vv)) return {};
  const double scale = 0.5 / twice_area;
  const Point2 about_second{scale * (v.y * uu - u.y * vv), scale * (u.x * vv - v.x * uu)};
  return {second + about_second, twice_area > 0.0 ? -1.0 : 1.0};
}

/// The circle of the arc from one point to another with a bulge that is not 0: the tangent of a quarter of
/// its sweep, above 0 counter-clockwise.
Circle circle_of_bulge(Point2 from, Point2 to, double bulge);

namespace detail {

/// Points of an arc's circle on a line, which has the direction `v` and the foot of the perpendicular from
/// the arc's start at `foot` (relative to that start). Circles that the line misses by `touch` or less touch
/// it.
inline Crossings circle_and_line(const LineArc& arc, Point2 foot, Point2 v, double touch) {
  const double vv = dot(v, v), b = dot(v, arc.centre);
  const double c = dot(foot, foot) - 2.0 * dot(foot, arc.centre);  // exact enough however large the circle is
  double d = b * b - vv * c;
  Crossings found;
  if (touch > 0.0 && d < 0.0 && d >= -2.0 * touch * arc.radius * vv) d = 0.0;
  if (!(d >= 0.0) || vv == 0.0) return found;
  const double larger = b + std::copysign(std::sqrt(d), b);
  const double t[2] = {larger / vv, larger != 0.0 ? c / larger : 0.0};
  for (const double at : t) found.at[found.count++] = arc.from + foot + at * v;
  return found;
}

inline Crossings arc_and_line(const LineArc& arc, const LineArc& line, double touch) {
  const Point2 v = line.chord(), n = left_of(v);
  const Point2 foot = (cross(v, line.from - arc.from) / dot(v, v)) * n;
  return circle_and_line(arc, foot, v, touch);
}

/// Two circles meet on a line; the smaller circle gives the points better.
inline Crossings arc_and_arc(const LineArc& e, const LineArc& f, double touch) {
  if (e.radius > f.radius) return arc_and_arc(f, e, touch);
  const Point2 between = f.from - e.from;
  const Point2 m = e.centre - between - f.centre;  // from the second centre to the first
  const double mm = dot(m, m);
  if (mm == 0.0) return {};
  const double k = -0.5 * (dot(between, between) + 2.0 * dot(between, f.centre));
  return circle_and_line(e, (k / mm) * m, left_of(m), touch);
}

}  // namespace detail

}  // namespace kerf
