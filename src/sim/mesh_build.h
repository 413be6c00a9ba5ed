// The parts that make triangles: the mesh under construction, walls, flat-merging caps, and the final split
// of edges that more than two triangles share. docs/decisions/0006-mesh.md tells the whole method.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/blocks.h"
#include "sim/mesh_corners.h"

namespace kerf::meshing {

/// One number for an edge, whichever way it is walked.
inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

/// A mesh that grows. Vertices whose edges may be shared by four triangles are remembered for
/// `split_shared_edges`.
struct Builder {
  const Columns& columns;
  const MeshOptions& options;
  Mesh mesh;
  std::vector<std::uint32_t> suspects;

  std::uint32_t add_vertex(double x, double y, double z);
  /// The vertex of a sheet, made now if no triangle has needed it yet.
  std::uint32_t vertex(Sheet& sheet);
  /// Adds a triangle unless two of its vertices are one.
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t step);
};

/// One side of a face between two columns: a corner and which of its quadrants the two columns are.
struct FaceLine {
  CornerRow& row;
  const Corner& corner;
  int quadrant_a, quadrant_b;
};

/// Fills the face between column A and column B, seen from B with `left` at the left hand, where one of them
/// has material and the other has none.
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
    int change;       // to (material in A) - (material in B) when passing upwards
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

/// A number for each corner of a grid, in memory that is not touched before it is needed.
template <class Number>
class Plane {
 public:
  Plane(int columns, int rows)
      : columns_(static_cast<std::size_t>(columns)),
        numbers_(static_cast<Number*>(
            sim::new_block(columns_ * static_cast<std::size_t>(rows) * sizeof(Number)))) {}
  Number& operator()(int x, int y) {
    return numbers_.get()[static_cast<std::size_t>(y) * columns_ + static_cast<std::size_t>(x)];
  }
  Number operator()(int x, int y) const {
    return numbers_.get()[static_cast<std::size_t>(y) * columns_ + static_cast<std::size_t>(x)];
  }
  void fill_row(int y, Number number) { std::fill_n(&(*this)(0, y), columns_, number); }

 private:
  struct Free {
    void operator()(Number* block) const { sim::free_block(block); }
  };
  std::size_t columns_;
  std::unique_ptr<Number, Free> numbers_;
};

/// The caps of all columns on one side, the tops of their highest intervals or the bottoms of their lowest,
/// with level areas of one step merged: a right-triangulated irregular network over the corners, without
/// T-junctions. Rows of squares are bands, which several threads can work on at a time.
class CapSheet {
 public:
  enum class Side : std::uint8_t { top, bottom };
  CapSheet(Builder& builder, Side side);
  int bands() const { return (rows_ + kSquare - 1) / kSquare; }
  int first_row(int band) const { return band * kSquare; }
  int end_row(int band) const { return std::min(rows_, (band + 1) * kSquare); }

  /// Makes ready the corners of a row, which may lie beyond the grid.
  void begin_row(int j);
  /// Notes a simple corner: its height, and whether it may be dropped.
  void add_simple(int i, int j, double z, bool may_go) {
    if (simplifies()) height_(i, j) = static_cast<float>(z);
    needed_(i, j) = may_go ? 0 : 1;
  }
  /// Takes over the other corners of a row, and what walls made of simple ones; to be called once no wall
  /// touches the row any more.
  void take(CornerRow& row, int j);
  /// Finds the corners that triangles need.
  void refine();
  /// Finds the vertices of a band that there are not yet; they get numbers from number_vertices on.
  void place_vertices(int band);
  void number_vertices();
  void make_triangles(int band);
  /// Moves what there is of a band to its place in the mesh.
  void move_to_mesh(int band);
  /// Makes room in the mesh for all triangles; afterwards move_to_mesh may be called.
  void make_room();

 private:
  /// Side of the largest merged square, in columns; a power of two.
  static constexpr int kSquare = 64;
  struct Node {
    int x, y;
  };
  struct Band {
    std::vector<float> positions;
    std::vector<std::uint32_t> triangles, step;
    std::uint32_t first_vertex = 0;
    std::size_t first_triangle = 0;
  };
  static constexpr int whole_squares(int n) { return (n + kSquare - 1) / kSquare * kSquare; }
  int end_of(int i, int j) const { return side_ == Side::bottom ? 0 : builder_.columns.ends(i, j) - 1; }
  void take_whole(Sheet& sheet, int i, int j);
  bool level(int i, int j) const;
  bool of_one_group(int i, int j) const;
  bool simplifies() const { return builder_.options.tolerance > Length(); }
  template <class Work>
  void for_each_middle(const Work& work) const;
  void find_errors();
  void propagate();
  bool is_new_vertex(int x, int y) const;
  void cover(Band& band, Node a, Node b, Node apex) const;
  void leaf(Band& band, Node a, Node b, Node apex) const;
  std::uint32_t vertex(Node corner, Node column) const;

  Builder& builder_;
  Side side_;
  int stride_ = 0, rows_ = 0;   // of the corners, whole squares
  Plane<float> height_;         // of the corners, for a tolerance above 0; kUnknown where it does not matter
  Plane<std::uint8_t> needed_;  // corners that must be vertices
  Plane<std::uint32_t> known_;  // vertex of each corner, or kNone, or kNew or kMany + a number
  std::vector<std::array<std::uint32_t, 4>> parts_;  // vertices by quadrant where the cap is torn
  std::vector<Band> bands_;
};

/// What the steps of a corner's columns are compared by: the group of a step, see MeshOptions::step_groups.
inline std::uint64_t group_key(const MeshOptions& options, std::uint32_t step) {
  constexpr std::uint64_t kOwnGroup = 0x100;
  return step < options.step_groups.size() ? options.step_groups[step] : step + kOwnGroup;
}

/// Finds the simple corners of rows `first` to `end` - 1 and tells both sheets of them.
void scan_corners(const Builder& builder, int first, int end, CornerPlane& plane, CapSheet& top,
                  CapSheet& bottom);

/// Makes every edge the edge of exactly two triangles and every vertex the tip of one fan, by parting
/// vertices (and, where that does not part an edge, by halving it). All edges must already have as many
/// triangles on one side as on the other.
void split_shared_edges(Mesh& mesh, const std::vector<std::uint32_t>& suspects);

/// Takes out triangles without area, after which the mesh is as closed as before. A few may stay where taking
/// them out would leave an edge to more than two triangles.
void mend_flat_triangles(Mesh& mesh, unsigned threads);

}  // namespace kerf::meshing
