// The points at which squares with walls are measured: a lattice in each, shifted from square to square.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace kerf::sim {

/// The points of a square: a lattice that is even in all directions, with one point in each of `count`
/// columns and rows; `row` is the row of the point in each column.
struct WallLattice {
  int count;
  int row[16];
  std::size_t max_squares;  // maximum number of squares for this lattice
  bool counts_rest;         // whether the quarters of columns beside squares are measured too
};
/// The lattice of each square is shifted by a pseudo-random offset, so that the total error grows with the
/// root of the number of squares only: for many squares few points suffice. The error along the whole outline
/// is below a thousandth of a pitch.
inline constexpr WallLattice kWallLattices[] = {
    {16, {0, 5, 10, 15, 4, 9, 14, 3, 8, 13, 2, 7, 12, 1, 6, 11}, 1 << 14, true},
    {4, {1, 3, 0, 2}, 1 << 16, true},
    {2, {0, 1}, SIZE_MAX, false},
};
inline const WallLattice& lattice_of(std::size_t squares) {
  return *std::find_if(std::begin(kWallLattices), std::end(kWallLattices),
                       [=](const WallLattice& lattice) { return squares <= lattice.max_squares; });
}

/// A hash of the position of a square.
inline std::uint32_t scrambled(std::uint32_t i, std::uint32_t j) {
  std::uint32_t v = i * 0x9e3779b1u ^ (j * 0x85ebca77u + 0x165667b1u);
  v = (v ^ (v >> 15)) * 0x2c1b3c6du;
  v = (v ^ (v >> 12)) * 0x297a2d39u;
  return v ^ (v >> 15);
}

/// Calls visit(x, y) for the points of square (i, j): fractions of its width and depth, from 0 to below 1.
template <class Visit>
void visit_points(const WallLattice& lattice, int i, int j, const Visit& visit) {
  const auto fraction = [](std::uint32_t bits) { return static_cast<double>(bits & 0xffffu) / 65536.0; };
  const auto wrapped = [](double v) { return v < 1.0 ? v : v - 1.0; };
  const double count = lattice.count;
  const std::uint32_t bits = scrambled(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
  for (int k = 0; k < lattice.count; ++k)
    visit(wrapped(fraction(bits) + k / count), wrapped(fraction(bits >> 16) + lattice.row[k] / count));
}

}  // namespace kerf::sim
