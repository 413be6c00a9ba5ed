// A polygon with holes as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kerf/geom/geometry.h"

namespace kerf::outline_detail {

using Ring = std::vector<Point2>;  // closed, the first point not repeated

double area(const Ring& ring);  // above 0: counter-clockwise

struct Triangulation {
  bool too_much = false;  ///< the limit of work was exceeded
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Triangles of the region inside rings[0] (counter-clockwise) and outside the others (clockwise), as indices
/// into the rings' points one after the other. All points are used, so that walls can be built on the rings.
/// No triangles where the rings cross themselves or each other.
Triangulation triangulate(const std::vector<Ring>& rings);

}  // namespace kerf::outline_detail
