// A segment with its circle or direction worked out once: what corner and curve code computes on.
#pragma once

#include <optional>

#include "kerf/outline.h"

namespace kerf::outline_detail {

/// Three points that bend by less than this lie on a line: the arc would differ from its chord by less than a
/// quarter of a millionth of its length, and its circle would be too large to compute on.
inline constexpr double kFlatArc = 1e-6;  // radians
/// Coordinates beyond this are refused, so that products of four of them stay finite.
inline constexpr double kLargestCoordinate = 1e60;  // mm

constexpr Point2 left_of(Point2 direction) { return {-direction.y, direction.x}; }
/// Length without hypot's care for extremes, which the largest coordinate makes needless.
inline double norm(Point2 v) { return std::sqrt(dot(v, v)); }
constexpr Point2 operator-(Point2 v) { return {-v.x, -v.y}; }

/// `from` and `to` are those of the outline, digit by digit. Directions and centres are relative to `from`,
/// which keeps their accuracy far from the origin.
struct Carrier {
  Point2 from, to;
  Point2 direction;     // of a line: unit
  double length = 0.0;  // of a line
  Point2 centre;        // of an arc, relative to `from`
  double radius = 0.0;  // of an arc
  double turn = 0.0;    // 0 a line, +1 counter-clockwise, -1 clockwise
  bool is_arc() const { return turn != 0.0; }
};

/// Makes a carrier; a straight arc becomes a line. A line shorter than `weld` gets length 0.
Carrier make_carrier(Point2 from, const Segment& segment, double weld);

/// How far a point is from a segment.
double distance_to(const Carrier& carrier, Point2 p);

/// The middle of the arc from `from` to `to` about `centre`.
inline Point2 arc_middle(Point2 from, Point2 to, Point2 centre, double radius, double turn) {
  const Point2 a = from - centre, b = to - centre;
  const Point2 chord = b - a, sum = a + b;
  const double chord2 = dot(chord, chord), sum2 = dot(sum, sum);
  // The middle lies to the right of the chord of a counter-clockwise arc. Where the chord is short (a small
  // arc or nearly a whole circle) the sum of the radii points there more accurately.
  const Point2 aside = -turn * left_of(chord);
  if (chord2 >= sum2) return centre + (radius / std::sqrt(chord2)) * aside;
  const double sign = turn * cross(a, b) >= 0.0 ? 1.0 : -1.0;
  return centre + (sign * radius / std::sqrt(sum2)) * sum;
}

/// Finite and within the largest coordinate.
inline bool usable(Point2 p) {
  return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate;
}

}  // namespace kerf::outline_detail
