// A segment with its circle or direction computed once: what corner and curve code computes on.
#pragma once

#include "geom/base/line_arc.h"

#include "kerf/geom/outline.h"

namespace kerf::outline_detail {

/// Three points whose chords turn by less than this lie on a line: the arc would differ from its chord by
/// less than a quarter of a millionth of its length, and its circle would be too large for accurate results.
inline constexpr double kFlatArc = 1e-6;  // radians
/// Coordinates beyond this are refused, so that products of four of them stay finite.
inline constexpr double kLargestCoordinate = 1e60;  // mm

/// `from` and `to` are those of the outline, digit by digit.
struct Carrier : LineArc {
  Point2 direction;     // of a line: unit
  double length = 0.0;  // of a line
};

/// Makes a carrier; a straight arc becomes a line. A line shorter than `weld` gets length 0.
Carrier make_carrier(Point2 from, const Segment& segment, double weld);

/// The midpoint of the arc from `from` to `to` about `centre`.
inline Point2 arc_midpoint(Point2 from, Point2 to, Point2 centre, double radius, double turn) {
  const Point2 a = from - centre, b = to - centre;
  const Point2 chord = b - a, sum = a + b;
  const double chord2 = dot(chord, chord), sum2 = dot(sum, sum);
  // The midpoint lies to the right of the chord of a counter-clockwise arc. Where the chord is short (a small
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
