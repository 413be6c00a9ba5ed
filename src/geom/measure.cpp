// Area, length and bounds of outlines and regions, and which hole belongs to which outer loop.
#include <algorithm>
#include <cmath>
#include <limits>

#include "edge.h"

#include "kerf/region.h"

namespace kerf {
namespace {

using namespace region_detail;

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr Box2 kNothing{{kFar, kFar}, {-kFar, -kFar}};

/// x - sin x, without the cancellation where x is small.
double less_its_sine(double x) {
  if (x > 0.5) return x - std::sin(x);
  const double xx = x * x;
  double term = x * xx / 6.0, sum = term;
  for (int k = 4; k <= 12; k += 2) sum += term *= -xx / (k * (k + 1));
  return sum;
}

void add(Box2& box, Point2 p) {
  box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
  box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
}

void add(Box2& box, const Box2& other) {
  if (other.empty()) return;
  add(box, other.low);
  add(box, other.high);
}

bool within(const Box2& inner, const Box2& outer) {
  return inner.low.x >= outer.low.x && inner.low.y >= outer.low.y && inner.high.x <= outer.high.x &&
         inner.high.y <= outer.high.y;
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

double area(const Region& region) {
  double sum = 0.0;
  for (const Outline& loop : region.loops) sum += area(loop);
  return sum;
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

Length length(const Region& region) {
  Length sum;
  for (const Outline& loop : region.loops) sum = sum + length(loop);
  return sum;
}

Box2 bounds(const Outline& outline) {
  EdgeSet set(0.0);  // whose arcs end at their extremes
  add_outline(set, outline, 0, 0);
  Box2 box = kNothing;
  for (const Point2 p : set.points) add(box, p);
  return box;
}

Box2 bounds(const Region& region) {
  Box2 box = kNothing;
  for (const Outline& loop : region.loops) add(box, bounds(loop));
  return box;
}

std::vector<Figure> figures(const Region& region) {
  struct Outer {
    std::size_t loop;
    double size;
    Box2 box;
    RegionSearch search;
  };
  std::vector<Outer> outers;
  std::vector<Figure> made;
  for (std::size_t i = 0; i < region.loops.size(); ++i)
    if (const double size = area(region.loops[i]); size > 0.0)
      outers.push_back({i, size, bounds(region.loops[i]), RegionSearch({{region.loops[i]}})});
  std::sort(outers.begin(), outers.end(), [](const Outer& a, const Outer& b) { return a.size < b.size; });
  for (const Outer& outer : outers) made.push_back({region.loops[outer.loop]});
  for (const Outline& loop : region.loops) {
    if (area(loop) > 0.0) continue;
    // The smallest outer loop around it; a hole may touch it in points, but not with all of its points.
    const Box2 box = bounds(loop);
    for (std::size_t k = 0; k < outers.size(); ++k) {
      if (!within(box, outers[k].box)) continue;
      const auto inside = [&](Point2 p) { return outers[k].search.locate(p, {}) != Place::outside; };
      if (!std::all_of(loop.segments.begin(), loop.segments.end(),
                       [&](const Segment& s) { return inside(s.to); }))
        continue;
      made[k].push_back(loop);
      break;
    }
  }
  return made;
}

}  // namespace kerf
