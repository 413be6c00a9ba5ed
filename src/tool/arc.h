// The circle of a profile arc.
#pragma once

#include <cmath>

#include "kerf/tool.h"

namespace kerf::detail {

/// Centre and radius in mm of the arc that starts at a knot with a bulge.
struct ProfileArc {
  double r = 0.0, z = 0.0;
  double radius = 0.0;
};

inline ProfileArc profile_arc(const Knot& from, const Knot& to) {
  const double dr = to.r - from.r;
  const double dz = to.z - from.z;
  const double b = from.bulge;
  // The centre lies on the chord's left normal, at this fraction of the chord from its midpoint.
  const double fraction = (1.0 - b * b) / (4.0 * b);
  return {0.5 * (from.r + to.r) - fraction * dz, 0.5 * (from.z + to.z) + fraction * dr,
          std::hypot(dr, dz) * (1.0 + b * b) / (4.0 * std::abs(b))};
}

}  // namespace kerf::detail
