// The engagement angle along a path of a flat mill, from a picture of the material: what is inside a region
// and not yet within the tool's radius of an earlier position. Knows nothing of how the path was made.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <numbers>
#include <vector>

#include "swept.h"

namespace kerf::test {

class EngagementMeter {
 public:
  EngagementMeter(const Region& region, double radius, double pixel = 0.015)
      : box_(bounds(region).grown(0.5)), radius_(radius), pixel_(pixel) {
    width_ = static_cast<int>((box_.high.x - box_.low.x) / pixel_) + 1;
    height_ = static_cast<int>((box_.high.y - box_.low.y) / pixel_) + 1;
    material_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
    fill(region);
  }

  /// Follows all cuts at the level `z`; a helix down to it counts as cleared. The largest angle in degrees.
  double largest(const Toolpath& path, double z) {
    double highest = 0.0;
    for (const Motion& m : motions(path)) {
      const bool helix = m.arc && m.high() > z + 1e-9;
      if (m.rapid || m.low() > z + 1e-9) {
        clear_all();
        continue;
      }
      const double size = m.arc ? m.radius * std::abs(m.sweep) : distance(m.from, m.to);
      const int count = std::max(1, static_cast<int>(std::ceil(size / kSpacing)));
      for (int i = 0; i <= count; ++i) {
        const double t = static_cast<double>(i) / count;
        const Point2 at = m.arc ? m.centre + m.radius * direction(m.start + t * m.sweep)
                                : m.from.xy() + t * (m.to.xy() - m.from.xy());
        const Point2 way = m.arc ? std::copysign(1.0, m.sweep) * left_of(direction(m.start + t * m.sweep))
                                 : m.to.xy() - m.from.xy();
        if (length(way) > 0.0 && !helix) {
          const double here = angle(at, way);
          if (here > highest) highest = here, where = at;
        }
        pending_.push_back(at);
        while (pending_.size() > kLag) clear(pending_.front()), pending_.pop_front();
      }
    }
    clear_all();
    return highest;
  }
  Point2 where{};  ///< of the largest angle

 private:
  static Point2 direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

  /// Rows of pixels between crossings with the boundary.
  void fill(const Region& region) {
    const RegionSearch search(region);
    for (int j = 0; j < height_; ++j)
      for (int i = 0; i < width_;) {
        const Point2 p{box_.low.x + i * pixel_, box_.low.y + j * pixel_};
        const double clearance = search.clearance(p)->mm();
        const int run = std::max(1, static_cast<int>(std::abs(clearance) / pixel_));
        for (int k = i; k < std::min(i + run, width_); ++k) at(k, j) = clearance > 0.0 ? 1 : 0;
        i += run;
      }
  }
  std::uint8_t& at(int i, int j) {
    return material_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(i)];
  }
  int column(double x) const { return static_cast<int>(std::lround((x - box_.low.x) / pixel_)); }
  int row(double y) const { return static_cast<int>(std::lround((y - box_.low.y) / pixel_)); }

  void clear(Point2 p) {
    for (int j = std::max(0, row(p.y - radius_)); j <= std::min(height_ - 1, row(p.y + radius_)); ++j) {
      const double dy = box_.low.y + j * pixel_ - p.y, square = radius_ * radius_ - dy * dy;
      if (square < 0.0) continue;
      const double half = std::sqrt(square);
      const int first = std::max(0, column(p.x - half)), last = std::min(width_ - 1, column(p.x + half));
      if (first <= last) std::fill(&at(first, j), &at(last, j) + 1, std::uint8_t{0});
    }
  }
  void clear_all() {
    for (const Point2 p : pending_) clear(p);
    pending_.clear();
  }

  /// Of the leading half of the circle in material; what is nearer to its ends than kBlind counts as the
  /// points beside it do, since the tool has not moved far enough to decide.
  double angle(Point2 p, Point2 way) {
    const double heading = std::atan2(way.y, way.x), r = radius_ - 1.5 * pixel_;
    int inside = 0;
    for (int k = -90; k < 90; ++k) {
      const double a = std::clamp(k + 0.5, kBlind - 90.0, 90.0 - kBlind) * std::numbers::pi / 180.0;
      const Point2 q = p + r * direction(heading + a);
      const int i = column(q.x), j = row(q.y);
      if (i >= 0 && j >= 0 && i < width_ && j < height_ && at(i, j) != 0) ++inside;
    }
    return inside;
  }

  static constexpr double kSpacing = 0.08, kBlind = 5.0;
  static constexpr std::size_t kLag = 4;
  Box2 box_;
  double radius_, pixel_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> material_;
  std::deque<Point2> pending_;
};

}  // namespace kerf::test
