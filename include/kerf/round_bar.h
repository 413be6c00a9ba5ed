// A round bar that turns about an axis along X: the stock of a fourth axis (A).
#pragma once

namespace kerf {

struct RoundBar {
  double diameter = 0.0;              // mm
  double x_low = 0.0, x_high = 0.0;   // mm, its ends
  double axis_y = 0.0, axis_z = 0.0;  // mm, of the axis in work coordinates
};

}  // namespace kerf
