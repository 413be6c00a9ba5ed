// The samples of a band of a picture: what is visible at each, its normal, and where neighbours differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/render/scene.h"

namespace kerf::rendering {

/// One normal per vertex, the mean of its faces weighted by area.
std::vector<std::array<float, 3>> smooth_normals(const Mesh& mesh);

/// A sample of the ground or of a surface.
struct Sample {
  std::uint32_t triangle;  // kNothing: the ground, or the background at kFarDepth
  float depth;
  PackedNormal normal;
};

class Samples {
 public:
  /// `drawing`: of the scene from its eye, with at least one extra row.
  Samples(const Scene& scene, const Drawing& drawing,
          const std::vector<std::array<float, 3>>& vertex_normals);
  /// Draws a band; memory is used again.
  void draw(std::size_t band);

  Sample at(int x, int y) const {
    const std::size_t k = target_.index(x, y);
    return {target_.triangle[k], target_.depth[k], normals_[k]};
  }
  /// Whether one colour suits all samples of a pixel.
  bool is_plain(int x, int y) const;
  /// Brightness factor of lines at silhouettes, steps in depth and creases, by comparison with the
  /// neighbouring samples; 1 without a line.
  double line_at(int x, int y) const;

 private:
  enum Differs : std::uint8_t { with_right = 1, with_lower = 2 };
  /// The normals of a triangle at the samples of the picture, before they are scaled to length 1.
  struct NormalField {
    PackedNormal packed;  // of a flat one
    bool is_flat = true;
    Point3 origin, dx, dy;
    PackedNormal at(double x, double y) const {
      return is_flat ? packed : PackedNormal::of(unit(origin + x * dx + y * dy));
    }
  };
  NormalField normals_of(std::uint32_t triangle) const;
  void add_ground(int y, int first, int last);
  void add_ground_and_normals();
  bool differ(std::size_t a, std::size_t b) const;
  void compare_neighbours();

  const Scene& scene_;
  const Drawing& drawing_;
  const std::vector<std::array<float, 3>>& vertex_normals_;
  Cut ground_;
  Target target_;
  std::vector<PackedNormal> normals_;
  std::vector<std::uint8_t> differs_;  // per sample: the neighbours that it must not be averaged with
  // Triangles return in the next row.
  std::vector<NormalField> recent_;
  std::vector<std::uint32_t> recent_triangle_;
};

}  // namespace kerf::rendering
