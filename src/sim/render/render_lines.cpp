// Lines over a picture. Each of the two layers has the largest coverage of its lines at a pixel, so that
// lines drawn many times look as those drawn once.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "sim/render/render_raster.h"

namespace kerf::rendering {
namespace {

constexpr double kThick = 1.6, kThin = 1.0;  // pixels, at a picture of kUsualSide
constexpr double kThinOpacity = 0.6;
constexpr double kUsualSide = 1000.0;  // pixels
constexpr double kNearest = 0.05;      // of the viewer's distance; closer points are not drawn

/// Coverage and colour of each pixel.
struct Layer {
  std::vector<std::uint8_t> coverage;
  std::vector<std::array<std::uint8_t, 3>> colour;
};

struct Segment {
  double x0, y0, x1, y1;  // pixels
};

/// Cuts a segment to the picture and a margin; false if nothing is left.
bool clip(Segment& s, double width, double height, double margin) {
  double first = 0.0, last = 1.0;
  const double dx = s.x1 - s.x0, dy = s.y1 - s.y0;
  const auto side = [&](double way, double room) {  // way * t <= room
    if (way == 0.0) return room >= 0.0;
    const double t = room / way;
    if (way < 0.0)
      first = std::max(first, t);
    else
      last = std::min(last, t);
    return first <= last;
  };
  if (!side(-dx, s.x0 + margin) || !side(dx, width + margin - s.x0) || !side(-dy, s.y0 + margin) ||
      !side(dy, height + margin - s.y0))
    return false;
  s = {s.x0 + first * dx, s.y0 + first * dy, s.x0 + last * dx, s.y0 + last * dy};
  return true;
}

class LinePainter {
 public:
  LinePainter(const Projection& eye, int samples, Image& image)
      : eye_(eye),
        per_pixel_(1.0 / samples),
        image_(image),
        scale_(std::max(0.6, std::min(image.width, image.height) / kUsualSide)) {
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (Layer& layer : layers_) {
      layer.coverage.assign(pixels, 0);
      layer.colour.assign(pixels, {});
    }
  }

  void add(const PictureLine& line) {
    const double half = 0.5 * scale_ * (line.is_thin ? kThin : kThick);
    if (line.on_picture) {
      Segment s{line.from.x, line.from.y, line.to.x, line.to.y};
      if (clip(s, image_.width, image_.height, half + 1.0)) draw(s, half, line.colour, layers_[1]);
      return;
    }
    const bool visible = 1.0 + eye_.nearness * dot(line.from - eye_.centre, eye_.into) > kNearest &&
                         1.0 + eye_.nearness * dot(line.to - eye_.centre, eye_.into) > kNearest;
    if (!visible) return;
    const Point3 a = eye_.project(line.from), b = eye_.project(line.to);
    Segment s{a.x * per_pixel_, a.y * per_pixel_, b.x * per_pixel_, b.y * per_pixel_};
    if (!clip(s, image_.width, image_.height, half + 1.0)) return;
    draw(s, half, line.colour, layers_[line.is_thin ? 0 : 1]);
  }

  void blend() {
    for (std::size_t layer = 0; layer < 2; ++layer) {
      const double opacity = layer == 0 ? kThinOpacity : 1.0;
      for (std::size_t p = 0; p < layers_[layer].coverage.size(); ++p) {
        const double cover = opacity * layers_[layer].coverage[p] / 255.0;
        if (cover == 0.0) continue;
        for (std::size_t c = 0; c < 3; ++c) {
          std::uint8_t& out = image_.rgba[4 * p + c];
          out = static_cast<std::uint8_t>(
              std::lround((1.0 - cover) * out + cover * layers_[layer].colour[p][c]));
        }
      }
    }
  }

 private:
  /// Walks along the longer side of a segment; each pixel beside it gets its coverage by the distance.
  void draw(const Segment& s, double half, const std::array<std::uint8_t, 3>& colour, Layer& layer) {
    const double dx = s.x1 - s.x0, dy = s.y1 - s.y0, length = std::hypot(dx, dy);
    const bool steep = std::abs(dy) > std::abs(dx);
    const double along = steep ? std::abs(dy) : std::abs(dx);
    const double reach = (half + 0.5) * (along > 0.0 ? length / along : 1.0);
    const double low = std::min(steep ? s.y0 : s.x0, steep ? s.y1 : s.x1) - half;
    const double high = std::max(steep ? s.y0 : s.x0, steep ? s.y1 : s.x1) + half;
    for (int u = static_cast<int>(std::floor(low)); u <= static_cast<int>(std::floor(high)); ++u) {
      const double start = steep ? s.y0 : s.x0, way = steep ? dy : dx;
      const double t = way == 0.0 ? 0.0 : std::clamp((u + 0.5 - start) / way, 0.0, 1.0);
      const double v = steep ? s.x0 + t * dx : s.y0 + t * dy;
      for (int w = static_cast<int>(std::floor(v - reach)); w <= static_cast<int>(std::floor(v + reach)); ++w)
        cover(steep ? w : u, steep ? u : w, s, half, colour, layer);
    }
  }

  void cover(int x, int y, const Segment& s, double half, const std::array<std::uint8_t, 3>& colour,
             Layer& layer) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    const double dx = s.x1 - s.x0, dy = s.y1 - s.y0, square = dx * dx + dy * dy;
    const double px = x + 0.5 - s.x0, py = y + 0.5 - s.y0;
    const double t = square > 0.0 ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0) : 0.0;
    const double distance = std::hypot(px - t * dx, py - t * dy);
    const double covered = std::clamp(half + 0.5 - distance, 0.0, 1.0);
    const auto value = static_cast<std::uint8_t>(std::lround(255.0 * covered));
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(x);
    if (value == 0 || value < layer.coverage[at]) return;
    layer.coverage[at] = value;
    layer.colour[at] = colour;
  }

  const Projection& eye_;
  double per_pixel_;
  Image& image_;
  double scale_;
  std::array<Layer, 2> layers_;  // thin lines, others
};

}  // namespace

void draw_lines(const PictureLines& lines, const Projection& eye, int samples, Image& image) {
  LinePainter painter(eye, samples, image);
  lines([&](const PictureLine& line) { painter.add(line); });
  painter.blend();
}

}  // namespace kerf::rendering
