// Closed meshes with known volumes: boxes, prisms, spheres as polyhedra.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "kerf/geom/geometry.h"

namespace kerf::test {

struct Triangles {
  std::vector<double> positions;
  std::vector<std::uint32_t> triangles;

  std::uint32_t point(Point3 p) {
    positions.insert(positions.end(), {p.x, p.y, p.z});
    return static_cast<std::uint32_t>(positions.size() / 3 - 1);
  }
  void face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles.insert(triangles.end(), {a, b, c});
  }
  void add(const Triangles& other, bool inside_out = false) {
    const auto first = static_cast<std::uint32_t>(positions.size() / 3);
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    for (std::size_t t = 0; t < other.triangles.size(); t += 3)
      face(first + other.triangles[t], first + other.triangles[t + (inside_out ? 2 : 1)],
           first + other.triangles[t + (inside_out ? 1 : 2)]);
  }
};

inline Triangles box_mesh(Point3 low, Point3 high) {
  Triangles out;
  for (const double z : {low.z, high.z})
    for (const auto& [x, y] : {std::pair{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}})
      out.point({x, y, z});
  out.triangles = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                   1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
  return out;
}

/// A round bar along Z as a prism with `sides` sides; its volume is sides / 2 * r^2 * sin(2 pi / sides) *
/// height.
inline Triangles prism_mesh(Point3 base, double radius, double height, int sides) {
  Triangles out;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / sides;
    const double x = base.x + radius * std::cos(angle), y = base.y + radius * std::sin(angle);
    out.point({x, y, base.z});
    out.point({x, y, base.z + height});
  }
  const std::uint32_t low = out.point(base), high = out.point({base.x, base.y, base.z + height});
  for (int k = 0; k < sides; ++k) {
    const auto a = static_cast<std::uint32_t>(2 * k), b = static_cast<std::uint32_t>(2 * ((k + 1) % sides));
    out.face(a, b, b + 1);
    out.face(a, b + 1, a + 1);
    out.face(low, b, a);
    out.face(high, a + 1, b + 1);
  }
  return out;
}

/// A sphere of rings of triangles; its volume is slightly below 4/3 pi r^3.
inline Triangles sphere_mesh(Point3 centre, double radius, int rings) {
  Triangles out;
  const int sides = 2 * rings;
  const auto at = [&](int ring, int side) {
    return static_cast<std::uint32_t>(2 + (ring - 1) * sides + side % sides);
  };
  out.point({centre.x, centre.y, centre.z - radius});
  out.point({centre.x, centre.y, centre.z + radius});
  for (int ring = 1; ring < rings; ++ring) {
    const double tilt = std::numbers::pi * ring / rings;
    for (int side = 0; side < sides; ++side) {
      const double turn = 2.0 * std::numbers::pi * side / sides;
      out.point(centre + radius * Point3{std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                                         -std::cos(tilt)});
    }
  }
  for (int side = 0; side < sides; ++side) {
    out.face(0, at(1, side + 1), at(1, side));
    out.face(1, at(rings - 1, side), at(rings - 1, side + 1));
    for (int ring = 1; ring + 1 < rings; ++ring) {
      out.face(at(ring, side), at(ring, side + 1), at(ring + 1, side + 1));
      out.face(at(ring, side), at(ring + 1, side + 1), at(ring + 1, side));
    }
  }
  return out;
}

}  // namespace kerf::test
