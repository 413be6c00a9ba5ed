// A round bar that turns about an axis along X: the stock of a fourth axis (A).
#pragma once

#include "kerf/geometry.h"

namespace kerf {

struct RoundBar {
  double diameter = 0.0;              // mm
  double x_low = 0.0, x_high = 0.0;   // mm, its ends
  double axis_y = 0.0, axis_z = 0.0;  // mm, of the axis in work coordinates
};

/// The box around a bar, in work coordinates.
inline Box3 box_of(const RoundBar& bar) {
  const double radius = 0.5 * bar.diameter;
  Box3 box;
  box.add(Point3{bar.x_low, bar.axis_y - radius, bar.axis_z - radius});
  box.add(Point3{bar.x_high, bar.axis_y + radius, bar.axis_z + radius});
  return box;
}

}  // namespace kerf
