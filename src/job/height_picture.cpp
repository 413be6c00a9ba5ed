// Pictures of measured surfaces.
#include "job/height_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <vector>

#include "base/number.h"
#include "codec/picture/image_files.h"

namespace kerf {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr int kPixels = 900;    // of the longer side
constexpr int kCells = 90;      // of the SVG's longer side
constexpr double kRoom = 0.08;  // around the points, of the longer side
constexpr Colour kLow{38, 84, 190}, kMean{245, 245, 240}, kHigh{190, 40, 38}, kRing{255, 0, 220};

/// The part of the plane that is shown, and its colours.
struct Frame {
  explicit Frame(const MeasuredSurface& s) : surface(s), area(s.map.bounds()) {
    const double longer = std::max({area.high.x - area.low.x, area.high.y - area.low.y, 1e-3});
    room = kRoom * longer;
    area.low = area.low - Point2{room, room};
    area.high = area.high + Point2{room, room};
    side = longer + 2.0 * room;
    lowest = highest = s.points[0].z;
    for (const Point3& p : s.points) lowest = std::min(lowest, p.z), highest = std::max(highest, p.z);
  }
  Colour colour(Point2 at) const {
    const double range = highest - lowest;
    const double u = range > 0.0 ? std::clamp((surface.map.at(at) - lowest) / range, 0.0, 1.0) : 0.5;
    const Colour &from = u < 0.5 ? kLow : kMean, &to = u < 0.5 ? kMean : kHigh;
    const double t = u < 0.5 ? 2.0 * u : 2.0 * u - 1.0;
    Colour out{};
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = static_cast<std::uint8_t>(std::lround(from[k] + t * (to[k] - from[k])));
    return out;
  }
  int count_x(int longer) const {
    return std::max(1, int(std::lround(longer * (area.high.x - area.low.x) / side)));
  }
  int count_y(int longer) const {
    return std::max(1, int(std::lround(longer * (area.high.y - area.low.y) / side)));
  }
  bool is_outlier(std::size_t i) const {
    return std::binary_search(surface.outliers.begin(), surface.outliers.end(), i);
  }

  const MeasuredSurface& surface;
  Box2 area;
  double room = 0.0, side = 1.0, lowest = 0.0, highest = 0.0;
};

}  // namespace

std::string height_png(const MeasuredSurface& surface) {
  const Frame frame(surface);
  const int width = frame.count_x(kPixels), height = frame.count_y(kPixels);
  const double pixel = frame.side / kPixels;
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 255);
  const auto set = [&](int x, int y, const Colour& c) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const std::size_t at =
        (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 4;
    std::copy(c.begin(), c.end(), rgba.begin() + static_cast<std::ptrdiff_t>(at));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      set(x, y, frame.colour({frame.area.low.x + (x + 0.5) * pixel, frame.area.high.y - (y + 0.5) * pixel}));
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Point3& p = surface.points[i];
    const int cx = int((p.x - frame.area.low.x) / pixel), cy = int((frame.area.high.y - p.y) / pixel);
    const int reach = frame.is_outlier(i) ? 12 : 2;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        const double d = std::hypot(dx, dy);
        if (d <= 2.5) set(cx + dx, cy + dy, {20, 20, 20});
        if (reach > 2 && d > 8.0 && d <= 12.0) set(cx + dx, cy + dy, kRing);
      }
  }
  return write_png({width, height, rgba});
}

std::string height_svg(const MeasuredSurface& surface) {
  const Frame frame(surface);
  const auto n = [](double v) { return number_text(v, 4); };
  const double w = frame.area.high.x - frame.area.low.x, h = frame.area.high.y - frame.area.low.y;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 {0} {1}\">\n",
      n(w), n(h));
  const double cell = frame.side / kCells;
  for (int y = 0; y < frame.count_y(kCells); ++y)
    for (int x = 0; x < frame.count_x(kCells); ++x) {
      const Colour c =
          frame.colour({frame.area.low.x + (x + 0.5) * cell, frame.area.high.y - (y + 0.5) * cell});
      out +=
          fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#{:02x}{:02x}{:02x}\"/>\n",
                      n(x * cell), n(y * cell), n(cell * 1.02), n(cell * 1.02), c[0], c[1], c[2]);
    }
  const double text = frame.room / 3.0;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Point3& p = surface.points[i];
    const double x = p.x - frame.area.low.x, y = frame.area.high.y - p.y;
    out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", n(x), n(y), n(text / 6.0));
    if (frame.is_outlier(i))
      out += fmt::format(
          "<circle class=\"outlier\" cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"#ff00dc\" "
          "stroke-width=\"{}\"/>\n",
          n(x), n(y), n(text), n(text / 4.0));
    out += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\">{}</text>\n", n(x + text / 4.0),
                       n(y - text / 4.0), n(text), number_text(p.z, 3));
  }
  return out + "</svg>\n";
}

}  // namespace kerf
