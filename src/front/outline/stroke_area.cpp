// Builds the area of a stroke from loops for segments, corners and ends, which are united.
#include "front/outline/stroke_area.h"

#include <algorithm>
#include <cmath>

#include "base/codes/outline.h"
#include "front/outline/dashes.h"

namespace kerf::outline_front {
namespace {

class StrokeBuilder {
 public:
  /// `direction` is that of a dot.
  StrokeBuilder(const Outline& outline, Point2 direction, const Stroke& stroke)
      : outline_(outline), direction_(direction), stroke_(stroke), half_(0.5 * stroke.width) {}

  std::vector<Outline> loops() {
    const std::size_t count = outline_.segments.size();
    if (count == 0) point();
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
    constexpr double kChords = 0.05;  // between chords of a curve a mitre is as good as a disc
    const bool is_chord = stroke_.frame && std::abs(turn) < kChords && dot(a, b) > 0.0;
    if (stroke_.corners == dxf::StrokeCorners::round && !is_chord) return disc(at);
    const double side = turn > 0.0 ? -half_ : half_;  // the outer side
    const Point2 p = at + side * left_of(a), q = at + side * left_of(b);
    const double sine =
        std::sqrt(std::max(0.0, 0.5 * (1.0 - dot(a, -1.0 * b))));  // of half the angle between
    const bool is_mitre =
        stroke_.corners == dxf::StrokeCorners::mitre && sine > 0.0 && 1.0 / sine <= stroke_.mitre_limit;
    if (is_chord || is_mitre) {
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

  void point() {
    end(outline_.start, direction_);
    if (stroke_.ends == dxf::StrokeEnds::square) end(outline_.start, -1.0 * direction_);
  }

  const Outline& outline_;
  const Point2 direction_;
  const Stroke& stroke_;
  const double half_;
  std::vector<Outline> loops_;
};

/// An outline as chords, in other coordinates.
Outline transformed(const Outline& outline, const StrokeFrame& frame, Length chord) {
  Outline out;
  const std::vector<Point2> points = flattened(outline, chord);
  out.start = frame * points.front();
  for (std::size_t i = 1; i < points.size(); ++i) out.segments.push_back({frame * points[i], {}});
  if (outline.closed() && !out.segments.empty()) out.segments.back().to = out.start;
  return out;
}

/// The largest factor by which lengths grow.
double largest_scale(const StrokeFrame& m) {
  return 0.5 * (std::hypot(m.a + m.d, m.b - m.c) + std::hypot(m.a - m.d, m.b + m.c));
}

}  // namespace

StrokeFrame StrokeFrame::inverse() const {
  const double size = a * d - b * c;
  return {d / size, -b / size, -c / size, a / size};
}

Stroke stroke_of(const dxf::Paint& paint, double mm_per_unit) {
  Stroke made{paint.width,  paint.ends,        paint.corners,    paint.mitre_limit,
              paint.dashes, paint.dash_offset, paint.path_length};
  const auto [a, b, c, d] = paint.frame;
  const StrokeFrame frame{mm_per_unit * a, mm_per_unit * b, mm_per_unit * c, mm_per_unit * d};
  if (paint.uneven) {
    made.frame = frame;
    return made;
  }
  const double size = std::hypot(frame.a, frame.b);
  made.width *= size;
  for (double& dash : made.dashes) dash *= size;
  made.dash_offset *= size;
  made.path_length *= size;
  if (size > 0.0) made.x_axis = {frame.a / size, frame.b / size};
  return made;
}

double stroke_length(const Outline& outline, const Stroke& stroke, Length chord) {
  return stroke.frame ? length(transformed(outline, stroke.frame->inverse(), chord)).mm()
                      : length(outline).mm();
}

std::optional<Region> stroke_area(const Outline& outline, const Stroke& stroke, const RegionOptions& options,
                                  Diagnostics& diagnostics) {
  const Length chord = 0.1 * options.tolerance.chord;
  const Outline own = stroke.frame ? transformed(outline, stroke.frame->inverse(), chord) : outline;
  std::vector<Dash> pieces{{own, stroke.frame ? Point2{1.0, 0.0} : stroke.x_axis}};
  if (!stroke.dashes.empty() && !own.segments.empty()) {
    if (auto made = dashed(own, stroke.dashes, stroke.dash_offset))
      pieces = std::move(*made);
    else
      diagnostics.warning(codes::drawing_ignored, options.where,
                          "a stroke has too many dashes; it is drawn without gaps");
  }
  std::vector<Outline> loops;
  for (const Dash& piece : pieces)
    for (Outline& loop : StrokeBuilder(piece.outline, piece.direction, stroke).loops())
      loops.push_back(std::move(loop));
  if (stroke.frame) {
    const Length fine = (1.0 / largest_scale(*stroke.frame)) * chord;
    for (Outline& loop : loops) {
      loop = transformed(loop, *stroke.frame, fine);
      if (area(loop) < 0.0) loop = reversed(loop);
    }
  }
  return make_region(loops, FillRule::nonzero, options, diagnostics);
}

}  // namespace kerf::outline_front
