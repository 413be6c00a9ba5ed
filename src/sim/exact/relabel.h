// Whose the triangles of a sharpened mesh are.
#pragma once

#include "kerf/mesh.h"

namespace kerf::sim {

/// Triangles that count as the block's own surface but lie on none of its sides take the step of a neighbour
/// that was cut; those that lie on the block's top or bottom are its own.
void relabel_triangles(Mesh& mesh, const Box3& block);

}  // namespace kerf::sim
