// Outlines moved, mirrored, turned and reversed. Every function makes a new outline.
#include <cmath>
#include <utility>

#include "kerf/geom/outline.h"

namespace kerf {
namespace {

Point2 placed_point(Point2 p, const Placement& placement) {
  return {placement.offset.x + placement.factor.x * p.x, placement.offset.y + placement.factor.y * p.y};
}

/// Turns points about a centre; computes sine and cosine once.
class Rotation {
 public:
  Rotation(Point2 centre, Angle angle)
      : centre_(centre), cosine_(std::cos(angle.rad())), sine_(std::sin(angle.rad())) {}
  Point2 operator()(Point2 p) const {
    const Point2 d = p - centre_;
    return {centre_.x + (cosine_ * d.x - sine_ * d.y), centre_.y + (sine_ * d.x + cosine_ * d.y)};
  }

 private:
  Point2 centre_;
  double cosine_, sine_;
};

template <class Move>
Outline moved(const Outline& outline, const Move& move) {
  Outline made = outline;
  made.start = move(made.start);
  for (Segment& segment : made.segments) {
    segment.to = move(segment.to);
    if (segment.via) segment.via = move(*segment.via);
  }
  return made;
}

}  // namespace

Outline placed(const Outline& outline, const Placement& placement) {
  const auto move = [&](Point2 p) { return placed_point(p, placement); };
  return moved(placement.mirrors() ? reversed(outline) : outline, move);
}

Curve placed(const Curve& curve, const Placement& placement) {
  Curve made = placement.mirrors() ? reversed(curve) : curve;
  for (CurvePoint& point : made) {
    const double dx = placement.factor.x * std::cos(point.heading.rad());
    const double dy = placement.factor.y * std::sin(point.heading.rad());
    point = {placed_point(point.at, placement), radians(std::atan2(dy, dx))};
  }
  return made;
}

Outline as_outline(const Circle& circle) {
  const Point2 c = circle.centre, right{circle.radius.mm(), 0.0}, up{0.0, circle.radius.mm()};
  return {c + right, {{c - right, c + up}, {c + right, c - up}}};
}

Circle placed(const Circle& circle, const Placement& placement) {
  const double scale = std::sqrt(std::abs(placement.factor.x) * std::abs(placement.factor.y));
  return {placed_point(circle.centre, placement), scale * circle.radius};
}

Outline rotated(const Outline& outline, Point2 centre, Angle angle) {
  return moved(outline, Rotation(centre, angle));
}

Curve rotated(const Curve& curve, Point2 centre, Angle angle) {
  const Rotation rotation(centre, angle);
  Curve made = curve;
  for (CurvePoint& point : made) {
    const double heading = point.heading.rad() + angle.rad();
    point = {rotation(point.at), radians(std::atan2(std::sin(heading), std::cos(heading)))};
  }
  return made;
}

Circle rotated(const Circle& circle, Point2 centre, Angle angle) {
  return {Rotation(centre, angle)(circle.centre), circle.radius};
}

Outline reversed(const Outline& outline) {
  const std::size_t n = outline.segments.size();
  Outline made;
  made.start = outline.point(n);
  made.segments.reserve(n);
  for (std::size_t i = n; i-- > 0;) made.segments.push_back({outline.point(i), outline.segments[i].via});
  return made;
}

CornerRequests reversed(const CornerRequests& requests, const Outline& outline) {
  CornerRequests made = requests;
  made.resize(outline.elements());
  // The start of a closed outline is its end too; the request for this corner stays that of the start.
  std::reverse(made.begin() + (outline.closed() ? 1 : 0), made.end() - (outline.closed() ? 1 : 0));
  if (outline.closed()) made.back() = Length();
  return made;
}

Curve reversed(const Curve& curve) {
  Curve made(curve.rbegin(), curve.rend());
  for (CurvePoint& point : made) {
    const double heading = point.heading.rad();
    point.heading = radians(std::atan2(-std::sin(heading), -std::cos(heading)));
  }
  return made;
}

Outline closed(const Outline& outline) {
  Outline made = outline;
  if (!made.closed()) made.segments.push_back({made.start, std::nullopt});
  return made;
}

}  // namespace kerf
