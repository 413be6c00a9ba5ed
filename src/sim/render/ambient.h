// Ambient occlusion of a whole picture: at every second pixel in both directions, as it varies over much
// larger distances, and interpolated between surfaces of about the same depth.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/render/occlusion.h"
#include "sim/render/scene.h"

namespace kerf::rendering {

class Ambient {
 public:
  explicit Ambient(const Scene& scene);
  /// The surface at a pixel's first sample: for each pixel, before `compute`.
  void set(int x, int y, float depth, const PackedNormal& normal);
  void compute();
  /// 0 open to 1 closed.
  float closed(int x, int y) const;

 private:
  struct Offset {
    int x, y;
  };
  /// A value for every second pixel in both directions.
  struct Coarse {
    int columns, rows;
    std::vector<float> values;
    Coarse(int nx, int ny)
        : columns(nx), rows(ny), values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny)) {}
    std::size_t index(int x, int y) const {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
    }
    float& at(int x, int y) { return values[index(x, y)]; }
    float at(int x, int y) const { return values[index(x, y)]; }
  };
  /// Normals and results of every fourth point of a coarse row.
  struct OcclusionLine {
    std::vector<float> right, up, into, result;
    explicit OcclusionLine(int columns) {
      for (std::vector<float>* list : {&right, &up, &into, &result})
        list->resize(static_cast<std::size_t>(columns / kPattern + 1 + kOcclusionLanes));
    }
  };
  double radius_in_pixels() const;
  int reach() const;
  std::vector<Ray> rays_of(int cell) const;
  void occlude_line(int y, int cell, const std::vector<Ray>& rays, OcclusionLine& line, Coarse& result) const;
  float mean(const Coarse& values, float depth, Offset low, Offset high) const;

  const Scene& scene_;
  PixelPoints points_;
  Coarse blurred_;
  std::vector<PackedNormal> normals_;  // of every second pixel in both directions
};

}  // namespace kerf::rendering
