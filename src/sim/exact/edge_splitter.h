// Edges of a mesh that stray from the surface between their ends: long ones on steep or strongly curved
// places, which the columns show too few points of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/exact/vertex_fitter.h"

namespace kerf::sim {

/// Puts vertices on edges and parts the triangles there, or gives two triangles their other diagonal. Only
/// what has changed is looked at again.
class EdgeSplitter {
 public:
  /// `bends`: the vertices around which the mesh is not flat; between others no edge strays. `tolerance`: how
  /// far an edge's middle may be from the surface, mm.
  EdgeSplitter(LinkedMesh& mesh, const Workpiece::Body& body, const SweepsByTile& sweeps,
               std::vector<bool> bends, double tolerance, unsigned threads);
  /// Looks for edges that stray, and turns those where that helps.
  template <class Stop>
  void turn(const Stop& stop) {
    const int most = first_new_ == 0 ? kMaxTurns : kMaxTurnsLater;
    for (int round = 0; round <= most; ++round) {
      may_turn_ = round < most;
      find_suspects();
      found_.assign(queries_.size(), {});
      sweeps_.visit(
          queries_, threads_, [&](std::size_t n, Around& around) { look_at(n, around); }, stop);
      if (stop()) return;
      take_found();
      if (may_turn_) turn_edges();
    }
  }
  /// Puts vertices on the edges that still stray; false if there is none.
  template <class Stop>
  bool part(const Stop& stop) {
    find_crossed();
    std::vector<std::uint8_t> is_good(queries_.size(), 0);
    sweeps_.visit(
        queries_, threads_, [&](std::size_t n, Around& around) { is_good[n] = look_at_crossed(n, around); },
        stop);
    if (stop()) return false;
    for (std::size_t n = 0; n < queries_.size(); ++n)
      if (is_good[n] != 0) strays_[queries_[n].number].found.verdict = Verdict::crossed;
    return part_strays();
  }

 private:
  /// Rounds of turned edges before vertices are added.
  static constexpr int kMaxTurns = 3, kMaxTurnsLater = 1;

  enum class Verdict : std::uint8_t {
    unknown,  // it strays, but no surface is found
    good,
    parts,   // it needs a vertex
    turns,   // the other diagonal of its two triangles is nearer to the surface
    crossed  // it makes way for an edge between vertices that its two triangles get
  };
  struct Found {
    Verdict verdict = Verdict::unknown;
    Point3 at;  // of the vertex, block frame
  };
  struct Stray {
    std::uint32_t corner, a, b;  // the vertices that it is between
    Found found;
    Point3 crossing;  // the middle of the edge that it may make way for
  };
  Point3 middle_of(std::uint32_t corner) const;
  Point3 normal_at(std::uint32_t vertex, Point3 facing) const;
  void find_one_surface(std::uint32_t vertex);
  void find_one_surfaces();
  double bend_of(std::uint32_t corner) const;
  bool is_suspect(std::uint32_t corner) const;
  void find_suspects();
  void look_at(std::size_t n, Around& around);
  bool can_turn(std::uint32_t corner) const;
  double miss_at(const Nearby& nearby, Point3 place) const;
  void look_again();
  void add_stray(std::uint32_t corner, const Found& found) {
    strays_.push_back({corner, mesh_.vertex(corner), mesh_.vertex(LinkedMesh::next(corner)), found, {}});
  }
  void take_found();
  void turn_edge(std::uint32_t corner);
  void turn_edges();
  const Stray* only_other(std::uint32_t corner) const;
  void find_crossed();
  bool look_at_crossed(std::size_t n, Around& around) const;
  bool part_strays();

  LinkedMesh& mesh_;
  Point3 size_;
  double pitch_, tolerance_;
  bool is_block_;
  const SweepsByTile& sweeps_;
  std::vector<bool> bends_;
  unsigned threads_;
  bool may_turn_ = true;
  std::vector<std::uint32_t> changed_;          // triangles since the last look
  std::vector<std::uint8_t> is_changed_;        // of triangles
  std::vector<std::array<float, 3>> smoothed_;  // of vertices within one surface its normal, else 0
  std::vector<QueryPoint> queries_;             // edges, by a corner
  std::vector<Found> found_;                    // of queries_
  std::vector<Stray> strays_;                   // that are known
  std::vector<std::uint32_t> stray_of_;         // of corners: number of the stray, or kNone
  std::uint32_t first_new_ = 0;                 // vertex: edges between older ones have been looked at
};

}  // namespace kerf::sim
