// Area, length and bounds of outlines.
#include <cmath>

#include "segment.h"

#include "kerf/outline.h"

namespace kerf {
namespace {

/// x - sin x, without the cancellation where x is small.
double less_its_sine(double x) {
  if (x > 0.5) return x - std::sin(x);
  const double xx = x * x;
  double term = x * xx / 6.0, sum = term;
  for (int k = 4; k <= 12; k += 2) sum += term *= -xx / (k * (k + 1));
  return sum;
}

}  // namespace

double area(const Outline& outline) {
  double twice = 0.0;
  Point2 from = outline.start;
  for (const Segment& s : outline.segments) {
    twice += cross(from - outline.start, s.to - outline.start);
    if (const auto arc = s.via ? arc_circle(from, s) : std::nullopt) {
      const double beside = arc->radius * arc->radius * less_its_sine(arc->sweep.rad());
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
