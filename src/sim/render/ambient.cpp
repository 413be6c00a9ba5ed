// Rays from each point in a pattern of 4 x 4 sets, which a mean over as many points removes.
#include "sim/render/ambient.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::rendering {
namespace {

constexpr double kOcclusionRadius = 0.05;  // as a fraction of the part's size

}  // namespace

Ambient::Ambient(const Scene& scene)
    : scene_(scene),
      points_(scene.width, scene.height, reach()),
      blurred_((scene.width + 1) / 2, (scene.height + 1) / 2),
      normals_(blurred_.values.size()) {}

double Ambient::radius_in_pixels() const {
  return kOcclusionRadius * scene_.size * scene_.eye.scale / scene_.fine;
}

/// The maximum distance in pixels from which points are read.
int Ambient::reach() const { return static_cast<int>(std::max(radius_in_pixels(), 1.0 + kSteps)) + 2; }

void Ambient::set(int x, int y, float depth, const PackedNormal& normal) {
  if (x % 2 == 0 && y % 2 == 0) normals_[blurred_.index(x / 2, y / 2)] = normal;
  if (depth >= kFarDepth) return;
  const Projection& eye = scene_.eye;
  const double far = depth / (1.0 - eye.nearness * depth), w = (1.0 + eye.nearness * far) / eye.scale;
  points_.set(x, y, static_cast<float>((x * scene_.fine + 0.5 - eye.x0) * w),
              static_cast<float>((eye.y0 - y * scene_.fine - 0.5) * w), static_cast<float>(far));
}

/// Pixel offsets around a point, for one cell of a 4 x 4 pattern of rotations and lengths that the blur
/// averages out.
std::vector<Ray> Ambient::rays_of(int cell) const {
  const double reach = radius_in_pixels();
  const double turn = (cell * 7 % 16) / 16.0, stretch = (cell * 11 % 16 + 0.5) / 16.0;
  std::vector<Ray> rays(kDirections);
  for (int d = 0; d < kDirections; ++d) {
    const double angle = 2 * std::numbers::pi * (d + turn) / kDirections;
    for (int s = 0; s < kSteps; ++s) {
      const double fraction = (s + stretch) / kSteps, far = std::max(reach * fraction * fraction, 1.0 + s);
      rays[static_cast<std::size_t>(d)][static_cast<std::size_t>(s)] = {
          static_cast<int>(std::lround(std::cos(angle) * far)),
          static_cast<int>(std::lround(std::sin(angle) * far))};
    }
  }
  return rays;
}

/// The occlusion of every fourth point of a coarse row, from `cell` on.
void Ambient::occlude_line(int y, int cell, const std::vector<Ray>& rays, OcclusionLine& line,
                           Coarse& result) const {
  const Projection& eye = scene_.eye;
  int count = 0;
  for (int x = cell; x < result.columns; x += kPattern, ++count) {
    const Point3 normal = normals_[result.index(x, y)].get();
    const auto n = static_cast<std::size_t>(count);
    line.right[n] = static_cast<float>(dot(normal, eye.right));
    line.up[n] = static_cast<float>(dot(normal, eye.up));
    line.into[n] = static_cast<float>(dot(normal, eye.into));
  }
  static_assert(2 * kPattern == PixelPoints::kStride);
  occlusion_of({&points_, 2 * cell, 2 * y, count, line.right.data(), line.up.data(), line.into.data(), &rays,
                static_cast<float>(kOcclusionRadius * scene_.size), line.result.data()});
  for (int n = 0; n < count; ++n)
    result.at(cell + kPattern * n, y) = line.result[static_cast<std::size_t>(n)];
}

void Ambient::compute() {
  std::vector<std::vector<Ray>> rays;
  for (int cell = 0; cell < 16; ++cell) rays.push_back(rays_of(cell));
  Coarse raw(blurred_.columns, blurred_.rows);
  in_bands(raw.rows, [&](int first, int last) {
    OcclusionLine line(raw.columns);
    for (int y = first; y < last; ++y)
      for (int cell = 0; cell < kPattern; ++cell)
        occlude_line(y, cell, rays[static_cast<std::size_t>(cell + kPattern * (y % kPattern))], line, raw);
  });
  in_bands(raw.rows, [&](int first, int last) {  // over 4 x 4 values, which removes the pattern of rays_of
    for (int y = first; y < last; ++y)
      for (int x = 0; x < raw.columns; ++x)
        blurred_.at(x, y) = mean(raw, points_.into(2 * x, 2 * y), {x - 2, y - 2}, {x + 2, y + 2});
  });
}

float Ambient::closed(int x, int y) const {
  return mean(blurred_, points_.into(x, y), {x / 2, y / 2}, {(x + 1) / 2 + 1, (y + 1) / 2 + 1});
}

/// The mean of the values from `low` to `high` whose surface has about the same depth.
float Ambient::mean(const Coarse& values, float depth, Offset low, Offset high) const {
  const int last_x = std::min(values.columns, high.x), last_y = std::min(values.rows, high.y);
  float largest = 0.0f;
  for (int y = std::max(0, low.y); y < last_y; ++y)
    for (int x = std::max(0, low.x); x < last_x; ++x) largest = std::max(largest, values.at(x, y));
  if (largest == 0.0f || depth >= kFarDepth) return 0.0f;
  const auto near = static_cast<float>(0.01 * scene_.size);
  float sum = 0.0f;
  int count = 0;
  for (int y = std::max(0, low.y); y < last_y; ++y) {
    for (int x = std::max(0, low.x); x < last_x; ++x) {
      if (std::abs(points_.into(2 * x, 2 * y) - depth) > near) continue;
      sum += values.at(x, y);
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<float>(count) : values.at(low.x, low.y);
}

}  // namespace kerf::rendering
