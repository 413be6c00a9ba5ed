// Triangles of a mesh that pierce each other.
#pragma once

#include <cstddef>

#include "kerf/sim/mesh.h"

namespace kerf::test {

/// Edges through triangles at other vertices.
struct Crossings {
  std::size_t edges = 0;  // deeper than the limit
  double deepest = 0.0;   // mm
  Point3 at;              // of the deepest
};

/// The depth of an edge in a triangle: the minimum of the distances of the edge's ends from the plane of the
/// triangle, and of the point where they meet from the triangle's sides.
Crossings find_crossings(const Mesh& mesh, double limit);

}  // namespace kerf::test
