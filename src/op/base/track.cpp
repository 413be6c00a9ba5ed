// A path in the plane by its length.
#include "op/base/track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/outline/segment.h"

namespace kerf::op_detail {

double sweep_of(const LineArc& arc) {
  const Point2 a = -arc.centre, b = arc.to - arc.from - arc.centre;
  double sweep = arc.turn * std::atan2(cross(a, b), dot(a, b));
  if (sweep <= 0.0) sweep += 2.0 * std::numbers::pi;
  return sweep;
}

double length_of(const LineArc& piece) {
  return piece.is_arc() ? piece.radius * sweep_of(piece) : length(piece.chord());
}

Track::Track(const Outline& outline, double weld) : weld_(weld), closed_(outline.closed()) {
  Point2 from = outline.start;
  for (const Segment& segment : outline.segments) {
    const LineArc shape = outline_detail::make_carrier(from, segment, weld);
    Element e{shape, length_, 0.0, shape.is_arc() ? sweep_of(shape) : 0.0};
    e.length = shape.is_arc() ? shape.radius * e.sweep : kerf::length(shape.chord());
    from = segment.to;
    if (!(e.length > 0.0)) continue;
    length_ += e.length;
    elements_.push_back(e);
  }
}

Point2 Track::point_of(const Element& e, double along) {
  if (along <= 0.0) return e.shape.from;
  if (along >= e.length) return e.shape.to;
  const double t = along / e.length;
  if (!e.shape.is_arc()) return e.shape.from + t * e.shape.chord();
  const double angle = e.shape.turn * t * e.sweep;
  const Point2 a = -e.shape.centre;
  const double c = std::cos(angle), s = std::sin(angle);
  return e.shape.circle_centre() + Point2{c * a.x - s * a.y, s * a.x + c * a.y};
}

const Track::Element& Track::element_at(double s) const {
  const auto after = std::upper_bound(elements_.begin(), elements_.end(), s,
                                      [](double v, const Element& e) { return v < e.start; });
  return after == elements_.begin() ? elements_.front() : *(after - 1);
}

namespace {

/// `s` of a closed path within its length.
double wrapped(double s, double length) {
  const double rest = std::fmod(s, length);
  return rest < 0.0 ? rest + length : rest;
}

}  // namespace

Point2 Track::at(double s) const {
  if (closed_) s = wrapped(s, length_);
  const Element& e = element_at(s);
  return point_of(e, s - e.start);
}

Point2 Track::direction(double s) const {
  if (closed_) s = wrapped(s, length_);
  const Element& e = element_at(s);
  if (!e.shape.is_arc()) return (1.0 / e.length) * e.shape.chord();
  const Point2 radius = point_of(e, s - e.start) - e.shape.circle_centre();
  return (e.shape.turn / kerf::length(radius)) * left_of(radius);
}

double Track::nearest(Point2 p) const {
  double best = INFINITY, at = 0.0;
  for (const Element& e : elements_) {
    double along = 0.0;
    if (e.shape.is_arc()) {
      const Point2 centre = e.shape.circle_centre();
      const Point2 a = e.shape.from - centre, b = p - centre;
      double angle = e.shape.turn * std::atan2(cross(a, b), dot(a, b));
      if (angle < 0.0) angle += 2.0 * std::numbers::pi;
      along = angle * e.shape.radius;
    } else {
      along = dot(p - e.shape.from, e.shape.chord()) / e.length;
    }
    for (const double s : {0.0, std::clamp(along, 0.0, e.length), e.length}) {
      const double d = distance(point_of(e, s), p);
      if (d < best - weld_) best = d, at = e.start + s;
    }
  }
  return at;
}

LineArc Track::cut_out(const Element& e, double from, double to) {
  LineArc piece = e.shape;
  piece.from = point_of(e, from), piece.to = point_of(e, to);
  if (piece.is_arc()) {
    piece.centre = e.shape.circle_centre() - piece.from;
    if (to < from) piece.turn = -piece.turn;
  }
  return piece;
}

std::vector<LineArc> Track::pieces(double from, double to) const {
  std::vector<LineArc> made;
  if (empty()) return made;
  const bool forwards = to >= from;
  double low = std::min(from, to), high = std::max(from, to);
  if (!closed_) low = std::max(low, 0.0), high = std::min(high, length_);
  const double first = closed_ ? std::floor(low / length_) * length_ : 0.0;
  for (double base = first; base < high; base += length_) {
    for (const Element& e : elements_) {
      const double a = std::max(low - base - e.start, 0.0), b = std::min(high - base - e.start, e.length);
      if (b - a > weld_ || (b > a && a <= 0.0 && b >= e.length))
        made.push_back(forwards ? cut_out(e, a, b) : cut_out(e, b, a));
    }
    if (!closed_) break;
  }
  if (!forwards) std::reverse(made.begin(), made.end());
  // Where short pieces are left out, the next one starts at the end of the last.
  for (std::size_t i = 1; i < made.size(); ++i) {
    const Point2 shift = made[i - 1].to - made[i].from;
    made[i].from = made[i - 1].to;
    made[i].centre = made[i].centre - shift;
  }
  return made;
}

}  // namespace kerf::op_detail
