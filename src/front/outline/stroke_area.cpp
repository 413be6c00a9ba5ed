// Builds the area of a stroke from loops for segments, corners and ends, which are united.
#include "front/outline/stroke_area.h"

#include <algorithm>
#include <cmath>

namespace kerf::outline_front {
namespace {

class StrokeBuilder {
 public:
  StrokeBuilder(const Outline& outline, const Stroke& stroke)
      : outline_(outline), stroke_(stroke), half_(0.5 * stroke.width) {}

  std::vector<Outline> loops() {
    const std::size_t count = outline_.segments.size();
    for (std::size_t i = 0; i < count; ++i) {
      segment(i);
      if (i + 1 < count || outline_.closed()) corner(i, (i + 1) % count);
    }
    if (!outline_.closed() && count > 0) {
      end(outline_.start, -1.0 * direction(0, false));
      end(outline_.point(count), direction(count - 1, true));
    }
    return std::move(loops_);
  }

 private:
  std::optional<ArcCircle> arc(std::size_t i) const {
    return arc_circle(outline_.point(i), outline_.segments[i]);
  }

  /// The unit tangent at the start or the end of a segment.
  Point2 direction(std::size_t i, bool at_end) const {
    const Point2 from = outline_.point(i), to = outline_.segments[i].to;
    const auto circle = arc(i);
    if (!circle) return (1.0 / distance(from, to)) * (to - from);
    const Point2 radius = (at_end ? to : from) - circle->centre;
    const double turn = circle->turn == Turn::ccw ? 1.0 : -1.0;
    return (turn / circle->radius) * left_of(radius);
  }

  /// Adds a loop through points, counter-clockwise.
  void polygon(std::vector<Point2> points) {
    Outline loop{points.front(), {}};
    for (std::size_t i = 1; i < points.size(); ++i) loop.segments.push_back({points[i], {}});
    loop.segments.push_back({points.front(), {}});
    add(std::move(loop));
  }
  void add(Outline loop) {
    const double inside = area(loop);
    if (inside == 0.0) return;
    loops_.push_back(inside > 0.0 ? std::move(loop) : reversed(loop));
  }

  void segment(std::size_t i) {
    const Point2 from = outline_.point(i), to = outline_.segments[i].to;
    const auto circle = arc(i);
    if (!circle) {
      const Point2 side = half_ * left_of(direction(i, false));
      return polygon({from - side, to - side, to + side, from + side});
    }
    const Point2 via = *outline_.segments[i].via;
    const auto at = [&](Point2 p, double radius) {
      return circle->centre + (radius / circle->radius) * (p - circle->centre);
    };
    const double outer = circle->radius + half_, inner = circle->radius - half_;
    // Between the arcs; where the stroke is wider than the arc's diameter a sector on each side of the
    // centre.
    const auto sector = [&](double r) {
      Outline loop{circle->centre, {}};
      loop.segments = {{at(from, r)}, {at(to, r), at(via, r)}, {circle->centre, {}}};
      add(std::move(loop));
    };
    if (inner <= 0.0) {
      sector(outer);
      if (inner < 0.0) sector(inner);
      return;
    }
    Outline loop{at(from, inner)};
    loop.segments = {{at(from, outer)},
                     {at(to, outer), at(via, outer)},
                     {at(to, inner)},
                     {at(from, inner), at(via, inner)}};
    add(std::move(loop));
  }

  void disc(Point2 centre) { add(as_outline(Circle{centre, mm(half_)})); }

  void corner(std::size_t before, std::size_t after) {
    constexpr double kSmooth = 1e-7;  // of the sine of the turn between segments of a curve
    const Point2 a = direction(before, true), b = direction(after, false), at = outline_.segments[before].to;
    const double turn = cross(a, b);
    if (std::abs(turn) <= kSmooth && dot(a, b) > 0.0) return;
    if (stroke_.corners == dxf::StrokeCorners::round) return disc(at);
    const double side = turn > 0.0 ? -half_ : half_;  // the outer side
    const Point2 p = at + side * left_of(a), q = at + side * left_of(b);
    const double sine =
        std::sqrt(std::max(0.0, 0.5 * (1.0 - dot(a, -1.0 * b))));  // of half the angle between
    if (stroke_.corners == dxf::StrokeCorners::mitre && sine > 0.0 && 1.0 / sine <= stroke_.mitre_limit) {
      const Point2 chord = 0.5 * (p + q) - at;
      const double length = std::sqrt(dot(chord, chord));
      return polygon({at, p, at + (half_ / sine / length) * chord, q});
    }
    polygon({at, p, q});
  }

  void end(Point2 at, Point2 outwards) {
    if (stroke_.ends == dxf::StrokeEnds::round) return disc(at);
    if (stroke_.ends == dxf::StrokeEnds::butt) return;
    const Point2 side = half_ * left_of(outwards), far = at + half_ * outwards;
    polygon({at - side, far - side, far + side, at + side});
  }

  const Outline& outline_;
  const Stroke& stroke_;
  const double half_;
  std::vector<Outline> loops_;
};

}  // namespace

std::optional<Region> stroke_area(const Outline& outline, const Stroke& stroke, const RegionOptions& options,
                                  Diagnostics& diagnostics) {
  return make_region(StrokeBuilder(outline, stroke).loops(), FillRule::nonzero, options, diagnostics);
}

}  // namespace kerf::outline_front
