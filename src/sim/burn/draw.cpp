// The picture of a burn from above.
#include <algorithm>
#include <array>
#include <cmath>

#include "kerf/base/limits.h"
#include "kerf/sim/burn.h"

namespace kerf {
namespace {

using Colour = std::array<double, 3>;
// The board, scorched, charred: sRGB at 0, half and all of the energy that is black.
constexpr std::array<Colour, 3> kScorch{{{238, 222, 190}, {140, 84, 36}, {18, 12, 8}}};

Colour colour_of(double fraction) {
  const double at = 2.0 * std::clamp(fraction, 0.0, 1.0);
  const std::size_t k = at < 1.0 ? 0 : 1;
  const double t = at - static_cast<double>(k);
  Colour mixed{};
  for (std::size_t c = 0; c < 3; ++c) mixed[c] = (1.0 - t) * kScorch[k][c] + t * kScorch[k + 1][c];
  return mixed;
}

/// The mean of the cells between two positions of each axis, in cells, not empty.
double mean(const BurnMap& map, double x0, double x1, double y0, double y1) {
  const auto last = [](double end, int first, int count) {
    return std::clamp(static_cast<int>(std::ceil(end)), first + 1, std::max(count, first + 1));
  };
  const int ix = std::clamp(static_cast<int>(x0), 0, map.nx - 1),
            iy = std::clamp(static_cast<int>(y0), 0, map.ny - 1);
  const int ex = last(x1, ix, map.nx), ey = last(y1, iy, map.ny);
  double sum = 0.0;
  for (int y = iy; y < ey; ++y)
    for (int x = ix; x < ex; ++x)
      sum += static_cast<double>(
          map.joules_per_mm2[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.nx) +
                             static_cast<std::size_t>(x)]);
  return sum / (static_cast<double>(ex - ix) * (ey - iy));
}

}  // namespace

Image draw_burn(const BurnMap& map, double black, int width, int height) {
  Image image;
  image.width = std::clamp(width, 1, limits::kMaxPictureSide);
  image.height = std::clamp(height, 1, limits::kMaxPictureSide);
  image.rgba.assign(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4, 255);
  const double full = black > 0.0 ? black : map.usual_highest;
  // Cells per pixel, the same in both directions, and the first cell of the picture's lower left corner.
  const double scale =
      std::max(static_cast<double>(map.nx) / image.width, static_cast<double>(map.ny) / image.height);
  const double left = 0.5 * (map.nx - scale * image.width), low = 0.5 * (map.ny - scale * image.height);
  std::size_t at = 0;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column, at += 4) {
      const double x = left + scale * column, y = low + scale * (image.height - 1 - row);
      const bool inside = x + scale > 0.0 && y + scale > 0.0 && x < map.nx && y < map.ny;
      const double energy = inside ? mean(map, x, x + scale, y, y + scale) : 0.0;
      const Colour colour = colour_of(full > 0.0 ? energy / full : 0.0);
      for (std::size_t c = 0; c < 3; ++c)
        image.rgba[at + c] = static_cast<std::uint8_t>(std::lround(colour[c]));
    }
  return image;
}

}  // namespace kerf
