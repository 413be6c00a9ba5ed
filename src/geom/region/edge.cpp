// Chains of edges from lines and arcs.
#include "edge.h"

#include <algorithm>
#include <cmath>

namespace kerf::region_detail {
namespace {

/// Quadrants counter-clockwise, each with its start and without its end: 0 starts at +x.
int quadrant(Point2 v) {
  if (v.x > 0.0 && v.y >= 0.0) return 0;
  if (v.x <= 0.0 && v.y > 0.0) return 1;
  return v.x < 0.0 ? 2 : 3;
}

constexpr Point2 kEnds[4] = {{0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}, {1.0, 0.0}};  // of the quadrants

}  // namespace

Point2 direction_at(Point2 unit, double chord, double curvature, double ahead) {
  if (curvature == 0.0) return unit;
  // Seen from a point of the circle, another at distance d lies asin(curvature d / 2) off the tangent.
  const double near = std::clamp(0.5 * curvature * ahead, -1.0, 1.0);
  const double far = std::clamp(0.5 * curvature * chord, -1.0, 1.0);
  const double near_cosine = std::sqrt(1.0 - near * near), far_cosine = std::sqrt(1.0 - far * far);
  const double sine = near * far_cosine - near_cosine * far, cosine = near_cosine * far_cosine + near * far;
  return cosine * unit + sine * left_of(unit);
}

void EdgeSet::start_chain(Point2 at) {
  first_ = static_cast<std::uint32_t>(points.size());
  first_edge_ = edges.size();
  points.push_back(at);
}

void set_shape(Edge& e, Point2 from, Point2 to, double radius, double turn, double weld) {
  constexpr double kQuarter = 0.70710678118654752 * (1.0 - 1e-9);  // radius by chord of a quarter turn
  e.from = from;
  e.to = to;
  e.turn = 0.0;
  if (turn == 0.0) return;
  const double chord2 = dot(e.chord(), e.chord());
  e.radius = std::max(radius, kQuarter * std::sqrt(chord2));
  if (chord2 <= 1e-3 * weld * e.radius) return;
  e.turn = turn;
  e.centre = centre_over_chord(e.chord(), e.radius, turn);
}

void EdgeSet::push(Point2 to, std::uint32_t number, double radius, double turn) {
  Edge e;
  e.from_point = edges.size() == first_edge_ ? first_ : edges.back().to_point;
  set_shape(e, points[e.from_point], to, radius, turn, weld_);
  e.to_point = number;
  e.source = source_;
  e.step.of[group_] = 1;
  edges.push_back(e);
}

void EdgeSet::piece_to(Point2 to, double radius, double turn) {
  const Point2 step = to - here();
  if (dot(step, step) <= weld_ * weld_) return;
  points.push_back(to);
  push(to, static_cast<std::uint32_t>(points.size() - 1), radius, turn);
}

void EdgeSet::line_to(Point2 to) { piece_to(to, 0.0, 0.0); }

void EdgeSet::arc_to(Point2 from, Point2 to, Point2 centre, double radius, double turn) {
  // Mirrored in y, a clockwise arc is a counter-clockwise one.
  const auto seen = [&](Point2 p) { return Point2{p.x - centre.x, turn * (p.y - centre.y)}; };
  const Point2 start = seen(from), end = seen(to);
  const int first = quadrant(start);
  int ends = (quadrant(end) - first) & 3;
  if (ends == 0 && cross(start, end) < 0.0) ends = 4;
  for (int i = 0; i < ends; ++i) {
    const Point2 extreme = kEnds[(first + i) & 3];
    piece_to(centre + radius * Point2{extreme.x, turn * extreme.y}, radius, turn);
  }
  piece_to(to, radius, turn);
}

void EdgeSet::close() {
  if (edges.size() == first_edge_) {  // all of it in one point
    points.resize(first_);
    return;
  }
  const Point2 first = points[first_];
  if (distance(here(), first) > weld_) {
    push(first, first_, 0.0, 0.0);
    return;
  }
  // The last point is the first one.
  const Edge last = edges.back();
  edges.pop_back();
  points.pop_back();
  belongs_to(last.source, last.step.of[1] != 0 ? 1 : 0);
  push(first, first_, last.radius, last.turn);
}

void EdgeSet::circle(Point2 centre, double radius, double turn) {
  const Point2 right = centre + Point2{radius, 0.0}, left = centre - Point2{radius, 0.0};
  start_chain(right);
  arc_to(right, left, centre, radius, turn);
  arc_to(left, right, centre, radius, turn);
  close();
}

namespace {

template <class Source>
void add_segments(EdgeSet& set, const Outline& outline, std::uint32_t group, Source source) {
  set.start_chain(outline.start);
  Point2 from = outline.start;
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    const Segment& s = outline.segments[i];
    set.belongs_to(source(i), group);
    const auto c = outline_detail::make_carrier(from, s, 0.0);
    if (c.is_arc())
      set.arc_to(from, s.to, c.circle_centre(), c.radius, c.turn);
    else
      set.line_to(s.to);
    from = s.to;
  }
}

}  // namespace

std::uint32_t add_outline(EdgeSet& set, const Outline& outline, std::uint32_t source, std::uint32_t group) {
  add_segments(set, outline, group, [&](std::size_t i) { return source + static_cast<std::uint32_t>(i); });
  return source + static_cast<std::uint32_t>(outline.segments.size());
}

void add_outline(EdgeSet& set, const Outline& outline, const std::vector<std::uint32_t>& sources,
                 std::uint32_t group) {
  add_segments(set, outline, group, [&](std::size_t i) { return sources[i]; });
}

BoxTree tree_of(const std::vector<Edge>& edges, double margin) {
  std::vector<Box2> boxes;
  boxes.reserve(edges.size());
  for (const Edge& e : edges) boxes.push_back(e.box(margin));
  return BoxTree(boxes);
}

}  // namespace kerf::region_detail
