// Limits of a machine along a direction, and the path of rapids whose axes move each at its own rate.
#include "kerf/path/machine.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf {

double along(Point3 way, const std::array<double, 3>& limits) {
  const double whole = length(way);
  double allowed = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double part = std::abs(way[axis]);
    if (part > 0.0) allowed = std::min(allowed, limits[static_cast<std::size_t>(axis)] * (whole / part));
  }
  return allowed;
}

std::vector<RapidCorner> corners_of_rapid(const Point3& from, const Point3& to, const AxisRates& rates) {
  constexpr double kSameTime = 1e-9;  // of the whole time
  const Point3 way = to - from;
  std::array<double, 3> minutes{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    minutes[axis] = std::abs(way[static_cast<int>(axis)]) / rates[axis].mm_per_min();
  std::array<double, 3> ends = minutes;
  std::sort(ends.begin(), ends.end());
  std::vector<RapidCorner> corners;
  for (const double end : {ends[0], ends[1]}) {
    const double fraction = ends[2] > 0.0 ? end / ends[2] : 0.0;
    const double before = corners.empty() ? 0.0 : corners.back().fraction;
    if (fraction - before < kSameTime || 1.0 - fraction < kSameTime) continue;
    const auto part = [&](std::size_t axis) { return minutes[axis] > end ? end / minutes[axis] : 1.0; };
    corners.push_back({from + Point3{part(0) * way.x, part(1) * way.y, part(2) * way.z}, fraction});
  }
  return corners;
}

}  // namespace kerf
