// Nesting of the loops of a region; measures and transforms of regions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "arrangement.h"

#include "kerf/geom/region.h"

namespace kerf {
namespace {

using namespace region_detail;

/// Finds the smallest loop around each loop: by the first loop that a ray to -x from it meets, or by all of
/// them where the order of the first ones is not certain.
class NestingSearch {
 public:
  explicit NestingSearch(const Region& region);
  std::vector<std::uint32_t> parents();
  const std::vector<double>& areas() const { return areas_; }

 private:
  enum class State : std::uint8_t { unknown, followed, known };
  struct Hit {
    std::uint32_t loop = Nesting::kNone;
    bool around = false;  // the loop met is around the ray's start
    bool certain = true;
  };
  Hit first_hit(std::uint32_t loop) const;
  std::uint32_t smallest_around(std::uint32_t loop) const;

  EdgeSet set_{0.0};
  BoxTree tree_;
  std::vector<double> areas_;
  std::vector<Point2> starts_;  // of the rays: the midpoint of each loop's longest edge
  std::vector<State> states_;
  double margin_ = 0.0;  // of the order of intersections along a ray
};

NestingSearch::NestingSearch(const Region& region) {
  double largest = 0.0;
  for (std::uint32_t i = 0; i < region.loops.size(); ++i) {
    const Outline& loop = region.loops[i];
    const std::size_t first = set_.edges.size();
    add_outline(set_, loop, std::vector<std::uint32_t>(loop.segments.size(), i), 0);
    set_.close();
    areas_.push_back(area(loop));
    Point2 start = loop.start;
    double longest = 0.0;
    for (std::size_t k = first; k < set_.edges.size(); ++k) {
      const Edge& e = set_.edges[k];
      if (const double length = norm(e.chord()); length > longest) {
        longest = length;
        start = e.is_arc() ? outline_detail::arc_midpoint(e.from, e.to, e.circle_centre(), e.radius, e.turn)
                           : 0.5 * (e.from + e.to);
      }
    }
    starts_.push_back(start);
  }
  for (const Point2 p : set_.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  margin_ = 0x1p-40 * largest;
  tree_ = tree_of(set_.edges, 0.0);
  states_.resize(areas_.size());
}

NestingSearch::Hit NestingSearch::first_hit(std::uint32_t loop) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const Point2 at = starts_[loop];
  Hit hit;
  double nearest = -kFar, next = -kFar;
  tree_.leftwards(
      at, [](const Box2& box) { return box; },
      [&](std::uint32_t i) {
        const Edge& e = set_.edges[i];
        const int step = e.source == loop ? 0 : ray_crosses(e, at);
        if (step == 0) return nearest - margin_;
        const double x = std::min(crossing_at(e, at.y), at.x);
        next = std::max(next, std::min(x, nearest));
        if (x > nearest) {
          nearest = x;
          hit.loop = e.source;
          // The region is on the left of an edge, the loop around it if that is the loop's inside.
          hit.around = step * areas_[e.source] > 0.0;
        }
        return nearest - margin_;
      });
  hit.certain = hit.loop == Nesting::kNone || (at.x - nearest > margin_ && nearest - next > margin_);
  return hit;
}

std::uint32_t NestingSearch::smallest_around(std::uint32_t loop) const {
  const Point2 at = starts_[loop];
  std::vector<std::uint32_t> met;
  tree_.query({{-std::numeric_limits<double>::infinity(), at.y}, at}, [&](std::uint32_t i) {
    const Edge& e = set_.edges[i];
    if (e.source != loop && ray_crosses(e, at) != 0) met.push_back(e.source);
  });
  std::sort(met.begin(), met.end());
  std::uint32_t best = Nesting::kNone;
  for (std::size_t i = 0, next = 0; i < met.size(); i = next) {
    while (next < met.size() && met[next] == met[i]) ++next;
    if ((next - i) % 2 == 1 && std::abs(areas_[met[i]]) > std::abs(areas_[loop]) &&
        (best == Nesting::kNone || std::abs(areas_[met[i]]) < std::abs(areas_[best])))
      best = met[i];
  }
  return best;
}

std::vector<std::uint32_t> NestingSearch::parents() {
  std::vector<std::uint32_t> parents(areas_.size(), Nesting::kNone), trail;
  for (std::uint32_t first = 0; first < areas_.size(); ++first) {
    // Loops that have the same loop around them, up to one for which that is known.
    std::uint32_t loop = first, parent = Nesting::kNone;
    for (trail.clear();;) {
      if (states_[loop] == State::known) {
        parent = parents[loop];
        break;
      }
      const Hit hit = states_[loop] == State::followed ? Hit{0, false, false} : first_hit(loop);
      if (states_[loop] == State::unknown) trail.push_back(loop);
      states_[loop] = State::followed;
      if (!hit.certain)
        parent = smallest_around(loop);
      else if (hit.around)
        parent = hit.loop;
      if (!hit.certain || hit.around || hit.loop == Nesting::kNone) break;
      loop = hit.loop;
    }
    for (const std::uint32_t own : trail) {
      parents[own] = parent;
      states_[own] = State::known;
    }
  }
  return parents;
}

}  // namespace

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

namespace {

template <class Transform>
Region each_loop(const Region& region, Transform transform) {
  Region made;
  made.loops.reserve(region.loops.size());
  for (const Outline& loop : region.loops) made.loops.push_back(transform(loop));
  return made;
}

}  // namespace

Region placed(const Region& region, const Placement& placement) {
  return each_loop(region, [&](const Outline& loop) { return placed(loop, placement); });
}

Region rotated(const Region& region, Point2 centre, Angle angle) {
  return each_loop(region, [&](const Outline& loop) { return rotated(loop, centre, angle); });
}

Region merged(const Region& region, Length within) {
  return each_loop(region, [&](const Outline& loop) { return merged(loop, within); });
}

Nesting nesting(const Region& region) {
  NestingSearch search(region);
  Nesting made;
  made.parents = search.parents();
  made.depths.assign(region.loops.size(), 0);
  // A loop is smaller than those around it.
  std::vector<std::uint32_t> order(region.loops.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto size = [&](std::uint32_t loop) { return std::abs(search.areas()[loop]); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
  for (const std::uint32_t loop : order)
    if (const std::uint32_t parent = made.parents[loop]; parent != Nesting::kNone)
      made.depths[loop] = made.depths[parent] + 1;
  return made;
}

std::vector<Figure> figures(const Region& region) {
  const Nesting tree = nesting(region);
  std::vector<std::uint32_t> outers;
  std::vector<double> areas;
  for (std::uint32_t i = 0; i < region.loops.size(); ++i) {
    areas.push_back(area(region.loops[i]));
    if (areas[i] > 0.0) outers.push_back(i);
  }
  std::stable_sort(outers.begin(), outers.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return areas[a] < areas[b]; });
  std::vector<Figure> made;
  std::vector<std::size_t> figure_of(region.loops.size());
  for (const std::uint32_t outer : outers) {
    figure_of[outer] = made.size();
    made.emplace_back().push_back(region.loops[outer]);
  }
  for (std::uint32_t i = 0; i < region.loops.size(); ++i)
    if (areas[i] <= 0.0 && tree.parents[i] != Nesting::kNone && areas[tree.parents[i]] > 0.0)
      made[figure_of[tree.parents[i]]].push_back(region.loops[i]);
  return made;
}

}  // namespace kerf
