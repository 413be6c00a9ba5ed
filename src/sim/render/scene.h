// What a picture shows and how its parts are seen: shared by all steps of drawing it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "sim/render/render_raster.h"

namespace kerf::rendering {

using Colour = Point3;  // linear light, 0 to 1

struct Scene {
  const Mesh& mesh;
  std::span<const std::array<std::uint8_t, 3>> colours;  // one per triangle, sRGB
  int width, height;                                     // pixels
  int fine;                                              // samples along a pixel's side
  Box3 box = {};
  double size = 1.0;  // of the box's diagonal, mm
  bool ground = false;
  Projection eye = {};
  std::optional<CutPlane> section = {};
};

inline Point3 unit(Point3 a) {
  const double n = length(a);
  return n > 0.0 ? (1.0 / n) * a : Point3{0, 0, 1};
}

/// A unit vector in eight bytes.
struct alignas(8) PackedNormal {
  std::array<std::int16_t, 4> n{};  // the last is 0
  static PackedNormal of(Point3 v) {
    const auto pack = [](double c) {
      const double scaled = 32767.0 * std::clamp(c, -1.0, 1.0);
      return static_cast<std::int16_t>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);  // the nearest
    };
    return {{pack(v.x), pack(v.y), pack(v.z), 0}};
  }
  Point3 get() const {
    constexpr double kStep = 1.0 / 32767.0;
    return {kStep * n[0], kStep * n[1], kStep * n[2]};
  }
  bool operator==(const PackedNormal& other) const {
    return std::memcmp(&n, &other.n, sizeof n) == 0;  // libc++ 13 has no std::bit_cast
  }
};

}  // namespace kerf::rendering
