// The lights' directions follow the viewer; shadows are those of a depth map seen from the key light.
#include "sim/render/lights.h"

#include <cmath>

namespace kerf::rendering {
namespace {

constexpr int kShadowSize = 2048;                   // samples along a side of the shadow map
constexpr Colour kMissingColour{0.45, 0.45, 0.45};  // of triangles without a colour
constexpr std::array<std::uint8_t, 3> kSkyTop{250, 251, 252}, kSkyLow{222, 226, 230};  // background, sRGB

Colour times(Colour a, Colour b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

/// From the left; from the front in side views, from behind in top views, as is usual in drawings: a pocket
/// lit from below looks like a boss.
Lights::Lights(const Scene& scene, const View& view)
    : scene_(scene),
      sky_top_(srgb_.linear(kSkyTop)),
      sky_low_(srgb_.linear(kSkyLow)),
      section_colour_(srgb_.linear(kSectionColour)) {
  const double a = view.azimuth.rad();
  const Point3 ahead{-std::sin(a), std::cos(a), 0};
  const double above = std::clamp((-scene.eye.into.z - 0.8) / 0.15, 0.0, 1.0);
  light_ = unit(-0.62 * scene.eye.right + (0.95 * above - 0.42) * ahead + Point3{0, 0, 0.95});
  fill_ = unit(0.75 * scene.eye.right - 0.45 * ahead + Point3{0, 0, 0.35});
  half_ = unit(light_ - scene.eye.into);
  sun_.centre = scene.eye.centre;
  sun_.into = -1.0 * light_;
  sun_.right = unit(cross(sun_.into, std::abs(light_.z) > 0.9 ? Point3{0, 1, 0} : Point3{0, 0, 1}));
  sun_.up = cross(sun_.right, sun_.into);
  sun_.fit(scene.mesh, scene.section, {}, kShadowSize, kShadowSize, 0.01);
}

void Lights::draw_shadows() {
  shadow_.width = kShadowSize;
  shadow_.rows = {0, kShadowSize};
  fill(shadow_.depth, std::size_t{kShadowSize} * kShadowSize, kFarDepth);
  const Drawing drawing(scene_.mesh, sun_, scene_.section, kShadowSize, kShadowSize, 0);
  parallel_for(
      thread_count(0), drawing.bands(), [&](std::size_t band) { drawing.draw(band, shadow_); },
      [] { return false; });
}

/// Fraction of the key light that reaches a point, from 5 x 5 samples of the shadow map around it.
double Lights::lit_fraction(Point3 p, Point3 normal) const {
  const double texel = 1.0 / sun_.scale;
  const Point3 q = sun_.project(p + 2.5 * texel * normal);
  constexpr int kOutside = 3;         // samples beyond the map: nothing is in shadow there
  const auto sample = [](double v) {  // rounded down
    return static_cast<int>(std::clamp(v + kOutside, 0.0, kShadowSize + 2.0 * kOutside)) - kOutside;
  };
  const int cx = sample(q.x), cy = sample(q.y);
  const auto lit = [&](int x, int y) {
    return x < 0 || y < 0 || x >= kShadowSize || y >= kShadowSize ||
                   shadow_.depth[shadow_.index(x, y)] > q.z - texel
               ? 1
               : 0;
  };
  const int outer =
      lit(cx - 2, cy - 2) + lit(cx + 2, cy - 2) + lit(cx - 2, cy + 2) + lit(cx + 2, cy + 2) + lit(cx, cy);
  if (outer == 0 || outer == 5) return outer / 5.0;  // not at a shadow's edge
  int sum = 0;
  for (int y = cy - 2; y <= cy + 2; ++y)
    for (int x = cx - 2; x <= cx + 2; ++x) sum += lit(x, y);
  return sum / 25.0;
}

Colour Lights::background(int sample_row) const {
  const double t = static_cast<double>(sample_row) / std::max(1, scene_.height * scene_.fine - 1);
  return (1.0 - t) * sky_top_ + t * sky_low_;
}

Tone Lights::tone(const Sample& sample, double x, double y) const {
  return tone(sample.triangle, static_cast<double>(sample.depth), sample.normal.get(), x, y);
}

Tone Lights::tone(std::uint32_t triangle, double depth, Point3 n, double x, double y) const {
  if (triangle == kCutFace) return {section_colour_, {}};
  const double facing = dot(n, light_);
  const double lit = facing > 0.0 ? lit_fraction(scene_.eye.point(x, y, depth), n) : 0.0;
  if (triangle == kNothing) {
    const Colour ground = background(static_cast<int>(y));
    return {(1.0 - 0.28 * (1.0 - lit)) * ground, 0.3 * ground};
  }
  const Colour albedo =
      triangle < scene_.colours.size() ? srgb_.linear(scene_.colours[triangle]) : kMissingColour;
  const double up = 0.5 + 0.5 * n.z;
  const Colour key = (0.85 * std::max(0.0, facing) * lit) * Colour{1.03, 1.0, 0.95};
  const Colour fill = (0.16 * std::max(0.0, dot(n, fill_))) * Colour{0.95, 0.98, 1.05};
  const Colour sky = (0.36 * up) * Colour{0.97, 1.0, 1.04};
  const Colour bounce = (0.16 * (1.0 - up)) * Colour{1.05, 1.0, 0.94};
  const Colour around = fill + sky + bounce;
  const double mirror = dot(n, half_);
  const double m4 = mirror * mirror * mirror * mirror, m12 = m4 * m4 * m4;
  const double shine = lit > 0.0 && mirror > 0.7 ? 0.08 * lit * m12 * m12 * m4 : 0.0;
  return {times(albedo, key + around) + Colour{shine, shine, shine},
          times(albedo, 0.25 * key + 0.9 * around)};
}

}  // namespace kerf::rendering
