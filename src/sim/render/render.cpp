// Renders a mesh to an image in software, band by band: what each sample shows, its light, thin lines at
// silhouettes and creases. Then ambient occlusion, which needs all bands.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "sim/render/ambient.h"
#include "sim/render/lights.h"
#include "sim/render/render_raster.h"
#include "sim/render/samples.h"
#include "sim/render/srgb.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace rendering {
namespace {

constexpr double kMargin = 0.06;       // around the part, as a fraction of the picture
constexpr double kViewDistance = 3.6;  // from the viewer to the centre, in radii of the part

/// Unit vector away from the viewer.
Point3 view_direction(const View& view) {
  const double a = view.azimuth.rad(),
               e = std::clamp(view.elevation.rad(), -std::numbers::pi / 2, std::numbers::pi / 2);
  return {-std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), -std::sin(e)};
}

/// A section is drawn this much behind its specified plane, mm, so that floors and walls in that plane are
/// not drawn in part. More than the error of meshes, but not visible.
constexpr double kSectionOffset = 0.01;

/// The axis perpendicular to a section.
Point3 normal_axis(const Section& section) {
  switch (section.plane) {
    case Plane::xy: return {0, 0, 1};
    case Plane::xz: return {0, 1, 0};
    case Plane::yz: break;
  }
  return {1, 0, 0};
}

/// The tone of a pixel in twelve bytes: to 1/32768, a tenth of the darkest step of sRGB.
class PackedTone {
 public:
  PackedTone() = default;
  explicit PackedTone(const Tone& tone)
      : open_{pack(tone.open.x), pack(tone.open.y), pack(tone.open.z)},
        loss_{pack(tone.loss.x), pack(tone.loss.y), pack(tone.loss.z)} {}
  /// One channel where this fraction of the sky is hidden.
  double channel(std::size_t c, double closed) const { return kStep * (open_[c] - closed * loss_[c]); }

 private:
  static constexpr double kStep = 1.0 / 32768.0;
  static std::uint16_t pack(double v) {
    return static_cast<std::uint16_t>(std::clamp(v / kStep + 0.5, 0.0, 65535.0));
  }
  std::array<std::uint16_t, 3> open_, loss_;
};

class Painter {
 public:
  Painter(const Mesh& mesh, std::span<const std::array<std::uint8_t, 3>> colours, const View& view);
  Image paint();
  const Projection& eye() const { return scene_.eye; }
  int samples() const { return scene_.fine; }

 private:
  void aim(double radius);
  void set_section(const Section& section);
  Tone plain_pixel(const Samples& samples, int x, int y) const;
  Tone pixel(const Samples& samples, int x, int y) const;
  void paint_bands(Ambient& ambient);
  void finish_row(int y, const Ambient& ambient, std::uint8_t* rgba) const;
  void paint_background(Image& image) const;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(scene_.width) + static_cast<std::size_t>(x);
  }

  const View& view_;
  Scene scene_;
  const Srgb srgb_;
  std::optional<Lights> lights_;
  std::unique_ptr<PackedTone[]> tones_;  // of each pixel
};

Painter::Painter(const Mesh& mesh, std::span<const std::array<std::uint8_t, 3>> colours, const View& view)
    : view_(view),
      scene_{mesh, colours, std::clamp(view.width, 1, limits::kMaxPictureSide),
             std::clamp(view.height, 1, limits::kMaxPictureSide), 2} {
  if (static_cast<std::int64_t>(scene_.width) * scene_.height > 4096 * 4096) scene_.fine = 1;
  for (std::size_t v = 0; 3 * v + 2 < mesh.positions.size(); ++v)
    scene_.box.add(vertex(mesh, static_cast<std::uint32_t>(v)));
  if (!scene_.box.empty()) {
    scene_.size = length(scene_.box.size());
    aim(scene_.size / 2);
  }
  lights_.emplace(scene_, view);
}

/// Sets up the viewer. Views along an axis use a parallel projection, so that they are true to scale.
void Painter::aim(double radius) {
  const double e = std::clamp(view_.elevation.rad(), -std::numbers::pi / 2, std::numbers::pi / 2);
  Projection& eye = scene_.eye;
  eye.centre = 0.5 * (scene_.box.low + scene_.box.high);
  const PictureAxes axes = picture_axes(view_);
  eye.right = axes.right;
  eye.up = axes.up;
  eye.into = axes.into;
  const bool square_on = std::abs(std::cos(e)) < 1e-6 || std::abs(std::sin(e)) < 1e-6;
  eye.nearness = square_on || radius <= 0.0 ? 0.0 : 1.0 / (kViewDistance * radius);
  if (view_.section && faces(view_, *view_.section)) set_section(*view_.section);
  eye.fit(scene_.mesh, scene_.section, view_.room, scene_.width * scene_.fine, scene_.height * scene_.fine,
          kMargin);
  scene_.ground = std::sin(e) > 0.1;
}

/// Removes the viewer's side of the plane.
void Painter::set_section(const Section& section) {
  CutPlane plane{normal_axis(section), section.at};
  if (!Cut(plane, scene_.eye).is_before()) plane = {-1.0 * plane.normal, -plane.at};
  plane.at -= kSectionOffset;
  scene_.section = plane;
}

/// The tone of a pixel that is_plain, at its centre.
Tone Painter::plain_pixel(const Samples& samples, int x, int y) const {
  const int fine = scene_.fine, x0 = x * fine, y0 = y * fine;
  const Sample first = samples.at(x0, y0);
  if (first.triangle == kNothing && first.depth >= kFarDepth) return {lights_->background(y0), {}};
  double depth = 0.0;
  Point3 normal{};
  bool is_flat = true;
  for (int k = 0; k < fine; ++k) {
    for (int j = 0; j < fine; ++j) {
      const Sample sample = samples.at(x0 + j, y0 + k);
      depth += static_cast<double>(sample.depth) / (fine * fine);
      normal = normal + sample.normal.get();
      is_flat = is_flat && sample.normal == first.normal;
    }
  }
  return lights_->tone(first.triangle, depth, is_flat ? first.normal.get() : unit(normal), x0 + fine / 2.0,
                       y0 + fine / 2.0);
}

Tone Painter::pixel(const Samples& samples, int x, int y) const {
  if (samples.is_plain(x, y)) return plain_pixel(samples, x, y);
  const int fine = scene_.fine;
  Tone sum{};
  for (int k = 0; k < fine; ++k) {
    for (int j = 0; j < fine; ++j) {
      const int sx = x * fine + j, sy = y * fine + k;
      const Sample sample = samples.at(sx, sy);
      if (sample.triangle == kNothing && sample.depth >= kFarDepth)
        sum = sum + Tone{lights_->background(sy), {}};
      else
        sum = sum + samples.line_at(sx, sy) * lights_->tone(sample, sx + 0.5, sy + 0.5);
    }
  }
  return (1.0 / (fine * fine)) * sum;
}

/// Each thread draws its bands in the same memory.
void Painter::paint_bands(Ambient& ambient) {
  const int fine = scene_.fine;
  const Drawing drawing(scene_.mesh, scene_.eye, scene_.section, scene_.width * fine, scene_.height * fine,
                        1);
  const std::vector<std::array<float, 3>> normals = smooth_normals(scene_.mesh);
  const unsigned threads = thread_count(0);
  std::atomic<std::size_t> next{0};
  const auto work = [&](std::size_t) {
    Samples samples(scene_, drawing, normals);
    for (std::size_t band = next++; band < drawing.bands(); band = next++) {
      samples.draw(band);
      const Rows rows = drawing.rows(band);
      for (int y = rows.first / fine; y < rows.last / fine; ++y) {
        for (int x = 0; x < scene_.width; ++x) {
          const Sample first = samples.at(x * fine, y * fine);
          ambient.set(x, y, first.depth, first.normal);
          tones_[index(x, y)] = PackedTone(pixel(samples, x, y));
        }
      }
    }
  };
  parallel_for(threads, threads, work, [] { return false; });
}

void Painter::finish_row(int y, const Ambient& ambient, std::uint8_t* rgba) const {
  for (int x = 0; x < scene_.width; ++x) {
    const double closed = std::min(1.0, 1.35 * static_cast<double>(ambient.closed(x, y)));
    const PackedTone& tone = tones_[index(x, y)];
    for (std::size_t c = 0; c < 3; ++c) *rgba++ = srgb_.encoded(tone.channel(c, closed));
    *rgba++ = 255;
  }
}

void Painter::paint_background(Image& image) const {
  for (int y = 0; y < scene_.height; ++y) {
    const Colour colour = lights_->background(y * scene_.fine);
    const std::array<std::uint8_t, 4> rgba{srgb_.encoded(colour.x), srgb_.encoded(colour.y),
                                           srgb_.encoded(colour.z), 255};
    for (int x = 0; x < scene_.width; ++x) std::copy(rgba.begin(), rgba.end(), &image.rgba[4 * index(x, y)]);
  }
}

Image Painter::paint() {
  const std::size_t pixels = static_cast<std::size_t>(scene_.width) * static_cast<std::size_t>(scene_.height);
  Image image{scene_.width, scene_.height, {}};
  if (scene_.box.empty() || !finite(scene_.box.low) || !finite(scene_.box.high)) {
    image.rgba.resize(4 * pixels);
    paint_background(image);
    return image;
  }
  tones_.reset(new PackedTone[pixels]);  // uninitialised; libc++ 13 has no make_unique_for_overwrite
  use_huge_pages(tones_.get(), pixels * sizeof(PackedTone));
  Ambient ambient(scene_);
  lights_->draw_shadows();
  paint_bands(ambient);
  ambient.compute();
  image.rgba.resize(4 * pixels);
  in_bands(scene_.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) finish_row(y, ambient, image.rgba.data() + 4 * index(0, y));
  });
  return image;
}

}  // namespace
}  // namespace rendering

std::optional<View> named_view(std::string_view name) {
  View view;
  const auto from = [&](double azimuth, double elevation) {
    view.azimuth = degrees(azimuth);
    view.elevation = degrees(elevation);
    return view;
  };
  if (name == "top") return from(0, 90);
  if (name == "bottom") return from(0, -90);
  if (name == "front") return from(0, 0);
  if (name == "back") return from(180, 0);
  if (name == "left") return from(-90, 0);
  if (name == "right") return from(90, 0);
  if (name == "iso") return view;
  return std::nullopt;
}

PictureAxes picture_axes(const View& view) {
  const double a = view.azimuth.rad();
  const Point3 right{std::cos(a), std::sin(a), 0}, into = rendering::view_direction(view);
  return {right, cross(right, into), into};
}

bool faces(const View& view, const Section& section) {
  constexpr double kMinSine = 0.02;  // sine of the angle between the view and the plane: about a degree
  return std::abs(dot(rendering::normal_axis(section), rendering::view_direction(view))) > kMinSine;
}

Image render(const Mesh& mesh, std::span<const std::array<std::uint8_t, 3>> colours, const View& view,
             const PictureLines& lines) {
  rendering::Painter painter(mesh, colours, view);
  Image image = painter.paint();
  if (lines) rendering::draw_lines(lines, painter.eye(), painter.samples(), image);
  return image;
}

}  // namespace kerf
