// What the 2D and 3D modules of a program make: areas and solids.
//
// A solid is a stack of slabs, each a region between two heights; slabs do not overlap in height and are in
// order. Everything that vertical prisms, their unions, differences and intersections can be has this form.
// Spheres, cones and other solids are bodies of triangles beside the slabs: they can be moved and united
// only. Lengths in mm, Z up.
#pragma once

#include <cstdint>
#include <vector>

#include "kerf/geom/region.h"

namespace kerf::scad {

/// The solid between two heights over a region.
struct Slab {
  double low = 0.0, high = 0.0;  // mm
  Region region;
};

/// A closed surface, oriented outwards.
struct SolidBody {
  std::vector<double> positions;         // x y z, mm
  std::vector<std::uint32_t> triangles;  // three indices each
};

/// Nothing, an area, or a solid.
struct Shape {
  enum class Kind : unsigned char { nothing, area, solid };
  Kind kind = Kind::nothing;
  Region region;                  // of an area
  std::vector<Slab> slabs;        // of a solid, from the lowest up
  std::vector<SolidBody> bodies;  // of a solid, besides the slabs
  bool is_empty() const { return kind == Kind::area ? region.empty() : slabs.empty() && bodies.empty(); }
};

}  // namespace kerf::scad
