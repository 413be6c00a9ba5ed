// Geometric checks of cut outlines, independent of the code that cuts. Positions along a segment are arc
// lengths from its start point.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "kerf/geom/outline.h"

namespace outline_checks {

using kerf::Point2;

inline constexpr double kSlack = 1e-6;      // mm, of positions
inline constexpr double kTangent = 1.7e-5;  // radians, a thousandth of a degree
inline constexpr double kFlat = 4e-3;       // radians; corners closer to straight or folded are not checked

inline Point2 unit(Point2 v) {
  const double n = std::hypot(v.x, v.y);
  return {v.x / n, v.y / n};
}
inline Point2 left(Point2 v) { return {-v.y, v.x}; }
inline double full(double angle) {
  const double turn = 2.0 * std::numbers::pi, rest = std::fmod(angle, turn);
  return rest < 0.0 ? rest + turn : rest;
}
inline double angle_between(Point2 a, Point2 b) { return std::atan2(cross(a, b), dot(a, b)); }

/// A line or an arc, computed from its points alone.
struct CheckedSegment {
  Point2 from, to, direction, centre;
  double radius = 0.0, sense = 0.0, sweep = 0.0, length = 0.0;

  CheckedSegment(Point2 a, Point2 b, std::optional<Point2> via) : from(a), to(b) {
    if (via) {
      const Point2 u = a - *via, v = b - *via;
      const double d = 2.0 * cross(u, v), uu = dot(u, u), vv = dot(v, v);
      if (std::abs(d) > 2e-6 * std::sqrt(uu * vv)) {
        const Point2 c{(v.y * uu - u.y * vv) / d, (u.x * vv - v.x * uu) / d};
        centre = *via + c;
        radius = std::hypot(c.x, c.y);
        sense = d < 0.0 ? 1.0 : -1.0;
        sweep = full(sense * angle_between(a - centre, b - centre));
        length = radius * sweep;
        return;
      }
    }
    length = distance(a, b);
    if (length > 0.0) direction = unit(b - a);
  }
  bool arc() const { return sense != 0.0; }
  double off(Point2 p) const {
    return arc() ? std::abs(distance(p, centre) - radius) : std::abs(cross(direction, p - from));
  }
  double along(Point2 p) const {
    if (!arc()) return dot(direction, p - from);
    double angle = full(sense * angle_between(from - centre, p - centre));
    if (angle > 0.5 * (2.0 * std::numbers::pi + sweep)) angle -= 2.0 * std::numbers::pi;
    return angle * radius;
  }
  Point2 tangent(Point2 p) const { return arc() ? sense * left(unit(p - centre)) : direction; }
};

/// Whether an arc of radius r exists that touches both segments on the inside of the corner between them.
inline bool can_be_smoothed(const CheckedSegment& in, const CheckedSegment& out, double r) {
  const double turn = angle_between(in.tangent(in.to), out.tangent(out.from));
  if (std::abs(turn) < kFlat || std::numbers::pi - std::abs(turn) < kFlat) return false;
  const double side = turn > 0.0 ? 1.0 : -1.0;
  const auto locus = [&](const CheckedSegment& p) { return p.radius - p.sense * side * r; };
  if ((in.arc() && locus(in) <= 0.0) || (out.arc() && locus(out) <= 0.0)) return false;
  std::vector<Point2> centres;
  const auto line_start = [&](const CheckedSegment& p) { return p.from + (side * r) * left(p.direction); };
  if (!in.arc() && !out.arc()) {
    const double k =
        cross(line_start(out) - line_start(in), out.direction) / cross(in.direction, out.direction);
    centres.push_back(line_start(in) + k * in.direction);
  } else if (in.arc() && out.arc()) {
    const Point2 between = out.centre - in.centre;
    const double d = std::hypot(between.x, between.y);
    if (d == 0.0) return false;
    const double x = (d * d + locus(in) * locus(in) - locus(out) * locus(out)) / (2.0 * d);
    const double h2 = locus(in) * locus(in) - x * x;
    if (h2 < 0.0) return false;
    for (const double h : {std::sqrt(h2), -std::sqrt(h2)})
      centres.push_back(in.centre + (x / d) * between + (h / d) * left(between));
  } else {
    const CheckedSegment& line = in.arc() ? out : in;
    const CheckedSegment& arc = in.arc() ? in : out;
    const Point2 w = arc.centre - line_start(line);
    const double k = dot(w, line.direction), h = cross(line.direction, w);
    const double d2 = locus(arc) * locus(arc) - h * h;
    if (d2 < 0.0) return false;
    for (const double e : {std::sqrt(d2), -std::sqrt(d2)})
      centres.push_back(line_start(line) + (k + e) * line.direction);
  }
  // Clearly within both segments: at an end point the result depends on rounding.
  const auto touches = [&](const CheckedSegment& p, Point2 s) {
    const Point2 foot = p.arc() ? p.centre + p.radius * unit(s - p.centre)
                                : p.from + dot(p.direction, s - p.from) * p.direction;
    const double t = p.along(foot);
    return t > kSlack && t < p.length - kSlack;
  };
  return std::any_of(centres.begin(), centres.end(),
                     [&](Point2 s) { return touches(in, s) && touches(out, s); });
}

/// The fault of a replaced corner, empty if there is none: `made` are its points and arcs, from the one on
/// `in` to the one on `out`.
std::string wrong_with_corner(const CheckedSegment& in, const CheckedSegment& out, double request,
                              const kerf::Outline& made);
/// The fault of a whole result, empty if there is none. `even` leaves corners sharp that could be cut.
std::string wrong_with_cut(const kerf::Outline& outline, const kerf::CornerRequests& requests,
                           const kerf::CutOutline& cut, bool even);

}  // namespace outline_checks
