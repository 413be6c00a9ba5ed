// Circles and directions of segments.
#include "segment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::outline_detail {
namespace {

struct ThreePoints {
  Point2 centre;  // relative to the first point
  double turn;    // 0: they lie on a line
};

/// The circle through the origin, `via` and `to`. Worked out about `via`, whose two chords are the best
/// conditioned differences there are.
ThreePoints circle_through(Point2 via, Point2 to) {
  const Point2 u = -via, v = to - via;
  const double twice_area = cross(u, v);
  const double uu = dot(u, u), vv = dot(v, v);
  if (!(twice_area * twice_area > kFlatArc * kFlatArc * uu * vv)) return {{}, 0.0};
  const double scale = 0.5 / twice_area;
  const Point2 about_via{scale * (v.y * uu - u.y * vv), scale * (u.x * vv - v.x * uu)};
  return {via + about_via, twice_area > 0.0 ? -1.0 : 1.0};
}

}  // namespace

Carrier make_carrier(Point2 from, const Segment& segment, double weld) {
  Carrier c;
  c.from = from;
  c.to = segment.to;
  const Point2 chord = segment.to - from;
  if (segment.via) {
    const ThreePoints circle = circle_through(*segment.via - from, chord);
    if (circle.turn != 0.0) {
      c.centre = circle.centre;
      c.radius = norm(circle.centre);
      c.turn = circle.turn;
      return c;
    }
  }
  const double length = norm(chord);
  if (length > weld) {
    c.length = length;
    c.direction = (1.0 / length) * chord;
  }
  return c;
}

double distance_to(const Carrier& c, Point2 p) {
  const Point2 q = p - c.from, chord = c.to - c.from;
  if (!c.is_arc()) {
    const double t = std::clamp(dot(q, c.direction), 0.0, c.length);
    return norm(q - t * c.direction);
  }
  const Point2 a = -c.centre, b = chord - c.centre, out = q - c.centre;
  const auto between = [&](Point2 begin, Point2 end) {  // for less than half a turn
    return c.turn * cross(begin, out) >= 0.0 && c.turn * cross(out, end) >= 0.0;
  };
  const bool beside = c.turn * cross(a, b) >= 0.0 ? between(a, b) : !between(b, a);
  return beside ? std::abs(norm(out) - c.radius) : std::min(norm(q), norm(p - c.to));
}

}  // namespace kerf::outline_detail

namespace kerf {

std::optional<ArcCircle> arc_circle(Point2 from, const Segment& segment) {
  using namespace outline_detail;
  const Carrier c = make_carrier(from, segment, 0.0);
  if (!c.is_arc()) return std::nullopt;
  const Point2 a = -c.centre, b = (segment.to - from) - c.centre;
  double sweep = c.turn * std::atan2(cross(a, b), dot(a, b));
  if (sweep <= 0.0) sweep += 2.0 * std::numbers::pi;
  return ArcCircle{from + c.centre, c.radius, c.turn > 0.0 ? Turn::ccw : Turn::cw, radians(sweep)};
}

}  // namespace kerf
