// The surface of the columns as a closed mesh: corners row by row, walls, inner caps, then the merged outer
// caps.
#include <utility>

#include "sim/mesh_build.h"

namespace kerf {
namespace {

using meshing::Builder;
using meshing::CapSheet;
using meshing::Columns;
using meshing::CornerRow;
using meshing::FaceLine;
using meshing::WallFiller;

/// Walls of the faces that stand on the corner row j: between the columns of row j - 1 and of row j.
void add_walls_along_row(WallFiller& walls, const Columns& columns, CornerRow& row, int j) {
  for (int i = 0; i < columns.nx(); ++i) {
    if (row.corner(i).simple && row.corner(i + 1).simple) continue;
    const FaceLine left{row, row.corner(i + 1), 0, 2}, right{row, row.corner(i), 1, 3};
    walls.fill({i, j - 1}, {i, j}, left, right);
  }
}

/// Walls between the columns (i - 1, j) and (i, j), whose sides run from the corner row below to the one
/// above.
void add_walls_across_row(WallFiller& walls, const Columns& columns, CornerRow& below, CornerRow& above,
                          int j) {
  for (int i = 0; i <= columns.nx(); ++i) {
    if (below.corner(i).simple && above.corner(i).simple) continue;
    const FaceLine left{below, below.corner(i), 2, 3}, right{above, above.corner(i), 0, 1};
    walls.fill({i - 1, j}, {i, j}, left, right);
  }
}

/// Floors and ceilings of undercuts: all ends of a column but its lowest and its highest.
void add_inner_caps(Builder& builder, CornerRow& below, CornerRow& above, int j) {
  const Columns& columns = builder.columns;
  for (int i = 0; i < columns.nx(); ++i) {
    if (below.corner(i).simple) continue;
    for (int e = 1; e + 1 < columns.ends(i, j); ++e) {
      const auto at = [&](CornerRow& row, int corner, int quadrant) {
        const meshing::Corner& c = row.corner(corner);
        return builder.vertex(row.sheet(c, row.rank(c, quadrant, e)));
      };
      const std::uint32_t sw = at(below, i, 3), se = at(below, i + 1, 2), ne = at(above, i + 1, 0),
                          nw = at(above, i, 1), step = columns.step(i, j, e);
      const bool up = e % 2 == 1;
      builder.add(sw, up ? se : ne, up ? ne : se, step);
      builder.add(sw, up ? ne : nw, up ? nw : ne, step);
    }
  }
}

/// Rows of corners from low y to high y, two at a time. False if stopped.
bool sweep_rows(Builder& builder, CapSheet& top, CapSheet& bottom, Progress* progress) {
  const Columns& columns = builder.columns;
  WallFiller walls(builder);
  CornerRow below, above;
  for (int j = 0; j <= columns.ny(); ++j) {
    if (j % 64 == 0) {
      report(progress, 0.7 * j / (columns.ny() + 1));
      if (stop_requested(progress)) return false;
    }
    above.build(columns, j);
    add_walls_along_row(walls, columns, above, j);
    if (j > 0) {
      add_walls_across_row(walls, columns, below, above, j - 1);
      add_inner_caps(builder, below, above, j - 1);
      top.take(below, j - 1);
      bottom.take(below, j - 1);
    }
    std::swap(below, above);
  }
  top.take(below, columns.ny());
  bottom.take(below, columns.ny());
  return true;
}

}  // namespace

Mesh extract_mesh(const ColumnGrid& grid, Progress* progress) { return extract_mesh(grid, {}, progress); }

Mesh extract_mesh(const ColumnGrid& grid, const MeshOptions& options, Progress* progress) {
  if (progress != nullptr) progress->phase("meshing");
  if (grid.nx <= 0 || grid.ny <= 0 || grid.intervals.empty()) return {};
  const Columns columns(grid);
  Builder builder{columns, options, {}, {}};
  CapSheet top(builder, CapSheet::Side::top), bottom(builder, CapSheet::Side::bottom);
  if (!sweep_rows(builder, top, bottom, progress)) return {};
  if (!top.emit(progress)) return {};
  report(progress, 0.85);
  if (!bottom.emit(progress)) return {};
  meshing::split_shared_edges(builder.mesh, builder.suspects);
  meshing::mend_flat_triangles(builder.mesh);
  report(progress, 1.0);
  return std::move(builder.mesh);
}

}  // namespace kerf
