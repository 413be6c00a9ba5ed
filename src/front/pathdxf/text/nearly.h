// Comparisons of the coordinates and parameters of path drawings.
#pragma once

#include <algorithm>
#include <cmath>

#include "kerf/geom/geometry.h"

namespace kerf::pathdxf {

/// |a - b| <= 1e-6 * (max(|a|, |b|) + 0.001), the rule of PathDxf2GCode.
inline bool near(double a, double b) {
  return std::abs(a - b) <= 1e-6 * (std::max(std::abs(a), std::abs(b)) + 0.001);
}
inline bool above(double a, double b) { return a > b && !near(a, b); }
inline bool at_least(double a, double b) { return a > b || near(a, b); }

/// The largest distance of two points that count as one, mm: its square is near 0.
inline constexpr double kJoin = 3.163e-5;
inline bool near(Point2 a, Point2 b) { return near(dot(b - a, b - a), 0.0); }

}  // namespace kerf::pathdxf
