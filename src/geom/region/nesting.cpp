// Which hole belongs to which outer loop; area, length and bounds of regions.
#include <algorithm>

#include "kerf/region.h"

namespace kerf {

double area(const Region& region) {
  double sum = 0.0;
  for (const Outline& loop : region.loops) sum += area(loop);
  return sum;
}

Length length(const Region& region) {
  Length sum;
  for (const Outline& loop : region.loops) sum = sum + length(loop);
  return sum;
}

Box2 bounds(const Region& region) {
  Box2 box;
  for (const Outline& loop : region.loops) box.add(bounds(loop));
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
      if (!outers[k].box.contains(box)) continue;
      const auto inside = [&](Point2 p) { return outers[k].search.locate(p, {}) != Location::outside; };
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
