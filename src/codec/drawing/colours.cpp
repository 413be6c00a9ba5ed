// AutoCAD's colour indices as red, green and blue.
#include <algorithm>
#include <cmath>

#include "kerf/drawing/drawing_files.h"

namespace kerf {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

std::uint8_t byte_of(double fraction) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(fraction, 0.0, 1.0)));
}

/// Fraction of red (offset 0), green (8) or blue (4) in a hue given in twelfths of the circle.
double fraction_of(double hue, double offset) {
  const double k = std::fmod(offset + hue, 12.0);
  return std::clamp(std::abs(k / 2.0 - 3.0) - 1.0, 0.0, 1.0);
}

}  // namespace

std::array<std::uint8_t, 3> colour_of_index(int index) {
  static constexpr Rgb kNamed[] = {{0, 0, 0},       {255, 0, 0},    {255, 255, 0}, {0, 255, 0},
                                   {0, 255, 255},   {0, 0, 255},    {255, 0, 255}, {0, 0, 0},
                                   {128, 128, 128}, {192, 192, 192}};
  static constexpr double kGreys[] = {0.2, 0.36, 0.52, 0.68, 0.84, 1.0};
  static constexpr double kValues[] = {1.0, 0.65, 0.5, 0.3, 0.15};
  if (index < 0 || index > 255) return kNamed[7];
  if (index < 10) return kNamed[static_cast<std::size_t>(index)];
  if (index >= 250) {
    const std::uint8_t grey = byte_of(kGreys[static_cast<std::size_t>(index - 250)]);
    return {grey, grey, grey};
  }
  // 24 hues of ten shades each: five values, at full and at half saturation.
  const double hue = (index / 10 - 1) * 0.5;
  const double value = kValues[static_cast<std::size_t>(index % 10 / 2)];
  const double white = index % 2 == 0 ? 0.0 : 0.5;
  const auto mixed = [&](double offset) {
    return byte_of(value * (white + (1.0 - white) * fraction_of(hue, offset)));
  };
  return {mixed(0.0), mixed(8.0), mixed(4.0)};
}

}  // namespace kerf
