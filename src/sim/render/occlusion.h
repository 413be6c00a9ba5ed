// Ambient occlusion of the surfaces of a picture: how much of the sky the surfaces around a point hide.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf::rendering {

inline constexpr int kDirections = 8, kSteps = 5;  // rays per point, samples per ray
/// Rays have one of kPattern x kPattern sets of directions and lengths, by the position of their point.
inline constexpr int kPattern = 4;

/// The surface points of a picture in the viewer's frame (right, up, into; mm), for reading every eighth
/// pixel of a row at once. Outside the picture and where nothing is visible, `into` is kFarDepth.
class PixelPoints {
 public:
  static constexpr int kStride = 8;

  PixelPoints() = default;
  /// `reach`: maximum distance in pixels from the picture at which points are read.
  PixelPoints(int width, int height, int reach);
  void set(int x, int y, float right, float up, float into) {
    const std::size_t at = index(x, y);
    right_[at] = right;
    up_[at] = up;
    into_[at] = into;
  }
  float into(int x, int y) const { return into_[index(x, y)]; }
  int height() const { return height_; }

  /// Of pixel x in row y; the pixels x + 8, x + 16 ... follow.
  std::size_t index(int x, int y) const {
    const int from = x + margin_ * kStride, row = kStride * y + from % kStride;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(from / kStride);
  }
  const float* right() const { return right_.data(); }
  const float* up() const { return up_.data(); }
  const float* into() const { return into_.data(); }

 private:
  int height_ = 0, margin_ = 0, columns_ = 0;  // margin and columns in units of kStride pixels
  std::vector<float> right_, up_, into_;
};

struct RayOffset {
  int x, y;  // pixels
};
using Ray = std::array<RayOffset, kSteps>;

/// The points of every eighth pixel of a row, their normals in the viewer's frame, and their rays.
struct OcclusionRow {
  const PixelPoints* points;
  int x, y;   // of the first
  int count;  // of points; normals and results are padded to a multiple of kOcclusionLanes
  const float *normal_right, *normal_up, *normal_into;
  const std::vector<Ray>* rays;
  float radius;   // mm; surfaces beyond it do not count
  float* result;  // 0 open to 1 closed
};
inline constexpr int kOcclusionLanes = 16;

/// The fraction of the sky that surfaces within the radius hide from each point.
void occlusion_of(const OcclusionRow& row);

}  // namespace kerf::rendering
