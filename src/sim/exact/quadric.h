// Least-squares intersection of planes: of two planes the nearest point of their line, of three their common
// point.
#pragma once

#include <array>

#include "kerf/geom/geometry.h"

namespace kerf::sim {

/// The sum of squared distances to planes, as a function of the displacement d from a reference point:
/// sum (n_k d - offset_k)^2. Its minimum solves A d = b with A = sum n_k n_k^T, b = sum offset_k n_k. Along
/// eigenvectors of A with small eigenvalues the planes do not determine d: planes of one edge leave one such
/// direction, a single plane leaves two.
class Quadric {
 public:
  /// Adds a plane with a unit normal, `offset` mm from the reference point along its normal.
  void add(Point3 normal, double offset);
  /// Fixes the displacement along an axis at 0.
  void fix(int axis);

  /// The shortest displacement that minimises the sum along the eigenvectors of the `rank` (1 to 3) largest
  /// eigenvalues. Those below `min_fraction` of the largest are omitted.
  Point3 solve(int rank, double min_fraction) const;
  /// The number of eigenvalues of at least `min_fraction` of the largest.
  int rank(double min_fraction) const;

 private:
  struct Eigen {
    std::array<double, 3> value{};  // largest first
    std::array<Point3, 3> vector{};
  };
  const Eigen& eigen() const;

  std::array<double, 6> matrix_{};  // xx xy xz yy yz zz
  Point3 right_side_;
  mutable Eigen eigen_;
  mutable bool is_solved_ = false;
};

}  // namespace kerf::sim
