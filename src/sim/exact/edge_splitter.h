// Edges of an exact mesh that deviate from the surface between their end points: long ones on steep or
// strongly curved surfaces, of which the columns have too few points.
//
// An edge is coarse if its midpoint is further from the surface than the tolerance. In each round, flip_edges
// flips the coarse edges whose other diagonal is better, then split_edges adds a vertex on the surface to the
// others and splits their triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/exact/vertex_fitter.h"

namespace kerf::sim {

class EdgeSplitter {
 public:
  /// `is_curved`: the vertices around which the mesh is not flat; edges between others are not coarse.
  /// `tolerance`: maximum distance of an edge's midpoint from the surface, mm.
  EdgeSplitter(LinkedMesh& mesh, const Workpiece::Body& body, SweepsByTile& sweeps,
               std::vector<bool> is_curved, double tolerance, unsigned threads);
  /// Finds the coarse edges, and flips those where that helps. Only edges of triangles that have changed are
  /// examined again.
  template <class Stop>
  void flip_edges(const Stop& stop) {
    const int rounds = first_new_ == 0 ? kMaxFlipRounds : kMaxFlipRoundsLater;
    for (int round = 0; round <= rounds; ++round) {
      may_flip_ = round < rounds;
      find_suspects();
      found_.assign(queries_.size(), {});
      sweeps_.visit(
          queries_, threads_, [&](std::size_t n, SweepFinder& finder) { examine(n, finder); }, stop);
      if (stop()) return;
      record_coarse();
      if (may_flip_) flip_coarse();
    }
  }
  /// Adds vertices on the edges that are still coarse; false if there are none.
  template <class Stop>
  bool split_edges(const Stop& stop) {
    find_crossed();
    std::vector<std::uint8_t> is_good(queries_.size(), 0);
    sweeps_.visit(
        queries_, threads_,
        [&](std::size_t n, SweepFinder& finder) { is_good[n] = is_crossing_good(n, finder); }, stop);
    if (stop()) return false;
    for (std::size_t n = 0; n < queries_.size(); ++n)
      if (is_good[n] != 0) coarse_[queries_[n].number].found.verdict = Verdict::crossed;
    return split_coarse();
  }

 private:
  /// Rounds of flipping before the first vertices are added, and afterwards.
  static constexpr int kMaxFlipRounds = 3, kMaxFlipRoundsLater = 1;

  enum class Verdict : std::uint8_t {
    unknown,  // coarse, but no surface was found
    good,     // within the tolerance
    split,    // needs a vertex
    flip,     // the other diagonal of its two triangles is closer to the surface
    crossed   // to be replaced by the edge between the vertices that its two triangles get
  };
  struct Found {
    Verdict verdict = Verdict::unknown;
    Point3 at;  // position of the new vertex, block frame
  };
  struct CoarseEdge {
    std::uint32_t corner, a, b;  // side and vertices
    Found found;
    Point3 crossing;  // midpoint of the edge that may replace it, see find_crossed
  };
  Point3 midpoint_of(std::uint32_t corner) const;
  Point3 normal_at(std::uint32_t vertex, Point3 facing) const;
  void find_smooth_normal(std::uint32_t vertex);
  void find_smooth_normals();
  double normal_change(std::uint32_t corner) const;
  bool is_suspect(std::uint32_t corner) const;
  void find_suspects();
  void examine(std::size_t n, SweepFinder& finder);
  bool can_flip(std::uint32_t corner) const;
  double surface_error(const NearbySweeps& nearby, Point3 point) const;
  void requery_coarse();
  void add_coarse(std::uint32_t corner, const Found& found) {
    coarse_.push_back({corner, mesh_.vertex(corner), mesh_.vertex(LinkedMesh::next(corner)), found, {}});
  }
  void record_coarse();
  void flip_edge(std::uint32_t corner);
  void flip_coarse();
  const CoarseEdge* only_other(std::uint32_t corner) const;
  void find_crossed();
  bool is_crossing_good(std::size_t n, SweepFinder& finder) const;
  bool split_coarse();

  LinkedMesh& mesh_;
  Point3 size_;
  double pitch_, tolerance_;
  bool is_block_;
  SweepsByTile& sweeps_;
  std::vector<bool> is_curved_;
  unsigned threads_;
  bool may_flip_ = true;
  std::vector<std::uint32_t> changed_;               // triangles since the last find_suspects
  std::vector<std::uint8_t> is_changed_;             // of triangles
  std::vector<std::array<float, 3>> smooth_normal_;  // of vertices within one smooth surface, else 0
  std::vector<QueryPoint> queries_;                  // midpoints of edges; number: a corner
  std::vector<Found> found_;                         // of queries_
  std::vector<CoarseEdge> coarse_;
  std::vector<std::uint32_t> coarse_of_;  // of corners: index in coarse_, or kNone
  std::uint32_t first_new_ = 0;           // vertex: edges between older ones have been examined
};

}  // namespace kerf::sim
