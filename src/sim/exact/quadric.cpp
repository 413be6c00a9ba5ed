// Eigenvalues of a symmetric 3 x 3 matrix by Jacobi's rotations, and the step along the strong ones.
#include "sim/exact/quadric.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf::sim {
namespace {

/// Each sweep of rotations about squares what is left beside the diagonal: these are more than enough.
constexpr int kMaxSweeps = 12;
/// What is left there, as a share of all strengths, when it is below what double precision tells.
constexpr double kNoCoupling = 1e-16;

using Matrix = std::array<std::array<double, 3>, 3>;

/// Turns axes p and q so that the matrix has 0 there.
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
  solved_ = false;
  square_[0] += n.x * n.x;
  square_[1] += n.x * n.y;
  square_[2] += n.x * n.z;
  square_[3] += n.y * n.y;
  square_[4] += n.y * n.z;
  square_[5] += n.z * n.z;
  pull_ = pull_ + offset * n;
}

void Quadric::fix(int axis) {
  solved_ = false;
  constexpr int kOf[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  for (const int k : kOf[axis]) square_[static_cast<std::size_t>(k)] = 0.0;
  pull_[axis] = 0.0;
}

const Quadric::Axes& Quadric::axes() const {
  if (std::exchange(solved_, true)) return axes_;
  Matrix a{{{square_[0], square_[1], square_[2]},
            {square_[1], square_[3], square_[4]},
            {square_[2], square_[4], square_[5]}}};
  Matrix v{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  const double least = kNoCoupling * (a[0][0] + a[1][1] + a[2][2]);
  for (int n = 0; n < kMaxSweeps; ++n) {
    if (std::max({std::abs(a[0][1]), std::abs(a[0][2]), std::abs(a[1][2])}) <= least) break;
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) { return a[p][p] > a[q][q]; });
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = order[k];
    axes_.strength[k] = std::max(a[from][from], 0.0);
    axes_.direction[k] = {v[0][from], v[1][from], v[2][from]};
  }
  return axes_;
}

int Quadric::directions(double least_share) const {
  const Axes& axes = this->axes();
  int count = 0;
  for (const double strength : axes.strength)
    if (strength > 0.0 && strength >= least_share * axes.strength[0]) ++count;
  return count;
}

Point3 Quadric::step(int directions, double least_share) const {
  const Axes& axes = this->axes();
  Point3 step;
  for (std::size_t k = 0; k < static_cast<std::size_t>(directions); ++k) {
    if (axes.strength[k] <= 0.0 || axes.strength[k] < least_share * axes.strength[0]) break;
    step = step + (dot(axes.direction[k], pull_) / axes.strength[k]) * axes.direction[k];
  }
  return step;
}

}  // namespace kerf::sim
