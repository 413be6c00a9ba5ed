// The position of a vertex of an exact mesh: on the surface, edge or corner that the sweeps leave near it.
// See docs/decisions/0019-exact-meshes.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/exact/linked_mesh.h"
#include "sim/exact/nearby_sweeps.h"
#include "sim/exact/quadric.h"

#include "kerf/sim/workpiece.h"

namespace kerf::sim {

/// Vertices within this distance of a side of the block are on it, mm.
inline constexpr double kOnBlock = 1e-5;

/// Moves `point` onto the nearest surface that was cut, and returns the outward normal there. False if that
/// surface is further away than `max_distance` or does not face `outwards`.
/// `fixed`: axes along which the point does not move.
bool project_to_surface(const NearbySweeps& nearby, double max_distance, Point3 outwards,
                        const std::array<bool, 3>& fixed, Point3& point, Point3& normal);

/// Distance of a point from the surface of the remaining material of a block of this size, mm.
double surface_error_in_block(const NearbySweeps& nearby, Point3 size, Point3 point);

/// Computes new positions for the vertices of one mesh. `lowest`: Z below which nothing was cut.
class VertexFitter {
 public:
  VertexFitter(const LinkedMesh& mesh, const Workpiece::Body& body, double lowest, double tolerance)
      : mesh_(mesh),
        size_(body.bounds.size()),
        pitch_(body.pitch),
        lowest_cut_(lowest),
        tolerance_(tolerance),
        is_block_(!body.start) {}
  /// The new position of a vertex; the old one where no better one is found.
  Point3 fit(std::uint32_t vertex, SweepFinder& finder);

 private:
  static constexpr double kMaxProjected = 0.8;  // pitches
  using Fixed = std::array<bool, 3>;
  /// A point on a surface near the vertex, with the outward normal there: a plane.
  struct Sample {
    Point3 at, normal;
    Point3 triangle_normal;  // of the triangle from which the point was projected
  };
  void add_stock_plane(Point3 from, Point3 normal);
  void find_samples(std::uint32_t vertex, Point3 from);
  bool project(Sample& sample, Point3 outwards) const {
    return project_to_surface(*nearby_, kMaxProjected * pitch_, outwards, {}, sample.at, sample.normal);
  }
  bool is_smooth(std::uint32_t vertex, Point3& outwards) const;
  bool is_flat_enough() const;
  Point3 fit_smooth(Point3 from, Point3 outwards);
  double max_move_of(std::uint32_t vertex, Point3 from) const;
  Point3 fit_edge(std::uint32_t vertex, Point3 from, SweepFinder& finder);
  void fix_axes(std::uint32_t vertex, Point3 from);
  Quadric quadric_at(Point3 from, const Fixed& fixed) const;
  double plane_error(Point3 at) const;
  double surface_error(Point3 point) const;
  Point3 intersection(Point3 from, int rank) const;
  double within(int axis, double value) const;
  Point3 best_intersection(Point3 from) const;
  void resample_around(Point3 from);

  const LinkedMesh& mesh_;
  Point3 size_;
  double pitch_, lowest_cut_, tolerance_;
  bool is_block_;
  const NearbySweeps* nearby_ = nullptr;
  double max_move_ = 0.0;  // mm, in any direction
  double min_z_ = 0.0;
  Point3 corner_;                 // of the columns, whose square the vertex stays in; in plan
  Fixed fixed_{};                 // axes along which the vertex does not move
  std::vector<Sample> samples_;   // on surfaces that were cut
  std::vector<Sample> of_stock_;  // on the stock's own surface
};

}  // namespace kerf::sim
