// Extraction of the surface of columns as a closed mesh: corners row by row, walls, inner caps, then the
// outer caps with merged triangles.
#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "base/huge_pages.h"
#include "base/parallel.h"
#include "sim/mesh/mesh_build.h"

namespace kerf {
namespace {

using meshing::BlockSides;
using meshing::Builder;
using meshing::CapSheet;
using meshing::Columns;
using meshing::CornerPlane;
using meshing::CornerRow;
using meshing::FaceLine;
using meshing::WallFiller;

/// What is known of the corners before the walls are made.
struct Corners {
  const CornerPlane& plane;
  const BlockSides& sides;
};

/// Walls along corner row j: between the columns of row j - 1 and of row j.
void add_walls_along_row(WallFiller& walls, const Columns& columns, const Corners& corners, CornerRow& row,
                         int j) {
  for (const int i : row.numbers()) {
    if (i == columns.nx() || (row.corner(i).simple && corners.plane.simple(i + 1, j)) ||
        corners.sides.is_plain_along_x(i, j))
      continue;
    const FaceLine left{row, row.corner(i + 1), 0, 2}, right{row, row.corner(i), 1, 3};
    walls.fill({i, j - 1}, {i, j}, left, right);
  }
}

/// Walls between the columns (i - 1, j) and (i, j), from corner row `below` to corner row `above`.
void add_walls_across_row(WallFiller& walls, const Corners& corners, CornerRow& below, CornerRow& above,
                          int j) {
  for (const int i : below.numbers()) {
    if ((below.corner(i).simple && corners.plane.simple(i, j + 1)) || corners.sides.is_plain_along_y(i, j))
      continue;
    const FaceLine left{below, below.corner(i), 2, 3}, right{above, above.corner(i), 0, 1};
    walls.fill({i - 1, j}, {i, j}, left, right);
  }
}

/// Floors and ceilings of undercuts: all ends of a column except the lowest and the highest.
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

/// Walls and inner caps between a row of corners and the previous one.
void add_walls(WallFiller& walls, Builder& builder, const Corners& corners, CornerRow& below, CornerRow& row,
               int j) {
  add_walls_along_row(walls, builder.columns, corners, row, j);
  if (j == 0) return;
  add_walls_across_row(walls, corners, below, row, j - 1);
  add_inner_caps(builder, below, row, j - 1);
}

/// The walls of the corner rows of a band, with their own numbering of vertices. Each band has a copy of the
/// row before it, to which its first walls extend.
struct WallBand {
  WallBand(const Columns& columns, const MeshOptions& options)
      : builder{columns, options, {}, {}}, before(columns), last(columns) {}
  Builder builder;
  CornerRow before, last;
};

/// Runs the phases of the extraction, each on several threads.
class Extraction {
 public:
  Extraction(const Columns& columns, const MeshOptions& options, unsigned threads, Progress* progress)
      : columns_(columns),
        options_(options),
        threads_(threads),
        progress_(progress),
        plane_(columns),
        sides_(columns, options),
        top_(columns, options, plane_, sides_, CapSheet::Side::top),
        bottom_(columns, options, plane_, sides_, CapSheet::Side::bottom),
        walls_(static_cast<std::size_t>(top_.bands()), WallBand(columns, options)) {}

  /// False if stopped.
  bool run() {
    if (!in_bands([&](int band) { scan_corners(columns_, options_, band, plane_, top_, bottom_); }))
      return false;
    report(progress_, 0.2);
    if (!in_bands([&](int band) { make_walls(band); })) return false;
    join_walls();
    report(progress_, 0.5);
    return cover() && finish();
  }
  Mesh mesh;

 private:
  WallBand& walls(int band) { return walls_[static_cast<std::size_t>(band)]; }
  CapSheet& sheet(int number) { return number % 2 == 0 ? top_ : bottom_; }
  int end_row(int band) const { return std::min((band + 1) * meshing::kSquare, columns_.ny() + 1); }

  template <class Work>
  bool in_parallel(int count, const Work& work) {
    bool stopped = false;
    parallel_for(
        threads_, static_cast<std::size_t>(count), [&](std::size_t n) { work(static_cast<int>(n)); },
        [&] { return stopped = stopped || stop_requested(progress_); });
    return !stopped;
  }
  template <class Work>
  bool in_bands(const Work& work) {
    return in_parallel(top_.bands(), work);
  }
  template <class Work>
  bool in_bands_of_both(const Work& work) {
    return in_parallel(2 * top_.bands(), [&](int n) { work(sheet(n), n / 2); });
  }

  void take(WallBand& band, CornerRow& row, int j) {
    top_.take(band.builder, row, j);
    bottom_.take(band.builder, row, j);
  }

  /// Adds the walls of a band, from low y to high y. Afterwards all rows are finished except the last, to
  /// which walls of the next band extend.
  void make_walls(int number) {
    WallBand& band = walls(number);
    WallFiller filler(band.builder);
    CornerRow other(columns_);
    CornerRow *below = &band.before, *row = &band.last;
    const int first = number * meshing::kSquare;
    if (first > 0 && first <= columns_.ny()) below->build(plane_, first - 1);
    for (int j = first; j < end_row(number); ++j) {
      row->build(plane_, j);
      add_walls(filler, band.builder, {plane_, sides_}, *below, *row, j);
      if (j > first) take(band, *below, j - 1);
      if (j == first) below = &other;
      std::swap(below, row);
    }
    if (below == &other) std::swap(band.last, other);
  }

  /// Numbers the bands' vertices in the mesh, those between two bands once, and finishes the last rows.
  void join_walls() {
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> same(walls_.size());
    for (int b = 0; b < top_.bands(); ++b) {
      const int end = end_row(b);
      if (end <= b * meshing::kSquare) break;
      if (b + 1 < top_.bands() && end <= columns_.ny())
        same[static_cast<std::size_t>(b) + 1] = join(walls(b), walls(b + 1));
      take(walls(b), walls(b).last, end - 1);
    }
    number_walls(same);
  }

  /// Pairs of a vertex of the higher band and the same vertex of the lower one.
  static std::vector<std::pair<std::uint32_t, std::uint32_t>> join(WallBand& low, WallBand& high) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> same;
    std::vector<meshing::Sheet>&mine = low.last.sheets(), &copies = high.before.sheets();
    for (std::size_t s = 0; s < copies.size(); ++s)
      if (copies[s].vertex != meshing::kNone)
        same.emplace_back(copies[s].vertex, low.builder.vertex(mine[s]));
    return same;
  }

  void number_walls(const std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>>& same) {
    std::vector<float>& positions = mesh.positions;
    std::size_t numbers = 0;
    for (const WallBand& band : walls_) numbers += band.builder.mesh.positions.size();
    positions.reserve(numbers);
    for (std::size_t b = 0; b < walls_.size(); ++b) {
      const Mesh& band = walls_[b].builder.mesh;
      std::vector<std::uint32_t> number(band.positions.size() / 3, meshing::kNone);
      for (const auto& [mine, other] : same[b]) number[mine] = wall_vertices_[b - 1][other];
      for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] != meshing::kNone) continue;
        number[v] = static_cast<std::uint32_t>(positions.size() / 3);
        for (std::size_t axis = 0; axis < 3; ++axis) positions.push_back(band.positions[3 * v + axis]);
      }
      for (const std::uint32_t v : walls_[b].builder.suspects) suspects_.push_back(number[v]);
      wall_vertices_.push_back(std::move(number));
    }
  }

  /// Selects the vertices of both caps.
  bool cover() {
    if (!in_bands_of_both([](CapSheet& sheet, int band) { sheet.find_errors(band); })) return false;
    if (!in_bands_of_both([](CapSheet& sheet, int band) { sheet.propagate(band); })) return false;
    if (!in_parallel(2, [&](int n) { sheet(n).propagate_across(); })) return false;
    if (!in_bands_of_both([](CapSheet& sheet, int band) { sheet.add_vertices(band); })) return false;
    report(progress_, 0.7);
    return true;
  }

  /// Assembles the mesh, makes it a 2-manifold and removes degenerate triangles.
  bool finish() {
    CapSheet::MeshCounts counts{mesh.positions.size() / 3, 0};
    std::vector<std::size_t> first_of_walls;
    for (const WallBand& band : walls_) {
      first_of_walls.push_back(counts.triangles);
      counts.triangles += band.builder.mesh.step.size();
    }
    const std::size_t wall_triangles = counts.triangles;
    for (const int n : {0, 1}) sheet(n).assign_ranges(counts);
    prepare(mesh.positions, 3 * counts.vertices);
    prepare(mesh.triangles, 3 * counts.triangles);
    prepare(mesh.step, counts.triangles);
    const auto enlarge = [&](int n) {
      if (n == 0) return mesh.triangles.resize(3 * counts.triangles);
      mesh.positions.resize(3 * counts.vertices);
      mesh.step.resize(counts.triangles);
    };
    const bool filled =
        in_parallel(2, enlarge) &&
        in_bands([&](int band) { fill_walls(band, first_of_walls[static_cast<std::size_t>(band)]); }) &&
        in_bands_of_both([&](CapSheet& sheet, int band) { sheet.fill(band, wall_vertices_, mesh); });
    if (!filled) return false;
    report(progress_, 0.85);
    std::vector<std::size_t> at_walls(wall_triangles);
    std::iota(at_walls.begin(), at_walls.end(), std::size_t{0});
    std::size_t end = wall_triangles;
    for (const int n : {0, 1}) sheet(n).close_gaps(mesh, end, at_walls);
    mesh.triangles.resize(3 * end);
    mesh.step.resize(end);
    sides_.add_strips(top_, bottom_, wall_vertices_, mesh);
    for (; end < mesh.step.size(); ++end) at_walls.push_back(end);
    meshing::split_non_manifold(mesh, threads_, suspects_, at_walls);
    meshing::remove_degenerate_triangles(mesh, threads_, at_walls);  // others have at least half a square
    return true;
  }

  void fill_walls(int number, std::size_t first) {
    const Mesh& band = walls(number).builder.mesh;
    const std::vector<std::uint32_t>& vertices = wall_vertices_[static_cast<std::size_t>(number)];
    std::transform(band.triangles.begin(), band.triangles.end(), mesh.triangles.data() + 3 * first,
                   [&](std::uint32_t v) { return vertices[v]; });
    std::copy(band.step.begin(), band.step.end(), mesh.step.data() + first);
  }

  template <class Number>
  void prepare(std::vector<Number>& numbers, std::size_t count) const {
    numbers.reserve(count);
    prepare_pages(numbers.data(), count * sizeof(Number), threads_);
  }

  const Columns& columns_;
  const MeshOptions& options_;
  unsigned threads_;
  Progress* progress_;
  CornerPlane plane_;
  BlockSides sides_;
  CapSheet top_, bottom_;
  std::vector<WallBand> walls_;
  std::vector<std::vector<std::uint32_t>> wall_vertices_;  // of each band, in the mesh
  std::vector<std::uint32_t> suspects_;
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
  Extraction extraction(columns, options, thread_count(options.threads), progress);
  if (!extraction.run()) return {};
  report(progress, 1.0);
  return std::move(extraction.mesh);
}

}  // namespace kerf
