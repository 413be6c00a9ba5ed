// Exact meshes: the columns locate edges and walls to about half a pitch only; their exact position follows
// from the toolpath and the tools.
#pragma once

#include <optional>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/sim/mesh.h"
#include "kerf/sim/simulate.h"

namespace kerf {

struct ExactMeshOptions {
  /// Maximum distance of an edge's midpoint from the surface; edges beyond it are flipped or split.
  Length tolerance = default_tolerance::kExactMesh;
  unsigned threads = 0;  // 0: as many as the machine has. The mesh is the same for any number.
};

/// Moves the vertices of `mesh`, which extract_mesh has made of the simulation's workpiece, onto the surfaces
/// that the tools left: walls to their position, edges and corners to the intersection of their two or three
/// surfaces, curved surfaces to their height. Each vertex stays within half a pitch of its corner of the
/// columns in X and Y, vertices on the faces of the block stay there, and the mesh stays closed. Surfaces of
/// stock that is not a block, and features smaller than a pitch, are not improved. False if stopped; the mesh
/// is then unchanged. See docs/decisions/0019-exact-meshes.md.
bool make_mesh_exact(Mesh& mesh, const Simulation& simulation, const ExactMeshOptions& options = {},
                     Progress* progress = nullptr);

/// extract_mesh, then make_mesh_exact. If the result is not valid, as may happen with cuts along the side of
/// a block of a few coarse columns, the extracted mesh after relabel_mesh, with a warning. Nothing if
/// stopped.
std::optional<CheckedMesh> extract_exact_mesh(const Simulation& simulation, const MeshOptions& options,
                                              Diagnostics& diagnostics, Progress* progress = nullptr,
                                              const ExactMeshOptions& exact = {});

/// For an extracted mesh: along the edge between the stock's surface and a steep cut there is a strip of one
/// column's width whose triangles belong alternately to both. Assigns all of them to the cut, as in an exact
/// mesh. Changes only the triangles' steps.
void relabel_mesh(Mesh& mesh, const Workpiece& workpiece);

}  // namespace kerf
