// A static tree of boxes (a packed R-tree): which boxes overlap one, and which overlap each other.
//
// The boxes are put in order along a Hilbert curve and grouped by eights, level by level, so that boxes of
// one group lie near each other for any order of the input.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kerf/geom/geometry.h"

namespace kerf {

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box2>& boxes);

  /// Calls visit(item) for each box that overlaps `box`, with its index in the input.
  template <class Visit>
  void query(const Box2& box, Visit visit) const {
    descend(box, 0, [&](std::size_t leaf) {
      for (std::size_t i = leaf * kGroup; i < end_of(leaf); ++i)
        if (boxes_[i].overlaps(box)) visit(items_[i]);
    });
  }
  /// Calls visit(item, item) once for each pair of boxes that overlap, until it returns false.
  template <class Visit>
  bool pairs(Visit visit) const {
    const std::size_t leaves = levels_.empty() ? 0 : levels_[0].size();
    bool go_on = true;
    for (std::size_t own = 0; own < leaves && go_on; ++own)
      descend(levels_[0][own], own, [&](std::size_t other) {
        if (go_on) go_on = pairs_between(own, other, visit);
      });
    return go_on;
  }
  /// Calls visit(item) for the boxes, transformed by seen(box), that a ray from `at` to -x intersects,
  /// roughly from the nearest on. Boxes to the left of the x that `visit` returned last are skipped.
  template <class Seen, class Visit>
  void leftwards(Point2 at, Seen seen, Visit visit) const;
  /// Finds the item with the smallest `distance_to(item)`, which is called only where the item's box is
  /// nearer to `at` than the smallest so far; `best` starts as the largest distance of interest.
  template <class Distance>
  void nearest(const Box2& at, double best, Distance distance_to) const;
  template <class Distance>
  void nearest(Point2 at, double best, Distance distance_to) const {
    nearest(Box2{at, at}, best, distance_to);
  }

 private:
  static constexpr std::size_t kGroup = 8;
  std::size_t end_of(std::size_t leaf) const { return std::min((leaf + 1) * kGroup, boxes_.size()); }

  /// Calls visit(leaf) for the leaves that overlap `box`, from leaf `first` on.
  template <class Visit>
  void descend(const Box2& box, std::size_t first, Visit visit) const {
    if (levels_.empty()) return;
    walk(levels_.size() - 1, 0, levels_.back().size(), box, first, visit);
  }
  template <class Visit>
  void walk(std::size_t level, std::size_t begin, std::size_t end, const Box2& box, std::size_t first,
            Visit& visit) const {
    // Node k of a level covers the leaves from k << shift on.
    const std::size_t shift = 3 * level;
    for (std::size_t k = begin; k < end; ++k) {
      if (((k + 1) << shift) <= first || !levels_[level][k].overlaps(box)) continue;
      if (level == 0)
        visit(k);
      else
        walk(level - 1, k * kGroup, std::min((k + 1) * kGroup, levels_[level - 1].size()), box, first, visit);
    }
  }
  template <class Visit>
  bool pairs_between(std::size_t own, std::size_t other, Visit& visit) const {
    for (std::size_t i = own * kGroup; i < end_of(own); ++i) {
      if (own != other && !boxes_[i].overlaps(levels_[0][other])) continue;
      for (std::size_t j = own == other ? i + 1 : other * kGroup; j < end_of(other); ++j)
        if (boxes_[i].overlaps(boxes_[j]) && !visit(items_[i], items_[j])) return false;
    }
    return true;
  }

  std::vector<Box2> boxes_;                // in order along the curve
  std::vector<std::uint32_t> items_;       // their numbers
  std::vector<std::vector<Box2>> levels_;  // of groups: 0 the smallest, the last a single one
};

inline double distance_between(const Box2& a, const Box2& b) {
  const double x = std::max({b.low.x - a.high.x, 0.0, a.low.x - b.high.x});
  const double y = std::max({b.low.y - a.high.y, 0.0, a.low.y - b.high.y});
  return std::sqrt(x * x + y * y);
}

template <class Seen, class Visit>
void BoxTree::leftwards(Point2 at, Seen seen, Visit visit) const {
  struct Waiting {
    double reach;
    std::size_t level, node;
    bool operator<(const Waiting& o) const { return reach < o.reach; }  // the rightmost first
  };
  if (levels_.empty()) return;
  double furthest = -std::numeric_limits<double>::infinity();
  std::vector<Waiting> heap;
  const auto push = [&](const Box2& stored, std::size_t level, std::size_t node) {
    const Box2 box = seen(stored);
    if (box.low.y > at.y || box.high.y < at.y || box.low.x > at.x || box.high.x < furthest) return;
    heap.push_back({std::min(box.high.x, at.x), level, node});
    std::push_heap(heap.begin(), heap.end());
  };
  push(levels_.back()[0], levels_.size() - 1, 0);
  while (!heap.empty() && heap.front().reach >= furthest) {
    std::pop_heap(heap.begin(), heap.end());
    const Waiting entry = heap.back();
    heap.pop_back();
    const std::size_t first = entry.node * kGroup;
    if (entry.level == 0) {
      for (std::size_t i = first; i < end_of(entry.node); ++i) {
        const Box2 box = seen(boxes_[i]);
        if (box.low.y <= at.y && box.high.y >= at.y && box.low.x <= at.x && box.high.x >= furthest)
          furthest = visit(items_[i]);
      }
      continue;
    }
    const std::vector<Box2>& below = levels_[entry.level - 1];
    for (std::size_t k = first; k < std::min(first + kGroup, below.size()); ++k)
      push(below[k], entry.level - 1, k);
  }
}

template <class Distance>
void BoxTree::nearest(const Box2& at, double best, Distance distance_to) const {
  struct Waiting {
    double distance;
    std::size_t level, node;
    bool operator<(const Waiting& o) const { return distance > o.distance; }  // the nearest first
  };
  if (levels_.empty()) return;
  std::vector<Waiting> heap{{distance_between(at, levels_.back()[0]), levels_.size() - 1, 0}};
  while (!heap.empty() && heap.front().distance < best) {
    std::pop_heap(heap.begin(), heap.end());
    const Waiting entry = heap.back();
    heap.pop_back();
    if (entry.level == 0) {
      for (std::size_t i = entry.node * kGroup; i < end_of(entry.node); ++i)
        if (distance_between(at, boxes_[i]) < best) best = std::min(best, distance_to(items_[i]));
      continue;
    }
    const std::vector<Box2>& below = levels_[entry.level - 1];
    for (std::size_t k = entry.node * kGroup; k < std::min((entry.node + 1) * kGroup, below.size()); ++k) {
      heap.push_back({distance_between(at, below[k]), entry.level - 1, k});
      std::push_heap(heap.begin(), heap.end());
    }
  }
}

}  // namespace kerf
