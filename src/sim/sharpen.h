// The parts of sharpen_mesh: what is around the vertices, what is near them, and where they go.
// docs/decisions/0006-mesh.md tells the method.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/quadric.h"
#include "sim/spots.h"

#include "kerf/simulate.h"

namespace kerf::sim {

/// Vertices within this of the block's sides are on them, mm.
inline constexpr double kOnBlock = 1e-5;

/// The triangles around vertices of a mesh, their middles and normals, in the block's frame.
class Fans {
 public:
  /// `first_new`: only those around the vertices from this number on and around their neighbours.
  Fans(const Mesh& mesh, Point3 low, unsigned threads, std::uint32_t first_new = 0);
  std::size_t vertices() const { return first_.size() - 1; }
  /// Calls visit(triangle) for each triangle around a vertex.
  template <class Visit>
  void around(std::uint32_t vertex, const Visit& visit) const {
    for (std::size_t k = first_[vertex]; k < first_[vertex + 1]; ++k) visit(triangle_[k]);
  }
  Point3 point(std::uint32_t vertex) const;
  Point3 middle(std::uint32_t triangle) const;
  /// Outwards; nothing (0, 0, 0) of a triangle without area, or around no vertex that is wanted.
  Point3 normal(std::uint32_t triangle) const;
  /// Three numbers a triangle.
  const std::vector<float>& normals() const { return normal_; }
  std::uint32_t step(std::uint32_t triangle) const { return mesh_.step[triangle]; }

 private:
  void gather(const std::vector<bool>& wanted);
  void find_normals(const std::vector<bool>& wanted, unsigned threads);

  const Mesh& mesh_;
  Point3 low_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> triangle_;
  std::vector<float> normal_;
};

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
  Placer(const Fans& fans, const Workpiece::Body& body, double tolerance)
      : fans_(fans),
        size_(body.bounds.size()),
        pitch_(body.pitch),
        tolerance_(tolerance),
        is_block_(!body.start) {}
  /// The new place of a vertex; the old one where no better one is found.
  Point3 place(std::uint32_t vertex, Around& around);

 private:
  static constexpr double kMostProjected = 0.8;  // pitches
  using Fixed = std::array<bool, 3>;
  /// A place on a surface near the vertex and the material's normal there, outwards.
  struct Sample {
    Point3 at, normal;
    Point3 looking;  // the normal of the triangle that it was looked for on
  };
  void add_stock_plane(Point3 from, Point3 normal);
  void find_samples(std::uint32_t vertex, Point3 from);
  bool put_on_surface(Sample& sample, Point3 outwards) const {
    return sim::put_on_surface(*nearby_, kMostProjected * pitch_, outwards, {}, sample.at, sample.normal);
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

  const Fans& fans_;
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
