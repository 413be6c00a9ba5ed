// Circles and directions of segments.
#include "segment.h"

namespace kerf::outline_detail {
Carrier make_carrier(Point2 from, const Segment& segment, double weld) {
  Carrier c;
  c.from = from;
  c.to = segment.to;
  const Point2 chord = segment.to - from;
  if (segment.via) {
    const CircleThrough circle = circle_through(*segment.via - from, chord, kFlatArc);
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

}  // namespace kerf::outline_detail

namespace kerf {

std::optional<ArcCircle> arc_circle(Point2 from, const Segment& segment) {
  using namespace outline_detail;
  const Carrier c = make_carrier(from, segment, 0.0);
  if (!c.is_arc()) return std::nullopt;
  return ArcCircle{c.circle_centre(), c.radius, c.turn > 0.0 ? Turn::ccw : Turn::cw,
                   radians(sweep_to(c, c.to))};
}

}  // namespace kerf
