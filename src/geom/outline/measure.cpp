// Area, length and bounds of outlines.
#include <algorithm>
#include <cmath>

#include "segment.h"

#include "kerf/geom/outline.h"

namespace kerf {

double area(const Outline& outline) {
  double twice = 0.0;
  Point2 from = outline.start;
  for (const Segment& s : outline.segments) {
    twice += cross(from - outline.start, s.to - outline.start);
    if (const auto arc = s.via ? arc_circle(from, s) : std::nullopt) {
      const double beside = 2.0 * segment_area(arc->radius, arc->sweep.rad());
      twice += arc->turn == Turn::ccw ? beside : -beside;
    }
    from = s.to;
  }
  return 0.5 * twice;
}

Length length(const Outline& outline) {
  double sum = 0.0;
  Point2 from = outline.start;
  for (const Segment& s : outline.segments) {
    const auto arc = s.via ? arc_circle(from, s) : std::nullopt;
    sum += arc ? arc->radius * arc->sweep.rad() : distance(from, s.to);
    from = s.to;
  }
  return mm(sum);
}

CurvePoint at_length(const Outline& outline, Length from_start) {
  double left = std::max(0.0, from_start.mm());
  CurvePoint found{outline.start, {}};
  Point2 from = outline.start;
  for (const Segment& s : outline.segments) {
    const auto carrier = outline_detail::make_carrier(from, s, 0.0);
    const double size = carrier.is_arc() ? carrier.radius * sweep_to(carrier, carrier.to) : carrier.length;
    from = s.to;
    if (size == 0.0) continue;
    const double fraction = std::min(1.0, left / size);
    found.at = fraction < 1.0 ? point_at(carrier, fraction) : s.to;
    Point2 tangent = start_direction(carrier);
    if (carrier.is_arc()) {
      const double angle = carrier.turn * fraction * size / carrier.radius;
      tangent = std::cos(angle) * tangent + std::sin(angle) * left_of(tangent);
    }
    found.heading = radians(std::atan2(tangent.y, tangent.x));
    if (left <= size) break;
    left -= size;
  }
  return found;
}

Box2 bounds(const Outline& outline) {
  Box2 box;
  box.add(outline.start);
  Point2 from = outline.start;
  for (const Segment& s : outline.segments) {
    box.add(bounds(outline_detail::make_carrier(from, s, 0.0)));
    from = s.to;
  }
  return box;
}

}  // namespace kerf
