// Edges of a mesh that stray from the surface between their ends: long ones on steep or strongly curved
// places, which the columns show too few points of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/sharpen.h"

namespace kerf::sim {

/// Positions of a mesh and where its triangles are to face, three numbers each.
struct MeshState {
  std::vector<float> positions, outwards;
};

/// What a round has done.
enum class EdgeRound : std::uint8_t { nothing, turned, parted };

/// Puts vertices on edges and parts the triangles there, or gives two triangles their other diagonal.
class EdgeSplitter {
 public:
  /// `bends`: the vertices around which the mesh is not flat; between others no edge strays. `tolerance`: how
  /// far an edge's middle may be from the surface, mm.
  EdgeSplitter(Mesh& mesh, const Workpiece::Body& body, const SweepsByTile& sweeps, std::vector<bool> bends,
               double tolerance, unsigned threads);
  /// Turns edges that stray where that helps; if there are none (any more), splits each that strays once.
  /// Where triangles were parted `straight` gets the mesh with the new vertices in the middles of their
  /// edges.
  template <class Stop>
  EdgeRound split(MeshState& straight, const Stop& stop) {
    const Fans fans(mesh_, low_, threads_, first_new_);
    find_suspects(fans);
    found_.assign(spots_.size(), {});
    sweeps_.visit(
        spots_, threads_, [&](std::size_t n, Around& around) { look_at(fans, n, around); }, stop);
    if (stop()) return EdgeRound::nothing;
    if (flip(fans)) return EdgeRound::turned;
    return part(fans, straight) ? EdgeRound::parted : EdgeRound::nothing;
  }

 private:
  struct Found {
    bool strays = false;  // the edge needs a vertex at `at`, block frame
    bool turns = false;   // the other diagonal of its two triangles is nearer to the surface
    Point3 at;
  };
  struct Ends {
    std::uint32_t a, b;
  };
  Ends ends_of(std::uint32_t corner) const;
  Point3 middle_of(const Fans& fans, std::uint32_t corner) const;
  std::uint32_t across(const Fans& fans, std::uint32_t corner) const;
  double bend_of(const Fans& fans, std::uint32_t corner) const;
  void find_suspects(const Fans& fans);
  void look_at(const Fans& fans, std::size_t n, Around& around);
  std::uint32_t opposite(std::uint32_t triangle, Ends ends) const;
  bool can_turn(const Fans& fans, std::uint32_t triangle, std::uint32_t other, Ends ends) const;
  double miss_at(const Nearby& nearby, Point3 place) const;
  bool flip(const Fans& fans);
  void turn(std::uint32_t triangle, std::uint32_t other, Ends ends);
  bool part(const Fans& fans, MeshState& straight);
  void add_vertex(Point3 at, Point3 middle, MeshState& straight);
  void part_triangle(std::size_t triangle, const std::array<std::uint32_t, 3>& middles, MeshState& straight);

  Mesh& mesh_;
  Point3 low_, size_;
  double pitch_, tolerance_;
  bool is_block_;
  const SweepsByTile& sweeps_;
  std::vector<bool> bends_;
  unsigned threads_;
  std::vector<Spot>
      spots_;  // edges: the corner that an edge begins at, in the triangle where it goes upwards
  std::vector<Found> found_;
  int flips_ = 0;                // rounds of them, since the last vertices
  std::uint32_t first_new_ = 0;  // vertex: edges between older ones have been looked at
};

}  // namespace kerf::sim
