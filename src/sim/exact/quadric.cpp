// Eigenvalues of a symmetric 3 x 3 matrix by Jacobi rotations, and the solution in the space of the large
// ones.
#include "sim/exact/quadric.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf::sim {
namespace {

/// Rounds of rotations. Each about squares the off-diagonal elements, so these are more than enough.
constexpr int kMaxRounds = 12;
/// The matrix is diagonal when the off-diagonal elements are below this fraction of its trace.
constexpr double kDiagonal = 1e-16;

using Matrix = std::array<std::array<double, 3>, 3>;

/// Rotates in the plane of axes p and q so that element (p, q) becomes 0.
void rotate(Matrix& a, Matrix& v, std::size_t p, std::size_t q) {
  if (a[p][q] == 0.0) return;
  const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
  const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double kp = a[k][p], kq = a[k][q];
    a[k][p] = c * kp - s * kq;
    a[k][q] = s * kp + c * kq;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double pk = a[p][k], qk = a[q][k];
    a[p][k] = c * pk - s * qk;
    a[q][k] = s * pk + c * qk;
    const double vp = v[k][p], vq = v[k][q];
    v[k][p] = c * vp - s * vq;
    v[k][q] = s * vp + c * vq;
  }
}

}  // namespace

void Quadric::add(Point3 n, double offset) {
  is_solved_ = false;
  matrix_[0] += n.x * n.x;
  matrix_[1] += n.x * n.y;
  matrix_[2] += n.x * n.z;
  matrix_[3] += n.y * n.y;
  matrix_[4] += n.y * n.z;
  matrix_[5] += n.z * n.z;
  right_side_ = right_side_ + offset * n;
}

void Quadric::fix(int axis) {
  is_solved_ = false;
  constexpr int kOf[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (const int k : kOf[axis]) matrix_[static_cast<std::size_t>(k)] = 0.0;
  right_side_[axis] = 0.0;
}

const Quadric::Eigen& Quadric::eigen() const {
  if (std::exchange(is_solved_, true)) return eigen_;
  Matrix a{{{matrix_[0], matrix_[1], matrix_[2]},
            {matrix_[1], matrix_[3], matrix_[4]},
            {matrix_[2], matrix_[4], matrix_[5]}}};
  Matrix v{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  const double negligible = kDiagonal * (a[0][0] + a[1][1] + a[2][2]);
  for (int n = 0; n < kMaxRounds; ++n) {
    if (std::max({std::abs(a[0][1]), std::abs(a[0][2]), std::abs(a[1][2])}) <= negligible) break;
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) { return a[p][p] > a[q][q]; });
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = order[k];
    eigen_.value[k] = std::max(a[from][from], 0.0);
    eigen_.vector[k] = {v[0][from], v[1][from], v[2][from]};
  }
  return eigen_;
}

int Quadric::rank(double min_fraction) const {
  const Eigen& eigen = this->eigen();
  int count = 0;
  for (const double value : eigen.value)
    if (value > 0.0 && value >= min_fraction * eigen.value[0]) ++count;
  return count;
}

Point3 Quadric::solve(int rank, double min_fraction) const {
  const Eigen& eigen = this->eigen();
  Point3 sum;
  for (std::size_t k = 0; k < static_cast<std::size_t>(rank); ++k) {
    if (eigen.value[k] <= 0.0 || eigen.value[k] < min_fraction * eigen.value[0]) break;
    sum = sum + (dot(eigen.vector[k], right_side_) / eigen.value[k]) * eigen.vector[k];
  }
  return sum;
}

}  // namespace kerf::sim
