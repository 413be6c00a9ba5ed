// The surface of the columns as a closed mesh: corners row by row, walls, inner caps, then the merged outer
// caps.
#include <algorithm>
#include <utility>
#include <vector>

#include "sim/mesh_build.h"
#include "sim/parallel.h"

namespace kerf {
namespace {

using meshing::Builder;
using meshing::CapSheet;
using meshing::Columns;
using meshing::CornerPlane;
using meshing::CornerRow;
using meshing::FaceLine;
using meshing::WallFiller;

/// Walls of the faces that stand on the corner row j: between the columns of row j - 1 and of row j.
void add_walls_along_row(WallFiller& walls, const Columns& columns, const CornerPlane& plane, CornerRow& row,
                         int j) {
  for (const int i : row.numbers()) {
    if (i == columns.nx() || (row.corner(i).simple && plane.simple(i + 1, j))) continue;
    const FaceLine left{row, row.corner(i + 1), 0, 2}, right{row, row.corner(i), 1, 3};
    walls.fill({i, j - 1}, {i, j}, left, right);
  }
}

/// Walls between the columns (i - 1, j) and (i, j), whose sides run from the corner row below to the one
/// above.
void add_walls_across_row(WallFiller& walls, const CornerPlane& plane, CornerRow& below, CornerRow& above,
                          int j) {
  for (const int i : below.numbers()) {
    if (below.corner(i).simple && plane.simple(i, j + 1)) continue;
    const FaceLine left{below, below.corner(i), 2, 3}, right{above, above.corner(i), 0, 1};
    walls.fill({i - 1, j}, {i, j}, left, right);
  }
}

/// Floors and ceilings of undercuts: all ends of a column but its lowest and its highest.
void add_inner_caps(Builder& builder, CornerRow& below, CornerRow& above, int j) {
  const Columns& columns = builder.columns;
  for (const int i : below.numbers()) {
    if (i == columns.nx() || below.corner(i).simple) continue;
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

/// Rows of corners that are built at a time, by several threads.
constexpr int kRows = 64;

/// Does all the work on several threads that can be done so.
class Extraction {
 public:
  Extraction(Builder& builder, unsigned threads, Progress* progress)
      : builder_(builder),
        threads_(threads),
        progress_(progress),
        top_(builder, CapSheet::Side::top),
        bottom_(builder, CapSheet::Side::bottom) {}

  /// False if stopped.
  bool run() {
    CornerPlane plane(builder_.columns);
    const bool scanned = in_parallel(top_.bands(), [&](int band) {
      meshing::scan_corners(builder_, top_.first_row(band), top_.end_row(band), plane, top_, bottom_);
    });
    if (!scanned) return false;
    report(progress_, 0.3);
    if (!add_walls(plane)) return false;
    report(progress_, 0.6);
    return in_parallel(2, [&](int n) { sheet(n).refine(); }) && emit();
  }

 private:
  CapSheet& sheet(int number) { return number % 2 == 0 ? top_ : bottom_; }

  template <class Work>
  bool in_parallel(int count, const Work& work) {
    bool stopped = false;
    sim::parallel_for(
        threads_, static_cast<std::size_t>(count), [&](std::size_t n) { work(static_cast<int>(n)); },
        [&] { return stopped = stopped || stop_requested(progress_); });
    return !stopped;
  }

  /// Walls and inner caps: rows of corners from low y to high y, two at a time, of which only those corners
  /// are looked at that are not simple. False if stopped.
  bool add_walls(const CornerPlane& plane) {
    const Columns& columns = builder_.columns;
    WallFiller walls(builder_);
    std::vector<CornerRow> rows(kRows + 1);  // the first is the last of those before
    for (int first = 0; first <= columns.ny(); first += kRows) {
      const int count = std::min(kRows, columns.ny() + 1 - first);
      const auto row = [&](int j) -> CornerRow& { return rows[static_cast<std::size_t>(j - first + 1)]; };
      if (!in_parallel(count, [&](int n) { row(first + n).build(columns, plane, first + n); })) return false;
      for (int j = first; j < first + count; ++j) {
        add_walls_along_row(walls, columns, plane, row(j), j);
        if (j == 0) continue;
        add_walls_across_row(walls, plane, row(j - 1), row(j), j - 1);
        add_inner_caps(builder_, row(j - 1), row(j), j - 1);
        take(row(j - 1), j - 1);
      }
      std::swap(rows.front(), row(first + count - 1));
    }
    take(rows.front(), columns.ny());
    return true;
  }

  void take(CornerRow& row, int j) {
    top_.take(row, j);
    bottom_.take(row, j);
  }

  bool emit() {
    const int both = 2 * top_.bands();
    if (!in_parallel(both, [&](int n) { sheet(n).place_vertices(n / 2); })) return false;
    for (const int n : {0, 1}) sheet(n).number_vertices();
    if (!in_parallel(both, [&](int n) { sheet(n).make_triangles(n / 2); })) return false;
    report(progress_, 0.85);
    for (const int n : {0, 1}) sheet(n).make_room();
    return in_parallel(both, [&](int n) { sheet(n).move_to_mesh(n / 2); });
  }

  Builder& builder_;
  unsigned threads_;
  Progress* progress_;
  CapSheet top_, bottom_;
};

}  // namespace

Mesh extract_mesh(const ColumnGrid& grid, Progress* progress) { return extract_mesh(grid, {}, progress); }

Mesh extract_mesh(const ColumnGrid& grid, const MeshOptions& options, Progress* progress) {
  return extract_mesh(MeshColumns(grid, options.threads), options, progress);
}

Mesh extract_mesh(const MeshColumns& made, const MeshOptions& options, Progress* progress) {
  if (progress != nullptr) progress->phase("meshing");
  const Columns& columns = made.body().columns;
  if (!columns.has_material()) return {};
  const unsigned threads = sim::thread_count(options.threads);
  Builder builder{columns, options, {}, {}};
  if (!Extraction(builder, threads, progress).run()) return {};
  meshing::split_shared_edges(builder.mesh, builder.suspects);
  meshing::mend_flat_triangles(builder.mesh, threads);
  report(progress, 1.0);
  return std::move(builder.mesh);
}

}  // namespace kerf
