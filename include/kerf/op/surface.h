// Cutting a surface that is given as triangles: in parallel lines, along paths projected onto it, and around
// it on levels.
//
//   const auto made = raster(mesh, area, ball, {.cut = {.top = 10, .feed = mm_per_min(1200)},
//       .line_distance = mm(0.2)}, diagnostics);
//
// The tool comes down onto the mesh at each point: it touches facets, edges and vertices, and cuts into none
// of them. It may be any whose end is convex: ball, bull nose, square, V, tapered ball. What is below an
// overhang is not reached. Frame, levels and errors as in operation.h; CutOptions::depth is the lowest Z
// that the tip may have below `top`, 0: down to the lowest point of the mesh.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/geom/outline.h"
#include "kerf/op/operation.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// Triangles, mm in work coordinates. Closed or not; vertices may be repeated.
struct SurfaceMesh {
  std::vector<Point3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
Box3 bounds(const SurfaceMesh& mesh);

struct MeshCutOptions {
  CutOptions cut{};        ///< allowance: left on the surface
  double stepover = 0.1;   ///< distance of the lines as a fraction of the tool's diameter
  Length line_distance{};  ///< distance of the lines; 0: by `stepover`
  Angle angle{};           ///< of the lines, from +x
  /// How far above the mesh the path may be. It is not below, but for a fifth of this between two points, and
  /// for this much with a pointed tool.
  Length tolerance = mm(0.01);
  /// Rest machining: only what this tool has left, after the same operation with the same options and without
  /// allowance. op_empty if it has left nothing.
  std::optional<Tool> earlier{};
  /// What is thinner is not cut, and what is thinner than 4 % of the earlier tool's radius, or than a 1300th
  /// of the size of the area.
  Length rest_thickness = mm(0.1);
  unsigned threads = 0;  ///< 0: as many as the machine has. The result is the same for any number
};

/// Parallel lines in alternating directions. The tool's axis stays inside `area`. With a stepdown the mesh is
/// cut in passes, each at most that deep.
std::optional<Operation> raster(const SurfaceMesh& mesh, const Region& area, const Tool& tool,
                                const MeshCutOptions& options, Diagnostics& diagnostics);

/// Around the mesh on levels that are the stepdown apart: the tool touches the mesh and goes no deeper. For
/// steep walls, after roughing; `cut.direction` as along any wall. `line_distance` and `angle` have no
/// effect.
std::optional<Operation> waterline(const SurfaceMesh& mesh, const Tool& tool, const MeshCutOptions& options,
                                   Diagnostics& diagnostics);

/// Engraving: along outlines, `cut.depth` below where the tool touches the mesh. `line_distance` and `angle`
/// have no effect. An outline that leaves the mesh is an error.
std::optional<Operation> project(const SurfaceMesh& mesh, const std::vector<Outline>& outlines,
                                 const Tool& tool, const MeshCutOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
