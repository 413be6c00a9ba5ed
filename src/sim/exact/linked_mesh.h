// A half-edge view of a mesh: it stores the neighbour across each side of a triangle, so that the triangles
// around a vertex and beside an edge are found, and changed, without a search of the whole mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/mesh/mesh_build.h"

#include "kerf/geom/geometry.h"
#include "kerf/sim/mesh.h"

namespace kerf::sim {

using meshing::kNone;

/// Corner k (0 to 2) of triangle t has the number 3 t + k. It also identifies a side (half-edge), the one
/// from its vertex to that of the next corner. Positions are in the block's frame.
class LinkedMesh {
 public:
  /// `low`: the block's lowest corner.
  LinkedMesh(Mesh& mesh, Point3 low, unsigned threads);

  std::size_t vertices() const { return first_.size(); }
  std::size_t triangles() const { return mesh_.step.size(); }
  Mesh& mesh() { return mesh_; }

  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static std::uint32_t before(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
  std::uint32_t vertex(std::uint32_t corner) const { return mesh_.triangles[corner]; }
  /// The opposite half-edge, of the neighbouring triangle; kNone if there is none.
  std::uint32_t across(std::uint32_t corner) const { return across_[corner]; }
  /// A side between two vertices, in either direction; kNone if there is none.
  std::uint32_t find_side(std::uint32_t a, std::uint32_t b) const;
  /// Calls visit(corner) with the corner of each triangle at a vertex, in order around it.
  template <class Visit>
  void corners_around(std::uint32_t vertex, const Visit& visit) const {
    const std::uint32_t start = first_[vertex];
    if (start == kNone) return;
    std::uint32_t corner = start;
    do {
      visit(corner);
      corner = across_[before(corner)];
    } while (corner != kNone && corner != start);
    if (corner == start) return;
    for (corner = across_[start]; corner != kNone; corner = across_[corner]) {
      corner = next(corner);
      visit(corner);
    }
  }
  /// Calls visit(triangle) for each triangle around a vertex.
  template <class Visit>
  void around(std::uint32_t vertex, const Visit& visit) const {
    corners_around(vertex, [&](std::uint32_t corner) { visit(corner / 3); });
  }

  Point3 point(std::uint32_t vertex) const {
    const float* p = mesh_.positions.data() + std::size_t{3} * vertex;
    return Point3{p[0], p[1], p[2]} - low_;
  }
  Point3 centroid(std::uint32_t triangle) const;
  /// Outwards, length 1; (0, 0, 0) for a triangle without area.
  Point3 normal(std::uint32_t triangle) const {
    const float* n = normal_.data() + std::size_t{3} * triangle;
    return {n[0], n[1], n[2]};
  }
  std::uint32_t step(std::uint32_t triangle) const { return mesh_.step[triangle]; }
  void set_step(std::uint32_t triangle, std::uint32_t step) { mesh_.step[triangle] = step; }

  /// A mark on an edge, seen from both triangles, until the edge is flipped or split.
  bool is_marked(std::uint32_t corner) const { return marked_[corner] != 0; }
  void mark(std::uint32_t corner);

  /// Replaces edge a-b of triangles (a, b, c) and (b, a, d) by c-d: they become (a, d, c) and (d, b, c).
  /// `corner`: of a in the first. Does not update the normals.
  void flip(std::uint32_t corner);
  void update_normal(std::uint32_t triangle);
  /// Adds a vertex without triangles.
  std::uint32_t add_vertex(Point3 position);
  void move(std::uint32_t vertex, Point3 position);
  /// A side and the new vertex that splits it.
  struct EdgeSplit {
    std::uint32_t corner, vertex;
  };
  /// Splits edges and the triangles beside them. The new triangles inherit step and normal. Returns all
  /// triangles changed or created.
  std::vector<std::uint32_t> split(const std::vector<EdgeSplit>& splits);
  /// To be called after vertices have moved. `changed`: the triangles around them. A triangle is folded if it
  /// faces away from its old normal: its longest side is flipped, and if that fails, its vertices return to
  /// old_position(vertex). Updates the normals, and adds the neighbours that changed to `changed`.
  template <class OldPosition>
  void repair_folds(std::vector<std::uint32_t>& changed, const OldPosition& old_position);

 private:
  void link(unsigned threads);
  void update_normals(unsigned threads);
  void join(std::uint32_t corner, std::uint32_t other) {
    across_[corner] = other;
    if (other != kNone) across_[other] = corner;
  }
  struct SplitTriangle;
  void split_triangle(SplitTriangle& split);
  void join_split(const SplitTriangle& split, const std::vector<SplitTriangle>& all);
  std::uint32_t new_triangle(std::uint32_t like);
  Point3 facing(std::uint32_t triangle) const;
  bool is_folded(std::uint32_t triangle) const { return dot(facing(triangle), normal(triangle)) < 0.0; }
  bool has_no_area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return meshing::has_no_area(point(a), point(b), point(c));
  }
  bool faces(std::uint32_t a, std::uint32_t b, std::uint32_t c, Point3 outwards) const;
  bool unfold(std::uint32_t triangle, std::vector<std::uint32_t>& changed);
  void unfold_all(std::vector<std::uint32_t>& changed);

  Mesh& mesh_;
  Point3 low_;
  std::vector<std::uint32_t> across_;        // of corners
  std::vector<std::uint32_t> first_;         // of vertices: a corner there
  std::vector<float> normal_;                // three numbers per triangle
  std::vector<std::uint8_t> marked_;         // of corners
  std::vector<std::uint32_t> split_number_;  // of triangles: index of its SplitTriangle, or kNone
};

template <class OldPosition>
void LinkedMesh::repair_folds(std::vector<std::uint32_t>& changed, const OldPosition& old_position) {
  constexpr int kMaxRounds = 4;
  unfold_all(changed);
  for (int round = 0; round < kMaxRounds; ++round) {
    std::vector<std::uint32_t> back;
    for (const std::uint32_t t : changed)
      if (is_folded(t)) back.push_back(t);
    if (back.empty()) break;
    for (const std::uint32_t t : back)
      for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) move(vertex(c), old_position(vertex(c)));
  }
  for (const std::uint32_t t : changed) update_normal(t);
}

}  // namespace kerf::sim
