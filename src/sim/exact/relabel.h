// Assigns the triangles of an exact mesh to steps again.
#pragma once

#include "kerf/sim/mesh.h"

namespace kerf::sim {

/// Triangles with kStockSurface that lie on no side of the block get the step of a neighbour that has one.
/// Triangles that lie on the block's top or bottom get kStockSurface.
void relabel_triangles(Mesh& mesh, const Box3& block);

}  // namespace kerf::sim
