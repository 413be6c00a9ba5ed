// The place that lies best on several planes: where two meet nearest to where one stands, where three meet.
#pragma once

#include <array>

#include "kerf/geometry.h"

namespace kerf::sim {

/// The sum of squared distances to planes, as a function of a step from the place that all planes are told
/// from.
class Quadric {
 public:
  /// Adds a plane with a unit normal, `offset` mm from the place along its normal.
  void add(Point3 normal, double offset);
  /// The step holds this axis still.
  void fix(int axis);

  /// The smallest step to where the sum is least, as far as `directions` (1 to 3) strongest directions tell
  /// it; directions that are weaker than `least_share` of the strongest tell nothing.
  Point3 step(int directions, double least_share) const;
  /// How many directions tell something.
  int directions(double least_share) const;

 private:
  struct Axes {
    std::array<double, 3> strength{};  // strongest first
    std::array<Point3, 3> direction{};
  };
  const Axes& axes() const;

  std::array<double, 6> square_{};  // xx xy xz yy yz zz
  Point3 pull_;
  mutable Axes axes_;
  mutable bool solved_ = false;
};

}  // namespace kerf::sim
