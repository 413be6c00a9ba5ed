// Finds the columns at walls, and intersects both meshes with lines in them.
#include "sim/compare/wall_samples.h"

#include <algorithm>

#include "sim/cut/walls.h"
#include "sim/dexel/wall_lattice.h"

namespace kerf::sim {
namespace {

void mark_walls(const Workpiece::Body& body, unsigned threads, std::vector<bool>& marked) {
  for (const WallSquares& walls : find_walls(body, threads)) {
    const auto tiles_x = static_cast<std::uint32_t>(body.tiles_x);
    const std::uint32_t column = walls.tile % tiles_x * kTileColumns,
                        row = walls.tile / tiles_x * kTileColumns;
    for (const WallSquares::Quarters& quarters : walls.quarters) {
      const ColumnInTile at = column_in_tile(quarters.column);
      marked[static_cast<std::size_t>(row + static_cast<std::uint32_t>(at.y)) *
                 static_cast<std::size_t>(body.nx) +
             column + static_cast<std::uint32_t>(at.x)] = true;
    }
  }
}

/// A wall less than half a pitch inside of the block has no column beyond it that shows the step.
void mark_sides(const Workpiece::Body& body, std::vector<bool>& marked) {
  const auto nx = static_cast<std::size_t>(body.nx), ny = static_cast<std::size_t>(body.ny);
  for (std::size_t i = 0; i < nx; ++i) marked[i] = marked[(ny - 1) * nx + i] = true;
  for (std::size_t j = 0; j < ny; ++j) marked[j * nx] = marked[j * nx + nx - 1] = true;
}

/// The number of parts of a column's side, each with a lattice of its own: a short wall has few columns,
/// whose errors do not cancel.
int parts_of(std::size_t points) {
  constexpr std::size_t kPoints = 1 << 20;
  for (const std::size_t parts : {4u, 2u})
    if (points * parts * parts <= kPoints) return static_cast<int>(parts);
  return 1;
}

}  // namespace

std::vector<std::uint32_t> columns_at_walls(const Workpiece::Body& part, const Workpiece::Body& target,
                                            unsigned threads) {
  std::vector<bool> marked(static_cast<std::size_t>(part.nx) * static_cast<std::size_t>(part.ny), false);
  mark_walls(part, threads, marked);
  mark_walls(target, threads, marked);
  mark_sides(part, marked);
  std::vector<std::uint32_t> columns;
  for (std::size_t n = 0; n < marked.size(); ++n)
    if (marked[n]) columns.push_back(static_cast<std::uint32_t>(n));
  return columns;
}

solid::MeshSolid solid_of(const Mesh& mesh) {
  solid::MeshSolid out;
  out.name = "the part";
  out.points.reserve(mesh.positions.size() / 3);
  for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3) {
    const auto at = [&](std::size_t axis) {
      return solid::to_lattice(static_cast<double>(mesh.positions[k + axis]));
    };
    out.points.push_back({at(0), at(1), at(2)});
  }
  out.triangles.reserve(mesh.triangles.size() / 3);
  for (std::size_t k = 0; k + 2 < mesh.triangles.size(); k += 3)
    out.triangles.push_back({mesh.triangles[k], mesh.triangles[k + 1], mesh.triangles[k + 2]});
  return out;
}

std::optional<ColumnRuns> runs_again(const solid::MeshSolid& mesh, std::span<const Point2> points,
                                     double floor, Diagnostics& diagnostics, Progress* progress) {
  Diagnostics found;
  auto runs = solid::mesh_runs(mesh, points, floor, found, progress);
  if (!runs)
    for (const Diagnostic& fault : found.list()) diagnostics.add(fault);
  return runs;
}

std::optional<WallSamples> sample_walls(std::vector<std::uint32_t> columns, const Workpiece::Body& body,
                                        const solid::MeshSolid& part, const solid::MeshSolid& target,
                                        Diagnostics& diagnostics, Progress* progress) {
  WallSamples out;
  out.columns = std::move(columns);
  const WallLattice& lattice = lattice_of(out.columns.size() / 2);  // a wall has columns on both sides
  const int parts = parts_of(out.columns.size() * static_cast<std::size_t>(lattice.count));
  const Point3 low = body.bounds.low;
  const auto nx = static_cast<std::uint32_t>(body.nx);
  for (const std::uint32_t n : out.columns) {
    const int i = static_cast<int>(n % nx), j = static_cast<int>(n / nx);
    out.first.push_back(static_cast<std::uint32_t>(out.points.size()));
    const double x0 = low.x + i * body.pitch, wide = body.fraction_x(i) * body.pitch / parts;
    const double y0 = low.y + j * body.pitch, deep = body.fraction_y(j) * body.pitch / parts;
    for (int k = 0; k < parts * parts; ++k) {
      const int x = k % parts, y = k / parts;
      visit_points(lattice, parts * i + x, parts * j + y, [&](double in_x, double in_y) {
        out.points.push_back({x0 + (x + in_x) * wide, y0 + (y + in_y) * deep});
      });
    }
  }
  out.first.push_back(static_cast<std::uint32_t>(out.points.size()));
  auto of_part = runs_again(part, out.points, low.z, diagnostics, progress);
  if (!of_part) return std::nullopt;
  auto of_target = runs_again(target, out.points, low.z, diagnostics, progress);
  if (!of_target) return std::nullopt;
  out.part = std::move(*of_part);
  out.target = std::move(*of_target);
  return out;
}

}  // namespace kerf::sim
