// Directions, offsets and intersections of lines and arcs.
#include "line_arc.h"

#include <numbers>

namespace kerf {
namespace {

Point2 unit(Point2 v) {
  const double size = norm(v);
  return size > 0.0 ? (1.0 / size) * v : Point2{};
}

Crossings lines_cross(const LineArc& e, const LineArc& f) {
  constexpr double kParallel = 1e-12;  // sine
  const Point2 v = e.chord(), w = f.chord();
  const double turn = cross(v, w);
  Crossings found;
  if (!(std::abs(turn) > kParallel * norm(v) * norm(w))) return found;
  found.at[found.count++] = e.from + (cross(f.from - e.from, w) / turn) * v;
  return found;
}

}  // namespace

LineArc arc_about(Point2 centre, Point2 from, Point2 to, Turn turn) {
  return {from, to, centre - from, distance(centre, to), turn == Turn::ccw ? 1.0 : -1.0};
}

Point2 start_direction(const LineArc& e) {
  return e.is_arc() ? e.turn * left_of(unit(-e.centre)) : unit(e.chord());
}

Point2 end_direction(const LineArc& e) {
  return e.is_arc() ? e.turn * left_of(unit(e.chord() - e.centre)) : unit(e.chord());
}

double sweep_to(const LineArc& arc, Point2 point) {
  const Point2 a = -arc.centre, b = (point - arc.from) - arc.centre;
  const double angle = arc.turn * std::atan2(cross(a, b), dot(a, b));
  return angle > 0.0 ? angle : angle + 2.0 * std::numbers::pi;
}

/// (x - sin x) r^2 / 2, as a series where x is small and the difference would cancel.
double segment_area(double radius, double sweep) {
  const double x = sweep, xx = x * x;
  double less = x - std::sin(x);
  if (x <= 0.5) {
    double term = x * xx / 6.0;
    less = term;
    for (int k = 4; k <= 12; k += 2) less += term *= -xx / (k * (k + 1));
  }
  return 0.5 * radius * radius * less;
}

Box2 bounds(const LineArc& e) {
  Box2 box;
  box.add(e.from);
  box.add(e.to);
  if (!e.is_arc()) return box;
  const double sweep = sweep_to(e, e.to);
  const Point2 centre = e.circle_centre();
  for (const Point2 aside : {Point2{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}})
    if (const Point2 extreme = centre + e.radius * aside; sweep_to(e, extreme) < sweep) box.add(extreme);
  return box;
}

Point2 nearest_point(const LineArc& e, Point2 p) {
  const Point2 q = p - e.from, chord = e.chord();
  if (!e.is_arc()) {
    const double square = dot(chord, chord), along = dot(q, chord);
    if (!(along > 0.0)) return e.from;
    return along < square ? e.from + (along / square) * chord : e.to;
  }
  const Point2 a = -e.centre, b = chord - e.centre, out = q - e.centre;
  const auto between = [&](Point2 first, Point2 last) {  // for less than half a turn
    return e.turn * cross(first, out) >= 0.0 && e.turn * cross(out, last) >= 0.0;
  };
  const bool beside = e.turn * cross(a, b) >= 0.0 ? between(a, b) : !between(b, a);
  const double size = norm(out);
  if (beside && size > 0.0) return e.circle_centre() + (e.radius / size) * out;
  return dot(q, q) <= dot(p - e.to, p - e.to) ? e.from : e.to;
}

double distance_to(const LineArc& e, Point2 p) {
  if (!e.is_arc()) return norm(p - nearest_point(e, p));
  const Point2 nearest = nearest_point(e, p);
  // Beside an arc the difference to its radius is more accurate than that of two points.
  if (nearest == e.from || nearest == e.to) return norm(p - nearest);
  return std::abs(norm(p - e.from - e.centre) - e.radius);
}

Point2 point_at(const LineArc& e, double fraction) {
  if (!e.is_arc()) return e.from + fraction * e.chord();
  const double angle = e.turn * fraction * sweep_to(e, e.to);
  const Point2 out = -e.centre;
  return e.circle_centre() + std::cos(angle) * out + std::sin(angle) * left_of(out);
}

ClosestPoints closest_points(const LineArc& e, const LineArc& f) {
  ClosestPoints best{e.from, nearest_point(f, e.from)};
  const auto consider = [&](Point2 p) {  // a point near e
    const Point2 on_e = nearest_point(e, p), on_f = nearest_point(f, on_e);
    if (norm(on_f - on_e) < norm(best.second - best.first)) best = {on_e, on_f};
  };
  consider(e.to);
  consider(nearest_point(e, f.from));
  consider(nearest_point(e, f.to));
  const Crossings crossings = carriers_cross(e, f, 0.0);
  for (int i = 0; i < crossings.count; ++i) consider(crossings.at[i]);
  // Between the ends the shortest connection is perpendicular to both: it passes through the centres of arcs.
  const auto beside = [&](Point2 centre, double radius, Point2 towards) {
    const double size = norm(towards);
    for (const double sign : {1.0, -1.0})
      if (size > 0.0) consider(centre + (sign * radius / size) * towards);
  };
  if (e.is_arc()) {
    const Point2 centre = e.circle_centre();
    beside(centre, e.radius, f.is_arc() ? f.circle_centre() - centre : left_of(f.chord()));
  } else if (f.is_arc()) {
    consider(nearest_point(e, f.circle_centre()));
  }
  return best;
}

std::optional<LineArc> offset(const LineArc& e, double to_left, double min_radius) {
  LineArc out = e;
  out.from = e.from + to_left * left_of(start_direction(e));
  out.to = e.to + to_left * left_of(end_direction(e));
  if (!e.is_arc()) return out;
  out.radius = e.radius - e.turn * to_left;
  if (!(out.radius > min_radius)) return std::nullopt;
  out.centre = e.circle_centre() - out.from;
  return out;
}

Crossings carriers_cross(const LineArc& e, const LineArc& f, double touch) {
  if (e.is_arc()) return f.is_arc() ? detail::arc_and_arc(e, f, touch) : detail::arc_and_line(e, f, touch);
  return f.is_arc() ? detail::arc_and_line(f, e, touch) : lines_cross(e, f);
}

Circle circle_of_bulge(Point2 from, Point2 to, double bulge) {
  const Point2 chord = to - from;
  const double aside =
      0.25 * (1.0 / bulge - bulge);  // of the centre from the midpoint, in chords, to the left
  const double radius = 0.25 * length(chord) * (std::abs(bulge) + 1.0 / std::abs(bulge));
  return {{0.5 * (from.x + to.x) - aside * chord.y, 0.5 * (from.y + to.y) + aside * chord.x}, mm(radius)};
}

}  // namespace kerf
