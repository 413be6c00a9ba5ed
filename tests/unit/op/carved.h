// The surface that a path leaves, point by point: the lowest position of the tool's silhouette above it.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "swept.h"

#include "kerf/op/operation.h"

namespace kerf::test {

/// Of the cutting motions of a path; lines at any slope, arcs on one level or as helices.
class CarvedSurface {
 public:
  CarvedSurface(const Toolpath& path, const Tool& tool) : reach_(0.5 * tool.diameter.mm()) {
    for (int i = 0; i <= kSamples; ++i) {
      // The height at which the tool has a radius, by halving.
      const double radius = reach_ * i / kSamples;
      double low = 0.0, high = tool.flute.mm();
      for (int k = 0; k < 50; ++k) {
        const double midpoint = 0.5 * (low + high);
        (cutting_radius(tool, mm(midpoint)).mm() < radius ? low : high) = midpoint;
      }
      heights_.push_back(radius == 0.0 ? 0.0 : high);
    }
    for (const Motion& m : motions(path))
      if (!m.rapid) cuts_.push_back(m);
  }

  /// Z of the surface; 0 where nothing was cut.
  double height(Point2 p) const {
    double z = 0.0;
    for (const Motion& m : cuts_) {
      if (m.low() >= z || m.distance_to(p) > reach_) continue;
      z = std::min(z, m.arc || m.from.z == m.to.z ? m.high() + height_at(m.distance_to(p)) : lowest(m, p));
    }
    return z;
  }

 private:
  double height_at(double radius) const {
    const double at = radius / reach_ * kSamples;
    const auto i = static_cast<std::size_t>(std::min(std::floor(at), double{kSamples - 1}));
    if (at > kSamples) return 1e9;
    return heights_[i] + (heights_[i + 1] - heights_[i]) * (at - static_cast<double>(i));
  }
  /// Along a slope: for convex tools the height over p has one minimum.
  double lowest(const Motion& m, Point2 p) const {
    const auto over = [&](double t) {
      const Point3 at = m.from + t * (m.to - m.from);
      return at.z + height_at(std::min(distance(at.xy(), p), reach_)) +
             (distance(at.xy(), p) > reach_ ? 1e9 : 0.0);
    };
    // From the nearest point, where the tool reaches, towards the lower end.
    const Point2 way = m.to.xy() - m.from.xy();
    const double square = dot(way, way);
    const double nearest = square > 0.0 ? std::clamp(dot(p - m.from.xy(), way) / square, 0.0, 1.0) : 0.0;
    double a = m.to.z < m.from.z ? nearest : 0.0, b = m.to.z < m.from.z ? 1.0 : nearest;
    double best = std::min({over(a), over(b), over(nearest)});
    for (int k = 0; k < 60; ++k) {
      const double c = a + 0.382 * (b - a), d = a + 0.618 * (b - a);
      const double at_c = over(c), at_d = over(d);
      best = std::min({best, at_c, at_d});
      (at_c < at_d ? b : a) = at_c < at_d ? d : c;
    }
    return best;
  }

  static constexpr int kSamples = 2000;
  double reach_;
  std::vector<double> heights_;
  std::vector<Motion> cuts_;
};

}  // namespace kerf::test
