// Sharp edges, exact walls and surfaces for the mesh of a cut part: the columns say where surfaces are to
// about half a pitch, the toolpath says where they are exactly.
#pragma once

#include <optional>

#include "kerf/diagnostics.h"
#include "kerf/mesh.h"
#include "kerf/progress.h"
#include "kerf/stock.h"
#include "kerf/tolerance.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"
#include "kerf/workpiece.h"

namespace kerf {

struct SharpenOptions {
  /// Where the middle of an edge is further than this from the surface the edge gets another vertex.
  Length tolerance = default_tolerance::kExactMesh;
  unsigned threads = 0;  // 0: as many as the machine has. The mesh is the same for any number.
};

/// Moves the vertices of `mesh`, which extract_mesh has made of `workpiece`, onto what the tools of `path`
/// really left: walls to their true place, edges to where their two surfaces meet, corners to where three do,
/// curved surfaces to their height. No vertex leaves the square of its corner of the columns, what lies on
/// the stock's block stays on it, and the mesh stays closed. `path`, `tools` and `stock` are those of the
/// simulation. Surfaces of a stock that is no block, and features smaller than a pitch, stay as the columns
/// have them. False if stopped; the mesh then is as it was. See docs/decisions/0006-mesh.md.
bool sharpen_mesh(Mesh& mesh, const Workpiece& workpiece, const Toolpath& path, const ToolTable& tools,
                  const Stock& stock, const SharpenOptions& options = {}, Progress* progress = nullptr);

/// extract_mesh and then sharpen_mesh. Where the result is not sound, as with cuts along the side of a block
/// of a few coarse columns, the mesh is as the columns have it, relabelled, with a warning. `columns` are
/// those of the workpiece. Nothing if stopped.
std::optional<Mesh> extract_exact_mesh(const MeshColumns& columns, const MeshOptions& options,
                                       const Workpiece& workpiece, const Toolpath& path,
                                       const ToolTable& tools, const Stock& stock, Diagnostics& diagnostics,
                                       Progress* progress = nullptr);

/// For a mesh that is not sharpened: between the stock's surface and a steep cut there is a strip as wide as
/// a column, whose triangles are the one's and the other's in turns. All of them become the cut's, as in a
/// sharpened mesh. Changes no more than whose triangles are.
void relabel_mesh(Mesh& mesh, const Workpiece& workpiece);

}  // namespace kerf
