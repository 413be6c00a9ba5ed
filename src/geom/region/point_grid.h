// Points in cells of a grid, stored as a hash table, to find the nearest one within a distance.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "kerf/geom/geometry.h"

namespace kerf::region_detail {

class PointGrid {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// For queries within `distance`, and at most `count` points, given by their index in `points`.
  PointGrid(const std::vector<Point2>& points, double distance, std::size_t count)
      : points_(points), distance_(distance) {
    std::size_t size = 16;
    while (size < 2 * count) size *= 2;
    slots_.assign(size, {0, 0, kNone});
  }
  void add(std::uint32_t point) {
    const Cell at = cell_of(points_[point]);
    std::size_t slot = slot_of(at.x, at.y);
    while (slots_[slot].point != kNone) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = {at.x, at.y, point};
  }
  /// The nearest point within the distance, or kNone.
  std::uint32_t nearest(Point2 at) const {
    const Cell own = cell_of(at);
    double least = distance_ * distance_;
    std::uint32_t best = kNone;
    for (std::int64_t x = own.x - 1; x <= own.x + 1; ++x)
      for (std::int64_t y = own.y - 1; y <= own.y + 1; ++y)
        for (std::size_t slot = slot_of(x, y); slots_[slot].point != kNone;
             slot = (slot + 1) & (slots_.size() - 1)) {
          if (slots_[slot].x != x || slots_[slot].y != y) continue;
          const Point2 d = points_[slots_[slot].point] - at;
          if (const double dd = dot(d, d); dd <= least) {
            least = dd;
            best = slots_[slot].point;
          }
        }
    return best;
  }

 private:
  struct Cell {
    std::int64_t x, y;
  };
  struct Slot {
    std::int64_t x, y;
    std::uint32_t point;
  };
  Cell cell_of(Point2 p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / distance_)),
            static_cast<std::int64_t>(std::floor(p.y / distance_))};
  }
  std::size_t slot_of(std::int64_t x, std::int64_t y) const {
    std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(y)) * 0xbf58476d1ce4e5b9u;
    return static_cast<std::size_t>(h ^ (h >> 32)) & (slots_.size() - 1);
  }

  const std::vector<Point2>& points_;
  double distance_;
  std::vector<Slot> slots_;
};

}  // namespace kerf::region_detail
