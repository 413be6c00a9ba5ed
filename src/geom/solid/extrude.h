// A figure given a thickness: the solid between z = 0 and a height, as a closed mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/base/tolerance.h"
#include "kerf/geom/outline.h"

namespace kerf {

/// Triangles of a solid: positions x y z in mm, three indices per triangle, counter-clockwise seen from
/// outside. Every edge belongs to exactly two triangles, which is verified.
struct SolidMesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> triangles;
};

/// The first outline is the outside, the others are holes; their sense of turning does not matter. Arcs
/// become chords within `tolerance.chord`. Nothing, with errors appended, for an empty figure, an open
/// outline, a height or radius not above 0, and outlines that cross themselves or each other.
std::optional<SolidMesh> extrude(const Figure& figure, Length height, const Tolerance& tolerance,
                                 Diagnostics& diagnostics);

}  // namespace kerf
