// The order of closed paths.
#include "op/base/inner_first.h"

#include <algorithm>
#include <cmath>

namespace kerf::op_detail {
namespace {

constexpr std::size_t kMaxOrdered = 20'000;  // paths; the time of the order is their square

double to_box(Point2 p, const Box2& b) {
  return std::hypot(std::max({b.low.x - p.x, 0.0, p.x - b.high.x}),
                    std::max({b.low.y - p.y, 0.0, p.y - b.high.y}));
}

double area_of(const Box2& b) { return (b.high.x - b.low.x) * (b.high.y - b.low.y); }

}  // namespace

InnerFirst::InnerFirst(const std::vector<Loop>& loops) : loops_(loops), around_(loops.size()) {
  const auto count = static_cast<std::uint32_t>(loops.size());
  if (count > kMaxOrdered) {
    for (std::uint32_t i = 0; i < count; ++i) ready_.push_back(i);
    // From the back, where take() removes them.
    std::stable_sort(ready_.begin(), ready_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return area_of(loops[a].box) > area_of(loops[b].box);
    });
    return;
  }
  waits_.resize(loops.size());
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t j = 0; j < count; ++j)
      if (i != j && holds(i, j)) around_[j].push_back(i), ++waits_[i];
  for (std::uint32_t i = 0; i < count; ++i)
    if (waits_[i] == 0) ready_.push_back(i);
}

bool InnerFirst::holds(std::uint32_t outer, std::uint32_t inner) const {
  const Box2 &a = loops_[outer].box, &b = loops_[inner].box;
  return a.contains(b) && (!b.contains(a) || outer > inner);
}

std::uint32_t InnerFirst::take(std::optional<Point2> here) {
  std::size_t best = 0;
  double shortest = INFINITY;
  if (waits_.empty()) {
    best = ready_.size() - 1;
  } else {
    for (std::size_t i = 0; i < ready_.size() && here; ++i) {
      const double d = to_box(*here, loops_[ready_[i]].box);
      if (d < shortest) shortest = d, best = i;
    }
  }
  const std::uint32_t loop = ready_[best];
  ready_.erase(ready_.begin() + static_cast<std::ptrdiff_t>(best));
  for (const std::uint32_t outer : around_[loop])
    if (--waits_[outer] == 0) ready_.push_back(outer);
  return loop;
}

std::vector<Loop> loops_of(const std::vector<Outline>& outlines, Length weld) {
  std::vector<Loop> loops;
  for (const Outline& outline : outlines)
    if (Track track(outline, weld.mm()); !track.empty()) loops.push_back({std::move(track), bounds(outline)});
  return loops;
}

}  // namespace kerf::op_detail
