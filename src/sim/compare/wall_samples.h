// Part and target at points in the columns that walls pass through, where the centres of columns locate a
// wall to half a pitch only. Both are meshes, and both are intersected by the same vertical lines.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "stock/body.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/sim/mesh.h"
#include "kerf/sim/simulate.h"
#include "kerf/sim/workpiece.h"

namespace kerf::sim {

/// The points of a column are points[first[k]] to points[first[k + 1] - 1], where k is its number among
/// `columns`. Each represents an equal part of the column's area.
struct WallSamples {
  std::vector<std::uint32_t> columns;  // j * nx + i, ascending
  std::vector<std::uint32_t> first;
  std::vector<Point2> points;  // mm, work coordinates
  ColumnRuns part, target;     // one column per point, mm above the block's floor
};

/// The columns of the workpiece beside walls of part or target, and those along the sides of the block, in
/// ascending order. `target`: the target as a workpiece with the same columns.
std::vector<std::uint32_t> columns_at_walls(const Workpiece::Body& part, const Workpiece::Body& target,
                                            unsigned threads);

/// The mesh, which must be closed, as a solid for vertical lines.
solid::MeshSolid solid_of(const Mesh& mesh);

/// mesh_runs of a mesh whose warnings are reported already: appends errors only.
std::optional<ColumnRuns> runs_again(const solid::MeshSolid& mesh, std::span<const Point2> points,
                                     double floor, Diagnostics& diagnostics, Progress* progress);

/// Nothing with an error if a line passes through a hole of a mesh, without one if stopped.
std::optional<WallSamples> sample_walls(std::vector<std::uint32_t> columns, const Workpiece::Body& body,
                                        const solid::MeshSolid& part, const solid::MeshSolid& target,
                                        Diagnostics& diagnostics, Progress* progress);

}  // namespace kerf::sim
