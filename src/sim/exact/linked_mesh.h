// A mesh whose triangles know their neighbours, so that what is around a vertex or beside an edge is found,
// and changed, without a look at the rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "sim/mesh/mesh_build.h"

#include "kerf/geometry.h"
#include "kerf/mesh.h"

namespace kerf::sim {

using meshing::kNone;

/// A side of a triangle is told by its corner (three times the triangle's number plus 0 to 2): it goes from
/// there to the next corner. Places are in the block's frame.
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
  /// The same side, seen from the triangle beyond; kNone if there is none.
  std::uint32_t across(std::uint32_t corner) const { return across_[corner]; }
  /// The corner of a side between two vertices, seen from either triangle; kNone if there is none.
  std::uint32_t find(std::uint32_t a, std::uint32_t b) const;
  /// Calls visit(corner) with the corner that each triangle around a vertex has there, in turn.
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
  Point3 middle(std::uint32_t triangle) const;
  /// Outwards; nothing (0, 0, 0) of a triangle without area.
  Point3 normal(std::uint32_t triangle) const {
    const float* n = normal_.data() + std::size_t{3} * triangle;
    return {n[0], n[1], n[2]};
  }
  std::uint32_t step(std::uint32_t triangle) const { return mesh_.step[triangle]; }
  void set_step(std::uint32_t triangle, std::uint32_t step) { mesh_.step[triangle] = step; }

  /// A mark that stays with a side, for both triangles, until it is parted.
  bool is_marked(std::uint32_t corner) const { return marked_[corner] != 0; }
  void mark(std::uint32_t corner);

  /// Triangles (a, b, c) and (b, a, d), the first of which has corner a here, become (a, d, c) and (d, b, c).
  /// What is known of where they face stays as it was.
  void turn(std::uint32_t corner);
  void find_normal(std::uint32_t triangle);
  /// Adds a vertex that no triangle has yet.
  std::uint32_t add_vertex(Point3 place);
  void move(std::uint32_t vertex, Point3 place);
  /// A side and the new vertex that it is to be parted by.
  struct Parting {
    std::uint32_t corner, vertex;
  };
  /// Parts the triangles beside some sides. The new ones face as those did. Returns them all.
  std::vector<std::uint32_t> part(const std::vector<Parting>& partings);
  /// After vertices have moved: the triangles around them that face the other way than before are flipped
  /// with the neighbours of their longest sides; the vertices of those that still do go back to where
  /// `place_before(vertex)` says. Then `changed`, which grows by the neighbours, have new normals.
  template <class PlaceBefore>
  void settle(std::vector<std::uint32_t>& changed, const PlaceBefore& place_before);

 private:
  void link(unsigned threads);
  void find_normals(unsigned threads);
  void join(std::uint32_t corner, std::uint32_t other) {
    across_[corner] = other;
    if (other != kNone) across_[other] = corner;
  }
  struct Parted;
  void part_triangle(Parted& parted);
  void join_parts(const Parted& parted, const std::vector<Parted>& all);
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
  std::vector<std::uint32_t> across_;  // of corners
  std::vector<std::uint32_t> first_;   // of vertices: a corner there
  std::vector<float> normal_;          // three numbers a triangle
  std::vector<std::uint8_t> marked_;   // of corners
  std::vector<std::uint32_t> parted_;  // of triangles: number among those that are being parted, or kNone
};

template <class PlaceBefore>
void LinkedMesh::settle(std::vector<std::uint32_t>& changed, const PlaceBefore& place_before) {
  constexpr int kMaxReturns = 4;
  unfold_all(changed);
  for (int round = 0; round < kMaxReturns; ++round) {
    std::vector<std::uint32_t> back;
    for (const std::uint32_t t : changed)
      if (is_folded(t)) back.push_back(t);
    if (back.empty()) break;
    for (const std::uint32_t t : back)
      for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) move(vertex(c), place_before(vertex(c)));
  }
  for (const std::uint32_t t : changed) find_normal(t);
}

}  // namespace kerf::sim
