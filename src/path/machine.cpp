// Limits of a machine along a direction.
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

}  // namespace kerf
