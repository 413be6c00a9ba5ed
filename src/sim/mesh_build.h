// The parts that make triangles: the mesh under construction, walls, flat-merging caps, and the final split
// of edges that more than two triangles share. docs/decisions/0006-mesh.md tells the whole method.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/mesh_corners.h"

namespace kerf::meshing {

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

/// The caps of all columns on one side, the tops of their highest intervals or the bottoms of their lowest,
/// with level areas of one step merged: a right-triangulated irregular network over the corners, without
/// T-junctions.
class CapSheet {
 public:
  enum class Side : std::uint8_t { top, bottom };
  CapSheet(Builder& builder, Side side);
  /// Takes over what walls made of the corners of a row; to be called once no wall touches the row any more.
  void take(CornerRow& row, int j);
  /// Adds the triangles. False if stopped.
  bool emit(Progress* progress);

 private:
  struct Node {
    int x, y;
  };
  int end_of(int i, int j) const { return side_ == Side::bottom ? 0 : builder_.columns.ends(i, j) - 1; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(x);
  }
  std::uint32_t& known(int x, int y) {
    return known_[static_cast<std::size_t>(y) * static_cast<std::size_t>(builder_.columns.nx() + 1) +
                  static_cast<std::size_t>(x)];
  }
  void take_whole(Sheet& sheet, int i, int j);
  bool level(int i, int j) const;
  bool of_one_group(int i, int j) const;
  bool same_group(std::uint32_t a, std::uint32_t b) const;
  bool simplifies() const { return !height_.empty(); }
  template <class Work>
  void for_each_middle(const Work& work);
  void find_errors();
  void propagate();
  void cover(Node a, Node b, Node apex);
  void leaf(Node a, Node b, Node apex);
  std::uint32_t vertex(Node corner, Node column);

  Builder& builder_;
  Side side_;
  int stride_ = 0, rows_ = 0;
  std::vector<float> height_;  // of the corners, for a tolerance above 0; kUnknown where it does not matter
  std::vector<std::uint8_t> needed_;  // corners that must be vertices, padded to whole squares
  std::vector<std::uint32_t> known_;  // vertex of each corner, or kNone, or kMany + number in parts_
  std::vector<std::array<std::uint32_t, 4>> parts_;  // vertices by quadrant where the cap is torn
};

/// Makes every edge the edge of exactly two triangles and every vertex the tip of one fan, by parting
/// vertices (and, where that does not part an edge, by halving it). All edges must already have as many
/// triangles on one side as on the other.
void split_shared_edges(Mesh& mesh, const std::vector<std::uint32_t>& suspects);

/// Takes out triangles without area, after which the mesh is as closed as before. A few may stay where taking
/// them out would leave an edge to more than two triangles.
void mend_flat_triangles(Mesh& mesh);

}  // namespace kerf::meshing
