// Measured points that are no points of their surface.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "kerf/op/level.h"

namespace kerf {
namespace {

constexpr std::size_t kMinPoints = 9, kMaxPoints = 5000, kNeighbours = 8;
constexpr double kSmallest = 0.05;   // mm, above the scatter of probes
constexpr double kDeviations = 8.0;  // medians of the others' differences

/// The height at `at` of the plane through `points` by least squares; their mean where they are on one line.
double plane_at(const std::vector<Point3>& points, Point2 at) {
  const auto n = static_cast<double>(points.size());
  double mx = 0.0, my = 0.0, mz = 0.0;
  for (const Point3& p : points) mx += p.x / n, my += p.y / n, mz += p.z / n;
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0;
  for (const Point3& p : points) {
    const double x = p.x - mx, y = p.y - my, z = p.z - mz;
    xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z;
  }
  const double det = xx * yy - xy * xy;
  if (det <= 1e-9 * (xx + yy) * (xx + yy)) return mz;
  return mz + ((xz * yy - yz * xy) * (at.x - mx) + (yz * xx - xz * xy) * (at.y - my)) / det;
}

class Outliers {
 public:
  explicit Outliers(const std::vector<Point3>& points) : points_(points), is_out_(points.size(), false) {}

  std::vector<std::size_t> find() {
    differences_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) differences_[i] = difference(i);
    std::vector<double> sorted = differences_;
    std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
    const double limit = std::max(kSmallest, kDeviations * sorted[sorted.size() / 2]);
    // An outlier also moves the planes of its neighbours: they are judged again without it.
    for (std::size_t found = 0; found < points_.size() / 4; ++found) {
      const auto worst = std::max_element(differences_.begin(), differences_.end());
      if (*worst <= limit) break;
      const auto i = static_cast<std::size_t>(worst - differences_.begin());
      is_out_[i] = true;
      differences_[i] = 0.0;
      for (std::size_t k = 0; k < points_.size(); ++k)
        if (!is_out_[k] && differences_[k] > limit) differences_[k] = difference(k);
    }
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (is_out_[i]) out.push_back(i);
    return out;
  }

 private:
  double difference(std::size_t i) {
    order_.clear();
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (k != i && !is_out_[k]) order_.emplace_back(distance(points_[k].xy(), points_[i].xy()), k);
    const std::size_t count = std::min(kNeighbours, order_.size());
    std::partial_sort(order_.begin(), order_.begin() + std::ptrdiff_t(count), order_.end());
    std::vector<Point3> near;
    for (std::size_t k = 0; k < count; ++k) near.push_back(points_[order_[k].second]);
    return near.empty() ? 0.0 : std::abs(points_[i].z - plane_at(near, points_[i].xy()));
  }

  const std::vector<Point3>& points_;
  std::vector<bool> is_out_;
  std::vector<double> differences_;
  std::vector<std::pair<double, std::size_t>> order_;
};

}  // namespace

std::vector<std::size_t> outliers_of(const std::vector<Point3>& points) {
  if (points.size() < kMinPoints || points.size() > kMaxPoints) return {};
  return Outliers(points).find();
}

}  // namespace kerf
