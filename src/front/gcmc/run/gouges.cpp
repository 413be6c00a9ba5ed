// Gouges of a compensated path.
#include "front/gcmc/run/gouges.h"

#include <map>

#include "geom/base/box_tree.h"

namespace kerf::gcmc {
namespace {

constexpr double kRounding = 1e-6;  // a part of the width, below which a gouge is rounding

std::vector<LineArc> sides_of(const CompensatedTrace& trace) {
  std::vector<LineArc> sides;
  const std::size_t n = trace.path.size();
  for (std::size_t i = 0; i + 1 < n; ++i) sides.push_back(line_between(trace.path[i], trace.path[i + 1]));
  if (trace.closed && n > 2) sides.push_back(line_between(trace.path[n - 1], trace.path[0]));
  return sides;
}

}  // namespace

std::vector<Gouge> find_gouges(const CompensatedTrace& trace) {
  const std::vector<LineArc> sides = sides_of(trace);
  std::vector<Box2> boxes;
  for (const LineArc& side : sides) boxes.push_back(bounds(side));
  if (boxes.empty()) return {};
  const BoxTree tree(boxes);
  const double least = kRounding * (1.0 + trace.width);
  std::map<std::size_t, Gouge> deepest;
  for (const LineArc& motion : trace.motions) {
    Box2 near = bounds(motion);
    near.low = near.low - Point2{trace.width, trace.width};
    near.high = near.high + Point2{trace.width, trace.width};
    tree.query(near, [&](std::size_t i) {
      const ClosestPoints closest = closest_points(motion, sides[i]);
      const double depth = trace.width - distance(closest.first, closest.second);
      if (depth <= least) return;
      const std::size_t next = (i + 1) % trace.path.size();
      const bool is_first_half =
          distance(closest.second, trace.path[i]) <= distance(closest.second, trace.path[next]);
      const std::size_t corner = is_first_half ? i : next;
      const auto [it, is_new] = deepest.try_emplace(corner, Gouge{corner, closest.second, depth});
      if (!is_new && depth > it->second.depth) it->second = {corner, closest.second, depth};
    });
  }
  std::vector<Gouge> gouges;
  for (const auto& [corner, gouge] : deepest) gouges.push_back(gouge);
  return gouges;
}

}  // namespace kerf::gcmc
