// The parts of sharpen_mesh: what is around the vertices, what is near them, and where they go.
// docs/decisions/0006-mesh.md tells the method.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/exact/linked_mesh.h"
#include "sim/exact/nearby_sweeps.h"
#include "sim/exact/quadric.h"

#include "kerf/workpiece.h"

namespace kerf::sim {

/// Vertices within this of the block's sides are on them, mm.
inline constexpr double kOnBlock = 1e-5;

/// Moves `place` onto the nearest surface that was cut, and tells the material's normal there. False if that
/// is further than `most`, or does not face `outwards`.
/// `fixed`: axes along which it does not move.
bool put_on_surface(const Nearby& nearby, double most, Point3 outwards, const std::array<bool, 3>& fixed,
                    Point3& place, Point3& normal);

/// How far a place is from the surface of what is left of a block of this size, mm.
double miss_in_block(const Nearby& nearby, Point3 size, Point3 place);

/// Finds new places for the vertices of one mesh.
class Placer {
 public:
  Placer(const LinkedMesh& mesh, const Workpiece::Body& body, double tolerance)
      : mesh_(mesh),
        size_(body.bounds.size()),
        pitch_(body.pitch),
        tolerance_(tolerance),
        is_block_(!body.start) {}
  /// The new place of a vertex; the old one where no better one is found.
  Point3 place(std::uint32_t vertex, Around& around);

 private:
  static constexpr double kMaxProjected = 0.8;  // pitches
  using Fixed = std::array<bool, 3>;
  /// A place on a surface near the vertex and the material's normal there, outwards.
  struct Sample {
    Point3 at, normal;
    Point3 looking;  // the normal of the triangle that it was looked for on
  };
  void add_stock_plane(Point3 from, Point3 normal);
  void find_samples(std::uint32_t vertex, Point3 from);
  bool put_on_surface(Sample& sample, Point3 outwards) const {
    return sim::put_on_surface(*nearby_, kMaxProjected * pitch_, outwards, {}, sample.at, sample.normal);
  }
  bool is_smooth(std::uint32_t vertex, Point3& outwards) const;
  bool is_flat_enough() const;
  Point3 on_smooth(Point3 from, Point3 outwards);
  double most_moved(std::uint32_t vertex, Point3 from) const;
  Point3 on_edge(std::uint32_t vertex, Point3 from, Around& around);
  void fix_axes(std::uint32_t vertex, Point3 from);
  Quadric quadric_at(Point3 from, const Fixed& fixed) const;
  double miss_of(Point3 at) const;
  double miss_at(Point3 place) const;
  Point3 solved(Point3 from, int directions) const;
  double within(int axis, double value) const;
  Point3 best_step(Point3 from) const;
  void look_closer(Point3 from);

  const LinkedMesh& mesh_;
  Point3 size_;
  double pitch_, tolerance_;
  bool is_block_;
  const Nearby* nearby_ = nullptr;
  double most_moved_ = 0.0;       // mm, in any direction
  Point3 corner_;                 // of the columns, whose square the vertex stays in; in plan
  Fixed fixed_{};                 // axes along which it stays
  std::vector<Sample> samples_;   // on surfaces that were cut
  std::vector<Sample> of_stock_;  // on the stock's own
};

}  // namespace kerf::sim
