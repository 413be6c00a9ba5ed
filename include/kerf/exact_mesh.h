// Sharp edges, exact walls and surfaces for the mesh of a cut part: from the columns surfaces are known to
// about half a pitch, from the toolpath exactly.
#pragma once

#include <optional>

#include "kerf/diagnostics.h"
#include "kerf/mesh.h"
#include "kerf/progress.h"
#include "kerf/simulate.h"
#include "kerf/tolerance.h"
#include "kerf/units.h"

namespace kerf {

struct SharpenOptions {
  /// An edge whose midpoint is further than this from the surface gets another vertex.
  Length tolerance = default_tolerance::kExactMesh;
  unsigned threads = 0;  // 0: as many as the machine has. The mesh is the same for any number.
};

/// Moves the vertices of `mesh`, which extract_mesh has made of the simulation's workpiece, onto the surfaces
/// that the tools left: walls to their true position, edges to where their two surfaces meet, corners to
/// where three do, curved surfaces to their height. No vertex leaves the square of its corner of the columns,
/// what lies on the stock's block stays on it, and the mesh stays closed. Surfaces of a stock that is no
/// block, and features smaller than a pitch, stay as the columns have them. False if stopped; the mesh is
/// then unchanged. See docs/decisions/0019-exact-meshes.md.
bool sharpen_mesh(Mesh& mesh, const Simulation& simulation, const SharpenOptions& options = {},
                  Progress* progress = nullptr);

/// extract_mesh and then sharpen_mesh. If the result is not valid, as with cuts along the side of a block of
/// a few coarse columns, the mesh is as the columns have it, relabelled, with a warning. Nothing if stopped.
std::optional<CheckedMesh> extract_exact_mesh(const Simulation& simulation, const MeshOptions& options,
                                              Diagnostics& diagnostics, Progress* progress = nullptr);

/// For a mesh that is not sharpened: between the stock's surface and a steep cut there is a strip as wide as
/// a column, whose triangles are alternately assigned to the one and the other. Assigns all of them to the
/// cut, as in a sharpened mesh. Changes only the triangles' steps.
void relabel_mesh(Mesh& mesh, const Workpiece& workpiece);

}  // namespace kerf
