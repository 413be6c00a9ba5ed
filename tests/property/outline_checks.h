// Geometric checks of cut outlines that share nothing with the code that cuts: a property must hold, whoever
// made the result. Positions along a segment are arc lengths from its begin.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "kerf/outline.h"

namespace outline_checks {

using kerf::Point2;

inline constexpr double kSlack = 1e-6;      // mm, of positions
inline constexpr double kTangent = 1.7e-5;  // radians, a thousandth of a degree
inline constexpr double kFlat = 4e-3;       // radians: corners nearer to straight or to a fold are not judged

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

/// A line or an arc, made from points alone.
struct Piece {
  Point2 from, to, direction, centre;
  double radius = 0.0, sense = 0.0, sweep = 0.0, length = 0.0;

  Piece(Point2 a, Point2 b, std::optional<Point2> via) : from(a), to(b) {
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

/// Whether an arc of radius r exists that touches both pieces on the inside of the corner between them.
inline bool can_be_smoothed(const Piece& in, const Piece& out, double r) {
  const double turn = angle_between(in.tangent(in.to), out.tangent(out.from));
  if (std::abs(turn) < kFlat || std::numbers::pi - std::abs(turn) < kFlat) return false;
  const double side = turn > 0.0 ? 1.0 : -1.0;
  const auto locus = [&](const Piece& p) { return p.radius - p.sense * side * r; };
  if ((in.arc() && locus(in) <= 0.0) || (out.arc() && locus(out) <= 0.0)) return false;
  std::vector<Point2> centres;
  const auto line_begin = [&](const Piece& p) { return p.from + (side * r) * left(p.direction); };
  if (!in.arc() && !out.arc()) {
    const double k =
        cross(line_begin(out) - line_begin(in), out.direction) / cross(in.direction, out.direction);
    centres.push_back(line_begin(in) + k * in.direction);
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
    const Piece& line = in.arc() ? out : in;
    const Piece& arc = in.arc() ? in : out;
    const Point2 w = arc.centre - line_begin(line);
    const double k = dot(w, line.direction), h = cross(line.direction, w);
    const double d2 = locus(arc) * locus(arc) - h * h;
    if (d2 < 0.0) return false;
    for (const double e : {std::sqrt(d2), -std::sqrt(d2)})
      centres.push_back(line_begin(line) + (k + e) * line.direction);
  }
  // Well within both pieces: at the very end rounding may decide.
  const auto touches = [&](const Piece& p, Point2 s) {
    const Point2 foot = p.arc() ? p.centre + p.radius * unit(s - p.centre)
                                : p.from + dot(p.direction, s - p.from) * p.direction;
    const double t = p.along(foot);
    return t > kSlack && t < p.length - kSlack;
  };
  return std::any_of(centres.begin(), centres.end(),
                     [&](Point2 s) { return touches(in, s) && touches(out, s); });
}

/// What is wrong with a replaced corner: `made` are its points and arcs, from the one on `in` to the one on
/// `out`.
std::string wrong_with_corner(const Piece& in, const Piece& out, double request, const kerf::Outline& made);
/// What is wrong with a whole result; empty if nothing. `even` leaves corners sharp that could be cut.
std::string wrong_with_cut(const kerf::Outline& outline, const kerf::CutOutline& cut, bool even);

}  // namespace outline_checks
