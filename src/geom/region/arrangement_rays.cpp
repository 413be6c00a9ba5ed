// Winding numbers from rays through the parts of an arrangement: from the first part that a ray meets, or
// from all of them where the order of the first is not certain.
#include <algorithm>
#include <cmath>

#include "arrangement.h"
#include "geom/base/exact.h"

namespace kerf::region_detail {
namespace {

constexpr double kFar = 1e300;

Box2 mirrored(const Box2& b) { return {{b.low.y, b.low.x}, {b.high.y, b.high.x}}; }

}  // namespace

double crossing_at(const Edge& e, double y) {
  const Point2 v = e.chord();
  const double dy = y - e.from.y;
  double dx = dy / v.y * v.x;
  if (e.is_arc()) {
    // Points of the circle at this height, relative to the start; the one between the ends.
    const double c = dy * (dy - 2.0 * e.centre.y), d = std::max(0.0, e.centre.x * e.centre.x - c);
    const double larger = e.centre.x + std::copysign(std::sqrt(d), e.centre.x);
    const double smaller = larger != 0.0 ? c / larger : 0.0;
    const auto off = [&](double x) {
      return std::max({0.0, std::min(0.0, v.x) - x, x - std::max(0.0, v.x)});
    };
    dx = off(smaller) <= off(larger) ? smaller : larger;
  }
  return e.from.x + dx;
}

int ray_crosses(const Edge& e, Point2 at) {
  const bool upward = e.to.y > e.from.y;
  // A point at this height belongs to the edge above it, so that a chain through it crosses once.
  if ((e.from.y > at.y) == (e.to.y > at.y)) return 0;
  const int step = upward ? -1 : 1;
  if (at.x < std::min(e.from.x, e.to.x)) return 0;
  if (at.x > std::max(e.from.x, e.to.x)) return step;
  if (!e.is_arc()) {
    const double side = upward ? orientation(e.from, e.to, at) : orientation(e.to, e.from, at);
    return side < 0.0 ? step : 0;
  }
  const Point2 q = at - e.from;
  const bool inside = dot(q, q) < 2.0 * dot(q, e.centre);
  const bool centre_right = e.centre.x > 0.5 * (e.to.x - e.from.x);
  return inside == centre_right ? step : 0;
}

Winding WindingSearch::around(Point2 at) const {
  Winding winding;
  tree_.query({{-kFar, at.y}, at}, [&](std::uint32_t i) {
    if (const int crossed = ray_crosses(edges_[i], at); crossed != 0)
      for (int g = 0; g < 2; ++g) winding.of[g] += crossed * edges_[i].step.of[g];
  });
  return winding;
}

/// A part as an edge; for rays to -y mirrored in the diagonal.
Edge Arrangement::drawn(const Part& part, Axis axis) const {
  const Edge& e = edges()[part.edge];
  Point2 a = points_[part.from], b = points_[part.to];
  double turn = e.turn;
  if (axis == Axis::y) {
    std::swap(a.x, a.y);
    std::swap(b.x, b.y);
    turn = -turn;
  }
  Edge made;
  set_shape(made, a, b, e.radius, turn, weld_);
  return made;
}

void Arrangement::cross_part(Ray& ray, std::uint32_t number, Axis axis) const {
  const Part& part = parts_[number];
  if (number == ray.part || component_[part.from] == ray.component) return;
  const Point2 at = axis == Axis::x ? ray.from : Point2{ray.from.y, ray.from.x};
  int crossed = ray_crosses(drawn(part, axis), at);
  if (crossed == 0) return;
  if (axis == Axis::y) crossed = -crossed;
  for (int g = 0; g < 2; ++g) ray.winding.of[g] += crossed * part.step.of[g];
}

void Arrangement::count(Ray& ray, Axis axis) const {
  const Point2 p = ray.from;
  ray.winding = {};
  const double m = reach();
  tree_.query(
      axis == Axis::x ? Box2{{-kFar, p.y - m}, {p.x + m, p.y + m}}
                      : Box2{{p.x - m, -kFar}, {p.x + m, p.y + m}},
      [&](std::uint32_t edge) { parts_of_edge(edge, [&](std::uint32_t i) { cross_part(ray, i, axis); }); });
}

/// The first part that a ray meets; uncertain where another one is within the tolerance of it, as at
/// ends of parts.
Arrangement::First Arrangement::first(const Ray& ray, Axis axis) const {
  const Point2 at = axis == Axis::x ? ray.from : Point2{ray.from.y, ray.from.x};
  First found;
  double nearest = -kFar, next = -kFar;
  const auto box = [axis, m = reach()](const Box2& b) {
    const Box2 seen = axis == Axis::x ? b : mirrored(b);
    return seen.grown(m);
  };
  tree_.leftwards(at, box, [&](std::uint32_t edge) {
    parts_of_edge(edge, [&](std::uint32_t i) {
      const Part& part = parts_[i];
      if (i == ray.part || component_[part.from] == ray.component) return;
      const Edge e = drawn(part, axis);
      if (ray_crosses(e, at) == 0) return;
      const double x = std::min(crossing_at(e, at.y), at.x);
      if (x > nearest) {
        next = nearest;
        nearest = x;
        found.part = i;
      } else {
        next = std::max(next, x);
      }
    });
    return nearest - weld_;
  });
  found.certain = nearest - next > weld_;
  return found;
}

/// The winding number at the start of a ray, by those beside the first part that it meets, or by all.
Winding Arrangement::cast(Ray& ray, Axis axis) const {
  const First found = first(ray, axis);
  if (!found.certain) {
    count(ray, axis);
    return ray.winding;
  }
  if (found.part == kNone) return {};
  const Part& part = parts_[found.part];
  const Point2 v = points_[part.to] - points_[part.from];
  // The start is to the right of an upward part, and to the left of one towards +x.
  Winding seen = (axis == Axis::x ? v.y < 0.0 : v.x > 0.0) ? part.left : part.right();
  for (int g = 0; g < 2; ++g) seen.of[g] += components_[component_[part.from]].offset.of[g];
  return seen;
}

}  // namespace kerf::region_detail
