// Arcs as chords.
#include <algorithm>
#include <cmath>

#include "kerf/geom/outline.h"

namespace kerf {
namespace {

constexpr int kMaxChords = 1 << 12;  // of one arc
constexpr int kMinChords = 16;       // of a full circle, so that a coarse tolerance still leaves it round

/// Appends the points of an arc between its ends.
void add_arc(std::vector<Point2>& points, Point2 from, const ArcCircle& circle, double chord) {
  const double step = 2.0 * std::acos(1.0 - std::clamp(chord / circle.radius, 0.0, 1.0));
  const double minimum = circle.sweep.deg() / 360.0 * kMinChords;
  const double wanted = std::ceil(std::max(step > 0.0 ? circle.sweep.rad() / step : kMaxChords, minimum));
  const int count = static_cast<int>(std::min<double>(wanted, kMaxChords));
  const Point2 d = from - circle.centre;
  const double start = std::atan2(d.y, d.x), sense = circle.turn == Turn::ccw ? 1.0 : -1.0;
  for (int i = 1; i < count; ++i) {
    const double angle = start + sense * circle.sweep.rad() * i / count;
    points.push_back(circle.centre + circle.radius * Point2{std::cos(angle), std::sin(angle)});
  }
}

}  // namespace

std::vector<Point2> flattened(const Outline& outline, Length chord) {
  std::vector<Point2> points{outline.start};
  Point2 from = outline.start;
  for (const Segment& segment : outline.segments) {
    if (const auto circle = arc_circle(from, segment)) add_arc(points, from, *circle, chord.mm());
    from = segment.to;
    points.push_back(from);
  }
  return points;
}

std::vector<Point2> flattened(const Circle& circle, Length chord) {
  const Point2 right = circle.centre + Point2{circle.radius.mm(), 0.0};
  std::vector<Point2> points{right};
  add_arc(points, right, {circle.centre, circle.radius.mm(), Turn::ccw, degrees(360.0)}, chord.mm());
  return points;
}

}  // namespace kerf
