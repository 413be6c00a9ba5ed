// Finds edges that pierce triangles with a grid of cubes: each triangle is entered in the cubes of its box.
#include "mesh_crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kerf/geom/geometry.h"

namespace kerf::test {
namespace {

struct Corners {
  std::array<std::uint32_t, 3> number;
  std::array<Point3, 3> at;
};

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = mesh.triangles[3 * triangle + k];
    const float* p = mesh.positions.data() + std::size_t{3} * v;
    corners.number[k] = v;
    corners.at[k] = {p[0], p[1], p[2]};
  }
  return corners;
}

/// The depth of the edge a-b in a triangle; 0 if they do not meet.
double depth_of(Point3 a, Point3 b, const Corners& t, Point3& meets) {
  const Point3 across = cross(t.at[1] - t.at[0], t.at[2] - t.at[0]);
  const double area = length(across);
  if (area < 1e-12) return 0.0;
  const Point3 normal = (1.0 / area) * across;
  const double above = dot(a - t.at[0], normal), below = dot(b - t.at[0], normal);
  if (above * below >= 0.0) return 0.0;
  meets = a + (above / (above - below)) * (b - a);
  double depth = std::min(std::abs(above), std::abs(below));
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 side = t.at[(k + 1) % 3] - t.at[k];
    const double inside = dot(cross(normal, side), meets - t.at[k]) / std::max(length(side), 1e-12);
    depth = std::min(depth, inside);
  }
  return std::max(depth, 0.0);
}

struct Cubes {
  double side;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> triangles;

  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    return ((static_cast<std::uint64_t>(x) & kMask) << 42) | ((static_cast<std::uint64_t>(y) & kMask) << 21) |
           (static_cast<std::uint64_t>(z) & kMask);
  }
  template <class Visit>
  void over(Point3 low, Point3 high, Visit visit) {
    const auto cell = [&](double v) { return static_cast<std::int64_t>(std::floor(v / side)); };
    for (std::int64_t x = cell(low.x); x <= cell(high.x); ++x)
      for (std::int64_t y = cell(low.y); y <= cell(high.y); ++y)
        for (std::int64_t z = cell(low.z); z <= cell(high.z); ++z) visit(triangles[key(x, y, z)]);
  }
};

Point3 lower(Point3 a, Point3 b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Point3 upper(Point3 a, Point3 b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

/// A side for which a large flat triangle is in few cubes and a cube holds few small ones.
double side_of_cubes(const Mesh& mesh, double area) {
  return std::max(0.05, 1.5 * std::sqrt(2.0 * area / static_cast<double>(mesh.step.size() + 1)));
}

}  // namespace

Crossings find_crossings(const Mesh& mesh, double limit) {
  std::vector<Corners> all;
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.step.size(); ++t) {
    all.push_back(corners_of(mesh, t));
    area += 0.5 * length(cross(all[t].at[1] - all[t].at[0], all[t].at[2] - all[t].at[0]));
  }
  Cubes cubes{side_of_cubes(mesh, area), {}};
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    const auto& p = all[t].at;
    cubes.over(lower(lower(p[0], p[1]), p[2]), upper(upper(p[0], p[1]), p[2]),
               [&](std::vector<std::uint32_t>& list) { list.push_back(t); });
  }
  Crossings found;
  std::vector<std::uint32_t> seen(all.size(), 0);
  std::uint32_t edge = 0;
  for (const Corners& one : all)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = one.number[k], b = one.number[(k + 1) % 3];
      if (a > b) continue;  // in the neighbour's direction
      const Point3 from = one.at[k], to = one.at[(k + 1) % 3];
      ++edge;
      double deepest = 0.0;
      Point3 at;
      cubes.over(lower(from, to), upper(from, to), [&](const std::vector<std::uint32_t>& list) {
        for (const std::uint32_t t : list) {
          if (seen[t] == edge) continue;
          seen[t] = edge;
          const auto& n = all[t].number;
          if (std::count(n.begin(), n.end(), a) + std::count(n.begin(), n.end(), b) > 0) continue;
          Point3 meets;
          const double depth = depth_of(from, to, all[t], meets);
          if (depth <= deepest) continue;
          deepest = depth;
          at = meets;
        }
      });
      if (deepest > limit) ++found.edges;
      if (deepest <= found.deepest) continue;
      found.deepest = deepest;
      found.at = at;
    }
  return found;
}

}  // namespace kerf::test
