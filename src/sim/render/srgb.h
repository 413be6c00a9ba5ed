// The sRGB curve in both directions, from tables.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "sim/render/scene.h"

namespace kerf::rendering {

class Srgb {
 public:
  Srgb() {
    for (std::size_t b = 0; b < 256; ++b) linear_[b] = curve(static_cast<double>(b));
    for (std::size_t b = 1; b < 256; ++b) lowest_[b] = curve(static_cast<double>(b) - 0.5);
    for (std::size_t k = 0, b = 0; k < first_.size(); ++k) {
      while (b < 255 && lowest_[b + 1] <= static_cast<double>(k) / kBins) ++b;
      first_[k] = static_cast<std::uint8_t>(b);
    }
  }
  Colour linear(const std::array<std::uint8_t, 3>& c) const {
    return {linear_[c[0]], linear_[c[1]], linear_[c[2]]};
  }
  /// The nearest byte.
  std::uint8_t encoded(double value) const {
    const double v = std::clamp(value, 0.0, 1.0);
    std::size_t b = first_[static_cast<std::size_t>(v * kBins)];
    while (b < 255 && lowest_[b + 1] <= v) ++b;
    return static_cast<std::uint8_t>(b);
  }

 private:
  static constexpr double kBins = 4096.0;
  static double curve(double byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  }
  std::array<double, 256> linear_{}, lowest_{};  // lowest_: the smallest value of each byte
  std::array<std::uint8_t, 4097> first_{};       // the byte of the lower end of each bin
};

}  // namespace kerf::rendering
