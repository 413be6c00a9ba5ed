// Building the mesh of columns: the mesh under construction, walls, caps with merged triangles, and the final
// clean-up of non-manifold edges and degenerate triangles. Algorithm: docs/decisions/0006-mesh.md.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "sim/dexel/blocks.h"
#include "sim/mesh/mesh_corners.h"

#include "kerf/geom/geometry.h"

namespace kerf::meshing {

class CapSheet;

/// A key of an edge, independent of its direction.
inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

/// A triangle with less height over its longest side has no area, mm: below the single precision of
/// positions.
inline constexpr double kNoHeight = 1e-6;
inline bool has_no_area(Point3 a, Point3 b, Point3 c) {
  const Point3 twice = cross(b - a, c - a);
  const double longest2 = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return dot(twice, twice) <= kNoHeight * kNoHeight * longest2;
}

/// The mesh of a band of rows under construction. Vertices that may have an edge with four triangles are
/// recorded for `split_non_manifold`.
struct Builder {
  const Columns& columns;
  const MeshOptions& options;
  Mesh mesh;
  std::vector<std::uint32_t> suspects;

  std::uint32_t add_vertex(double x, double y, double z);
  /// The vertex of a sheet, created when first used.
  std::uint32_t vertex(Sheet& sheet);
  /// Adds a triangle unless two of its vertices are one.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t step);
};

/// One vertical side of the face between two columns: a corner, and the columns' quadrants around it.
struct FaceLine {
  CornerRow& row;
  const Corner& corner;
  int quadrant_a, quadrant_b;
};

/// Fills the face between columns A and B where only one of them has material. `left` and `right` as seen
/// from B.
class WallFiller {
 public:
  explicit WallFiller(Builder& builder) : builder_(builder) {}
  struct ColumnAt {
    int i, j;
  };
  void fill(ColumnAt a, ColumnAt b, FaceLine left, FaceLine right);

 private:
  struct Edge {
    int left, right;  // ranks on the two lines
    int change;       // of (material in A) - (material in B) at this end, upwards
    int end;
    bool of_a;
  };
  bool all_joined(const FaceLine& left, const FaceLine& right) const;
  bool gather(const FaceLine& left, const FaceLine& right);
  std::uint32_t step_of(ColumnAt column, bool is_a, std::size_t above) const;
  void ladder(const Edge& low, const Edge& high, int times, std::uint32_t step, FaceLine left, FaceLine right,
              bool suspect);

  Builder& builder_;
  std::vector<Edge> edges_;
};

/// The sides of the block where the stock is plain: walls there are strips between the vertices that the
/// upper and the lower cap have, instead of one face per column.
class BlockSides {
 public:
  BlockSides(const Columns& columns, const MeshOptions& options);
  /// Whether the face of a column on the block's side, from a corner to the next one along X or Y, is plain:
  /// part of a strip.
  bool is_plain_along_x(int i, int j) const {
    return is_on_y_side(j) && is_plain(along_x(j), i) && is_plain(along_x(j), i + 1);
  }
  bool is_plain_along_y(int i, int j) const {
    return is_on_x_side(i) && is_plain(along_y(i), j) && is_plain(along_y(i), j + 1);
  }
  /// Whether all faces at a corner of the block's sides are plain: it needs no vertex, and has the height of
  /// its columns.
  bool is_optional(int i, int j) const;
  /// The strips of a mesh whose caps have all their vertices.
  void add_strips(const CapSheet& top, const CapSheet& bottom,
                  std::span<const std::vector<std::uint32_t>> wall_vertices, Mesh& mesh) const;

 private:
  /// Whether corners are plain, with one byte per corner.
  using Side = std::vector<std::uint8_t>;
  class Strip;

  bool is_on_x_side(int i) const { return i == 0 || i == columns_.nx(); }
  bool is_on_y_side(int j) const { return j == 0 || j == columns_.ny(); }
  const Side& along_x(int j) const { return j == 0 ? low_y_ : high_y_; }
  const Side& along_y(int i) const { return i == 0 ? low_x_ : high_x_; }
  static bool is_plain(const Side& side, int k) { return side[static_cast<std::size_t>(k)] != 0; }
  static bool is_plain_around(const Side& side, int k);
  bool are_alike(int i, int j, int other_i, int other_j) const;

  const Columns& columns_;
  const MeshOptions& options_;
  Side low_y_, high_y_, low_x_, high_x_;
};

/// The needed corners of a square, without those on its two high sides. Only squares with needed corners have
/// one. Entries are stored for needed corners only, as clearing one per corner would take longer than filling
/// them.
struct CapBlock {
  /// Added to corners that are vertices of triangles that end at the block's side, and halve none.
  static constexpr std::uint8_t kOnSide = 0x80;
  CapBlock() { needed.fill(0); }
  /// Index of a needed corner in the band's entries.
  std::size_t index(std::size_t cell) const {
    return before[cell / kSquare] + std::size_t{needed[cell] & (kOnSide - 1u)} - 1;
  }
  bool halves(std::size_t cell) const { return needed[cell] != 0 && needed[cell] < kOnSide; }
  /// Not 0 for corners that must be vertices. Once all are known, their numbers in their rows, from 1.
  std::array<std::uint8_t, kSquareColumns> needed;
  std::array<std::uint32_t, kSquare> before;  // needed corners of the band before each row
};

/// The caps of all columns on one side, the tops of their highest intervals or the bottoms of their lowest,
/// with level areas of one step merged: a right-triangulated irregular network over the corners, without
/// T-junctions. Its largest triangles are halves of the squares of Columns; a row of squares is a band, and
/// threads work on different bands.
///
/// Triangles of the last squares may extend beyond the columns. Their corners there are moved to the block's
/// side along X and Y, which turns no triangle over, and makes those that are entirely beyond it lines.
///
/// The entry of a corner is a vertex of its band's walls, or kNew + a vertex of the band, or kMany + the
/// index of a corner with one vertex per quadrant, or kNone.
class CapSheet {
 public:
  enum class Side : std::uint8_t { top, bottom };
  CapSheet(const Columns& columns, const MeshOptions& options, const CornerPlane& plane,
           const BlockSides& sides, Side side);
  /// One more than there are rows of squares: the highest corners are in a band of their own.
  int bands() const { return blocks_y_; }
  bool simplifies() const { return options_.tolerance > Length(); }

  /// Records that a corner is needed; the corners of squares always are.
  void need(int i, int j);
  /// Takes the corners of a row that are not simple, and the vertices that walls have at simple ones. To be
  /// called when all walls at the row are done. `walls` creates vertices of the row's band.
  void take(Builder& walls, CornerRow& row, int j);
  /// Finds the corners of a band without which the error of the cap would exceed the tolerance.
  void find_errors(int band);
  /// Adds the corners that needed corners require, within the band; `propagate_across` adds those in other
  /// bands, and the vertices of triangles that extend beyond the columns.
  void propagate(int band);
  void propagate_across();
  /// Creates the missing vertices of a band and counts its triangles.
  void add_vertices(int band);
  /// Assigns ranges of the mesh to the bands: vertices from `counts.vertices` on, triangles from
  /// `counts.triangles` on, the maximum number of each. Adds their numbers to `counts`.
  struct MeshCounts {
    std::size_t vertices = 0, triangles = 0;
  };
  void assign_ranges(MeshCounts& counts);
  /// Writes the vertices and triangles of a band. `wall_vertices`: of each band, the numbers in the mesh of
  /// its walls' vertices.
  void fill(int band, std::span<const std::vector<std::uint32_t>> wall_vertices, Mesh& mesh);
  /// The mesh's vertex at a corner of the block's sides, of the column in a quadrant around it; kNone if the
  /// cap has none there.
  std::uint32_t vertex_on_side(int i, int j, int quadrant,
                               std::span<const std::vector<std::uint32_t>> wall_vertices) const;
  /// Moves the triangles down to `end`, closing the gaps between the bands, and appends those with a vertex
  /// of a wall to `at_walls`.
  void close_gaps(Mesh& mesh, std::size_t& end, std::vector<std::size_t>& at_walls) const;

 private:
  struct GridCorner {
    int x, y;
  };
  /// The height of a corner that is not simple.
  struct CornerHeight {
    std::uint16_t cell;
    float z;
  };
  struct Band {
    std::vector<float> positions;
    std::vector<std::array<std::uint32_t, 4>> by_quadrant;    // vertices of kMany corners
    std::vector<std::pair<GridCorner, std::uint32_t>> taken;  // corners with known entries
    std::vector<std::uint32_t> entries;  // of the needed corners, without those of squares
    std::vector<GridCorner> beyond;      // needed corners of other bands
    std::vector<int> above;              // x of the needed corners on the band's high side
    std::size_t first_vertex = 0, first_triangle = 0, triangles = 0;
    std::size_t max_triangles = 0, below = 0;  // of its own squares; additional ones of the band below
    std::vector<std::size_t> at_walls;         // triangles
  };
  class Patch;
  class Triangles;
  class Cover;

  std::size_t block_number(int i, int j) const {
    return static_cast<std::size_t>(j / kSquare) * static_cast<std::size_t>(blocks_x_) +
           static_cast<std::size_t>(i / kSquare);
  }
  CapBlock& block(int i, int j);
  static bool is_whole(int i, int j) { return i % kSquare == 0 && j % kSquare == 0; }
  void take_entry(int i, int j, std::uint32_t entry);
  std::uint32_t& entry(int i, int j);
  void number_corners(Band& band, int number);
  const Ends& ends_of(const ColumnSquare& square) const {
    return side_ == Side::bottom ? *square.low : *square.high;
  }
  int end_of(int i, int j) const { return side_ == Side::bottom ? 0 : columns_.ends(i, j) - 1; }
  void store_height(int i, int j, double z);
  void take_corner(Builder& walls, CornerRow& row, const Corner& corner, int i, int j);
  void take_whole(Builder& walls, Sheet& sheet, int i, int j);
  bool level(int i, int j) const;
  bool of_one_group(int i, int j) const;
  bool is_plain(int square_x, int square_y) const;
  static std::array<GridCorner, 2> parents(GridCorner n);
  template <class Beyond>
  void need_parents(GridCorner n, int band, std::vector<GridCorner>& work, const Beyond& beyond);
  template <class Work>
  void for_needed(int band, const Work& work) const;
  void need_on_side(int square_x, int square_y);
  bool is_new_vertex(int i, int j) const;
  void add_vertex(Band& band, int i, int j);

  const Columns& columns_;
  const MeshOptions& options_;
  const CornerPlane& plane_;
  const BlockSides& sides_;
  Side side_;
  int blocks_x_, blocks_y_;
  sim::BlockStore<CapBlock> store_;
  std::vector<sim::BlockStore<CapBlock>::Pointer> blocks_;
  std::vector<std::uint32_t> whole_;                // entries of the corners of whole squares
  std::vector<std::vector<CornerHeight>> heights_;  // by block
  std::vector<Band> bands_;
};

/// Calls work(i, j) for the needed corners of a band, without the corners of squares.
template <class Work>
void CapSheet::for_needed(int band, const Work& work) const {
  for (int x = 0; x < blocks_x_; ++x) {
    const CapBlock* const known = blocks_[block_number(x * kSquare, band * kSquare)].get();
    if (known == nullptr) continue;
    for (std::size_t k = 0; k < kSquareColumns; k += sizeof(std::uint64_t)) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, known->needed.data() + k, sizeof eight);
      for (std::size_t c = k; eight != 0 && c < k + sizeof eight; ++c) {
        if (known->needed[c] != 0)
          work(x * kSquare + static_cast<int>(c) % kSquare, band * kSquare + static_cast<int>(c) / kSquare);
      }
    }
  }
}

/// Key by which steps are compared: the group of a step, see MeshOptions::step_groups, or the step itself.
/// Toolpaths have fewer steps than kGroups.
inline std::uint32_t group_key(const MeshOptions& options, std::uint32_t step) {
  constexpr std::uint32_t kGroups = 0xffff0000u;
  return step < options.step_groups.size() ? kGroups + options.step_groups[step] : step;
}

/// Finds the simple corners of a band, and records in both caps the ones that they need.
void scan_corners(const Columns& columns, const MeshOptions& options, int band, CornerPlane& plane,
                  CapSheet& top, CapSheet& bottom);

/// The numbers below `count` for which test(number) is true, in order; tested on several threads.
template <class Test>
std::vector<std::size_t> numbers_where(unsigned threads, std::size_t count, const Test& test) {
  constexpr std::size_t kEach = 1 << 14;
  std::vector<std::vector<std::size_t>> found(count / kEach + 1);
  parallel_for(
      threads, found.size(),
      [&](std::size_t n) {
        for (std::size_t k = n * kEach; k < std::min((n + 1) * kEach, count); ++k)
          if (test(k)) found[n].push_back(k);
      },
      [] { return false; });
  std::vector<std::size_t> all;
  for (const std::vector<std::size_t>& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Makes the mesh a 2-manifold, in which each edge has exactly two triangles and each vertex one fan, by
/// splitting vertices, and by halving edges where that is not sufficient. Each edge must have as many
/// triangles in one direction as in the other. `near`: all triangles with a suspect vertex, possibly more;
/// new triangles are added.
void split_non_manifold(Mesh& mesh, unsigned threads, const std::vector<std::uint32_t>& suspects,
                        std::vector<std::size_t>& near);

/// Removes triangles without area; the mesh stays closed. Those whose removal would leave an edge with more
/// than two triangles stay. `among`: all that may have no area, in order.
void remove_degenerate_triangles(Mesh& mesh, unsigned threads, const std::vector<std::size_t>& among);
void remove_degenerate_triangles(Mesh& mesh, unsigned threads);

}  // namespace kerf::meshing
