// Renders a mesh to an image in software. First the depth buffer, then the shading of each sample: a key
// light with shadows, a fill light, sky light with ambient occlusion, thin lines at silhouettes and creases,
// on a light ground.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "sim/render/occlusion.h"
#include "sim/render/render_raster.h"

#include "kerf/limits.h"

namespace kerf {
namespace rendering {
namespace {

using Colour = Point3;  // linear light, 0 to 1

constexpr double kMargin = 0.06;           // around the part, as a fraction of the picture
constexpr double kViewDistance = 3.6;      // from the viewer to the centre, in radii of the part
constexpr int kShadowSize = 2048;          // samples along a side of the shadow map
constexpr double kOcclusionRadius = 0.05;  // of ambient occlusion, as a fraction of the part's size
constexpr double kSmoothCosine = 0.82;     // faces at smaller angles (35 degrees) are shaded as one surface
constexpr double kFlatCosine = 0.999999;   // a face with vertex normals at smaller angles has one normal
constexpr double kCreaseCosine = 0.6;      // faces at larger angles are separated by a line
constexpr double kPlainCosine = 0.99;      // a pixel of samples at smaller angles is shaded once
constexpr double kLineJump = 0.012;  // larger steps in depth have a line, as a fraction of the part's size
constexpr Colour kMissingColour{0.45, 0.45, 0.45};  // of triangles without a colour
constexpr std::array<std::uint8_t, 3> kSkyTop{250, 251, 252}, kSkyLow{222, 226, 230};  // background, sRGB

/// The sRGB curve in both directions, from tables.
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

Point3 unit(Point3 a) {
  const double n = length(a);
  return n > 0.0 ? (1.0 / n) * a : Point3{0, 0, 1};
}

Colour times(Colour a, Colour b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// A unit vector in six bytes.
struct PackedNormal {
  std::array<std::int16_t, 3> n{};
  static PackedNormal of(Point3 v) {
    const auto pack = [](double c) {
      const double scaled = 32767.0 * std::clamp(c, -1.0, 1.0);
      return static_cast<std::int16_t>(scaled < 0.0 ? scaled - 0.5 : scaled + 0.5);  // the nearest
    };
    return {{pack(v.x), pack(v.y), pack(v.z)}};
  }
  Point3 get() const {
    constexpr double kStep = 1.0 / 32767.0;
    return {kStep * n[0], kStep * n[1], kStep * n[2]};
  }
};

/// The surface at a point of the picture.
struct Seen {
  Point3 at, normal;       // work coordinates
  std::uint32_t triangle;  // or kNothing: the ground
  double occlusion;
};

class Painter {
 public:
  Painter(const Mesh& mesh, std::span<const std::array<std::uint8_t, 3>> colours, const View& view);
  Image paint();
  const Projection& eye() const { return eye_; }
  int samples() const { return fine_; }

 private:
  enum Differs : std::uint8_t { with_right = 1, with_lower = 2 };
  struct Offset {
    int x, y;
  };

  void aim(const View& view, double radius);
  void set_section(const Section& section);
  std::optional<Cut> cut_in(const Projection& projection) const {
    return section_ ? std::optional<Cut>(Cut(*section_, projection)) : std::nullopt;
  }
  void draw_shadows();
  void smooth_normals();
  float ground_depth(const Cut& plane, int x, int y) const;
  void add_ground_and_normals();
  /// The normals of a triangle at the samples of the picture, before they are scaled to length 1.
  struct NormalField {
    PackedNormal packed;  // of a flat one
    bool is_flat = true;
    Point3 origin, dx, dy;
    PackedNormal at(double x, double y) const {
      return is_flat ? packed : PackedNormal::of(unit(origin + x * dx + y * dy));
    }
  };
  NormalField normals_of(std::uint32_t triangle) const;
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void locate_pixels();
  std::vector<Ray> rays_of(int cell) const;
  /// A value for every second pixel in both directions.
  struct Coarse {
    int columns, rows;
    std::vector<float> values;
    Coarse(int nx, int ny)
        : columns(nx), rows(ny), values(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny)) {}
    std::size_t index(int x, int y) const {
      return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
    }
    float& at(int x, int y) { return values[index(x, y)]; }
    float at(int x, int y) const { return values[index(x, y)]; }
  };
  /// Normals and results of every fourth point of a coarse row.
  struct OcclusionLine {
    std::vector<float> right, up, into, result;
    explicit OcclusionLine(int columns) {
      for (std::vector<float>* list : {&right, &up, &into, &result})
        list->resize(static_cast<std::size_t>(columns / kPattern + 1 + kOcclusionLanes));
    }
  };
  double occlusion_radius_in_pixels() const { return kOcclusionRadius * size_ * eye_.scale / fine_; }
  int occlusion_reach() const {
    return static_cast<int>(std::max(occlusion_radius_in_pixels(), 1.0 + kSteps)) + 2;
  }
  void occlude_line(int y, int cell, const std::vector<Ray>& rays, OcclusionLine& line, Coarse& result) const;
  void occlude();
  float mean_occlusion(const Coarse& values, float depth, Offset low, Offset high) const;
  bool differ(std::size_t a, std::size_t b) const;
  void compare_neighbours();
  bool is_plain(int x, int y) const;
  double lit_fraction(Point3 p, Point3 normal) const;
  double line_at(int x, int y) const;
  Colour shade(const Seen& seen, int y) const;
  Colour sample(int x, int y) const;
  Colour plain_pixel(int x, int y) const;
  Colour background(int y) const;
  void paint_row(int y, std::uint8_t* rgba) const;

  const Srgb srgb_;
  const Colour sky_top_ = srgb_.linear(kSkyTop), sky_low_ = srgb_.linear(kSkyLow);
  const Mesh& mesh_;
  std::span<const std::array<std::uint8_t, 3>> colours_;
  int width_, height_, fine_;  // pixels; samples along a pixel's side
  Box3 box_;
  double size_ = 1.0;
  bool ground_ = false;
  Projection eye_, sun_;
  Point3 fill_, half_;  // half_: of a mirror that reflects the sun towards the viewer
  std::optional<CutPlane> section_;
  Target seen_, shadow_;
  std::vector<ScreenVertex> screen_;
  std::vector<std::array<float, 3>> vertex_normals_;
  std::vector<PackedNormal> normals_;
  std::vector<std::uint8_t> differs_;  // per sample: the neighbours that it must not be averaged with
  PixelPoints points_;
  std::vector<float> occlusion_;  // per pixel, 0 open to 1 closed
};

Painter::Painter(const Mesh& mesh, std::span<const std::array<std::uint8_t, 3>> colours, const View& view)
    : mesh_(mesh),
      colours_(colours),
      width_(std::clamp(view.width, 1, limits::kMaxPictureSide)),
      height_(std::clamp(view.height, 1, limits::kMaxPictureSide)),
      fine_(static_cast<std::int64_t>(width_) * height_ > 4096 * 4096 ? 1 : 2) {
  for (std::size_t v = 0; 3 * v + 2 < mesh.positions.size(); ++v)
    box_.add(vertex(mesh, static_cast<std::uint32_t>(v)));
  if (box_.empty()) return;
  size_ = length(box_.size());
  aim(view, size_ / 2);
}

/// Sets up the viewer and the lights. Views along an axis use a parallel projection, so that they are true to
/// scale.
void Painter::aim(const View& view, double radius) {
  const double a = view.azimuth.rad(),
               e = std::clamp(view.elevation.rad(), -std::numbers::pi / 2, std::numbers::pi / 2);
  const Point3 ahead{-std::sin(a), std::cos(a), 0};
  eye_.centre = 0.5 * (box_.low + box_.high);
  eye_.right = {std::cos(a), std::sin(a), 0};
  eye_.into = view_direction(view);
  eye_.up = cross(eye_.right, eye_.into);
  const bool square_on = std::abs(std::cos(e)) < 1e-6 || std::abs(std::sin(e)) < 1e-6;
  eye_.nearness = square_on || radius <= 0.0 ? 0.0 : 1.0 / (kViewDistance * radius);
  if (view.section && faces(view, *view.section)) set_section(*view.section);
  eye_.fit(mesh_, section_, width_ * fine_, height_ * fine_, kMargin);
  ground_ = std::sin(e) > 0.1;

  // From the left; from the front in side views, from behind in top views, as is usual in drawings: a pocket
  // lit from below looks like a boss.
  const double above = std::clamp((std::sin(e) - 0.8) / 0.15, 0.0, 1.0);
  const Point3 light = unit(-0.62 * eye_.right + (0.95 * above - 0.42) * ahead + Point3{0, 0, 0.95});
  fill_ = unit(0.75 * eye_.right - 0.45 * ahead + Point3{0, 0, 0.35});
  sun_.centre = eye_.centre;
  sun_.into = -1.0 * light;
  half_ = unit(light - eye_.into);
  sun_.right = unit(cross(sun_.into, std::abs(light.z) > 0.9 ? Point3{0, 1, 0} : Point3{0, 0, 1}));
  sun_.up = cross(sun_.right, sun_.into);
  sun_.fit(mesh_, section_, kShadowSize, kShadowSize, 0.01);
}

/// Removes the viewer's side of the plane.
void Painter::set_section(const Section& section) {
  CutPlane plane{normal_axis(section), section.at};
  if (!Cut(plane, eye_).is_before()) plane = {-1.0 * plane.normal, -plane.at};
  plane.at -= kSectionOffset;
  section_ = plane;
}

void Painter::draw_shadows() {
  shadow_.width = shadow_.height = kShadowSize;
  fill(shadow_.depth, std::size_t{kShadowSize} * kShadowSize, kFarDepth);
  draw(mesh_, project_all(mesh_, sun_), cut_in(sun_), shadow_);
}

/// One normal per vertex, the mean of its faces weighted by area.
void Painter::smooth_normals() {
  fill(vertex_normals_, mesh_.positions.size() / 3, {});
  for (std::size_t t = 0; t + 2 < mesh_.triangles.size(); t += 3) {
    const Point3 a = vertex(mesh_, mesh_.triangles[t]);
    const Point3 n =
        cross(vertex(mesh_, mesh_.triangles[t + 1]) - a, vertex(mesh_, mesh_.triangles[t + 2]) - a);
    for (std::size_t k = 0; k < 3; ++k) {
      auto& sum = vertex_normals_[mesh_.triangles[t + k]];
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += static_cast<float>(n[static_cast<int>(axis)]);
    }
  }
  for (auto& n : vertex_normals_) {
    const Point3 u = unit({n[0], n[1], n[2]});
    n = {static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
  }
}

/// Of a triangle: interpolated between those of its vertices that are close to the face's.
Painter::NormalField Painter::normals_of(std::uint32_t triangle) const {
  const std::uint32_t* v = mesh_.triangles.data() + std::size_t{3} * triangle;
  const Point3 a = vertex(mesh_, v[0]);
  const Point3 face = unit(cross(vertex(mesh_, v[1]) - a, vertex(mesh_, v[2]) - a));
  const ScreenVertex &p = screen_[v[0]], &q = screen_[v[1]], &r = screen_[v[2]];
  const double qx = static_cast<double>(q.x) - p.x, qy = static_cast<double>(q.y) - p.y;
  const double rx = static_cast<double>(r.x) - p.x, ry = static_cast<double>(r.y) - p.y;
  const double area = qx * ry - qy * rx;
  std::array<Point3, 3> n;
  bool flat = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& mean = vertex_normals_[v[k]];
    const Point3 smooth{mean[0], mean[1], mean[2]};
    const double cosine = dot(smooth, face);
    n[k] = cosine > kSmoothCosine ? smooth : face;
    flat = flat && (cosine <= kSmoothCosine || cosine > kFlatCosine);
  }
  NormalField field;
  field.packed = PackedNormal::of(face);
  field.is_flat = flat || area == 0.0;
  if (field.is_flat) return field;
  const Point3 along_q = (1.0 / area) * (n[1] - n[0]), along_r = (1.0 / area) * (n[2] - n[0]);
  field.dx = ry * along_q - qy * along_r;
  field.dy = qx * along_r - rx * along_q;
  field.origin = n[0] - static_cast<double>(p.x) * field.dx - static_cast<double>(p.y) * field.dy;
  return field;
}

/// The depth of the ground at a sample without a surface; kFarDepth far away and above the horizon.
float Painter::ground_depth(const Cut& plane, int x, int y) const {
  const double depth = plane.depth_at(x + 0.5, y + 0.5);
  constexpr double kHorizon = 0.999;  // of the largest depth
  if (!(depth * eye_.nearness < kHorizon)) return kFarDepth;
  const bool is_far = length(eye_.point(x + 0.5, y + 0.5, depth) - eye_.centre) > 4 * size_;
  return is_far ? kFarDepth : static_cast<float>(depth);
}

void Painter::add_ground_and_normals() {
  fill(normals_, seen_.depth.size(), {});
  const Cut ground({{0, 0, 1}, box_.low.z}, eye_);
  const PackedNormal up = PackedNormal::of({0, 0, 1});
  in_bands(seen_.height, [&](int first, int last) {
    // Triangles return in the next row.
    constexpr std::uint32_t kRecent = 1024;
    std::vector<NormalField> recent(kRecent);
    std::vector<std::uint32_t> recent_triangle(kRecent, kNothing);
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < seen_.width; ++x) {
        const std::size_t at = seen_.index(x, y);
        const std::uint32_t triangle = seen_.triangle[at];
        if (triangle == kCutFace) {
          normals_[at] = PackedNormal::of(section_->normal);
        } else if (triangle == kNothing) {
          normals_[at] = up;
          if (ground_) seen_.depth[at] = ground_depth(ground, x, y);
        } else {
          NormalField& field = recent[triangle % kRecent];
          if (std::exchange(recent_triangle[triangle % kRecent], triangle) != triangle)
            field = normals_of(triangle);
          normals_[at] = field.at(x + 0.5, y + 0.5);
        }
      }
    }
  });
}

/// The surface point of each pixel in the viewer's frame.
void Painter::locate_pixels() {
  points_ = PixelPoints(width_, height_, occlusion_reach());
  in_bands(height_, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      for (int x = 0; x < width_; ++x) {
        const float depth = seen_.depth[seen_.index(x * fine_, y * fine_)];
        if (depth >= kFarDepth) continue;
        const double far = depth / (1.0 - eye_.nearness * depth),
                     w = (1.0 + eye_.nearness * far) / eye_.scale;
        points_.set(x, y, static_cast<float>((x * fine_ + 0.5 - eye_.x0) * w),
                    static_cast<float>((eye_.y0 - y * fine_ - 0.5) * w), static_cast<float>(far));
      }
    }
  });
}

/// Sample offsets around a pixel, for one cell of a 4 x 4 pattern of rotations and lengths that the blur
/// averages out.
std::vector<Ray> Painter::rays_of(int cell) const {
  const double reach = occlusion_radius_in_pixels();
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
void Painter::occlude_line(int y, int cell, const std::vector<Ray>& rays, OcclusionLine& line,
                           Coarse& result) const {
  int count = 0;
  for (int x = cell; x < result.columns; x += kPattern, ++count) {
    const Point3 normal = normals_[seen_.index(2 * x * fine_, 2 * y * fine_)].get();
    const auto n = static_cast<std::size_t>(count);
    line.right[n] = static_cast<float>(dot(normal, eye_.right));
    line.up[n] = static_cast<float>(dot(normal, eye_.up));
    line.into[n] = static_cast<float>(dot(normal, eye_.into));
  }
  static_assert(2 * kPattern == PixelPoints::kStride);
  occlusion_of({&points_, 2 * cell, 2 * y, count, line.right.data(), line.up.data(), line.into.data(), &rays,
                static_cast<float>(kOcclusionRadius * size_), line.result.data()});
  for (int n = 0; n < count; ++n)
    result.at(cell + kPattern * n, y) = line.result[static_cast<std::size_t>(n)];
}

/// At every second pixel in both directions: occlusion varies over much larger distances.
void Painter::occlude() {
  locate_pixels();
  std::vector<std::vector<Ray>> rays;
  for (int cell = 0; cell < 16; ++cell) rays.push_back(rays_of(cell));
  Coarse raw((width_ + 1) / 2, (height_ + 1) / 2), blurred(raw.columns, raw.rows);
  in_bands(raw.rows, [&](int first, int last) {
    OcclusionLine line(raw.columns);
    for (int y = first; y < last; ++y)
      for (int cell = 0; cell < kPattern; ++cell)
        occlude_line(y, cell, rays[static_cast<std::size_t>(cell + kPattern * (y % kPattern))], line, raw);
  });
  in_bands(raw.rows, [&](int first, int last) {  // over 4 x 4 values, which removes the pattern of rays_of
    for (int y = first; y < last; ++y)
      for (int x = 0; x < raw.columns; ++x)
        blurred.at(x, y) = mean_occlusion(raw, points_.into(2 * x, 2 * y), {x - 2, y - 2}, {x + 2, y + 2});
  });
  in_bands(height_, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < width_; ++x)
        occlusion_[pixel(x, y)] =
            mean_occlusion(blurred, points_.into(x, y), {x / 2, y / 2}, {(x + 1) / 2 + 1, (y + 1) / 2 + 1});
  });
}

/// The mean of the values from `low` to `high` whose surface has about the same depth.
float Painter::mean_occlusion(const Coarse& values, float depth, Offset low, Offset high) const {
  if (depth >= kFarDepth) return 0.0f;
  const auto near = static_cast<float>(0.01 * size_);
  float sum = 0.0f;
  int count = 0;
  for (int y = std::max(0, low.y); y < std::min(values.rows, high.y); ++y) {
    for (int x = std::max(0, low.x); x < std::min(values.columns, high.x); ++x) {
      if (std::abs(points_.into(2 * x, 2 * y) - depth) > near) continue;
      sum += values.at(x, y);
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<float>(count) : values.at(low.x, low.y);
}

/// Fraction of the key light that reaches a point, from 5 x 5 samples of the shadow map around it.
double Painter::lit_fraction(Point3 p, Point3 normal) const {
  const double texel = 1.0 / sun_.scale;
  const Point3 q = sun_.project(p + 2.5 * texel * normal);
  const int cx = static_cast<int>(std::floor(q.x)), cy = static_cast<int>(std::floor(q.y));
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

/// Brightness factor of lines at silhouettes, steps in depth and creases, by comparison with the neighbouring
/// samples; 1 without a line.
double Painter::line_at(int x, int y) const {
  const std::size_t at = seen_.index(x, y);
  if (seen_.triangle[at] == kNothing) return 1.0;
  const Point3 n = normals_[at].get();
  const Point3 p = eye_.point(x + 0.5, y + 0.5, seen_.depth[at]);
  double line = 1.0;
  for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
    const int qx = x + dx, qy = y + dy;
    if (qx < 0 || qy < 0 || qx >= seen_.width || qy >= seen_.height) continue;
    const std::size_t other = seen_.index(qx, qy);
    if (seen_.triangle[other] == kNothing) {
      line = std::min(line, 0.45);
      continue;
    }
    if ((seen_.triangle[other] == kCutFace) != (seen_.triangle[at] == kCutFace)) line = std::min(line, 0.6);
    const Point3 step = eye_.point(qx + 0.5, qy + 0.5, seen_.depth[other]) - p;
    const double jump = std::abs(dot(step, eye_.into));
    // A line on the nearer side of a step in depth that exceeds that of a steep slope.
    if (jump > kLineJump * size_ && seen_.depth[other] > seen_.depth[at]) line = std::min(line, 0.6);
    if ((dx > 0 || dy > 0) && dot(n, normals_[other].get()) < kCreaseCosine) line = std::min(line, 0.8);
  }
  return line;
}

/// Whether two neighbouring samples show different things, or have a line between them.
bool Painter::differ(std::size_t a, std::size_t b) const {
  const std::uint32_t s = seen_.triangle[a], t = seen_.triangle[b];
  // The difference of the distances of two samples is that of their depths, divided by both factors.
  const double depth_a = seen_.depth[a], depth_b = seen_.depth[b];
  if (std::abs(depth_a - depth_b) >
      kLineJump * size_ * (1.0 - eye_.nearness * depth_a) * (1.0 - eye_.nearness * depth_b))
    return true;
  if (s == t) {
    if (s == kCutFace || s == kNothing) return false;
  } else {
    if (s >= kCutFace || t >= kCutFace) return true;
    if ((s < colours_.size()) != (t < colours_.size())) return true;
    if (s < colours_.size() && colours_[s] != colours_[t]) return true;
  }
  const auto &m = normals_[a].n, &n = normals_[b].n;
  if (m[0] == n[0] && m[1] == n[1] && m[2] == n[2]) return false;
  const int cosine = (m[0] * n[0] >> 1) + (m[1] * n[1] >> 1) + (m[2] * n[2] >> 1);
  return cosine < static_cast<int>(kPlainCosine * 32767.0 * 32767.0 / 2.0);
}

void Painter::compare_neighbours() {
  fill(differs_, seen_.depth.size(), std::uint8_t{0});
  in_bands(seen_.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const bool has_lower = y + 1 < seen_.height;
      for (int x = 0; x < seen_.width; ++x) {
        const std::size_t at = seen_.index(x, y);
        const int right = x + 1 < seen_.width && differ(at, at + 1) ? with_right : 0;
        const int lower = has_lower && differ(at, seen_.index(x, y + 1)) ? with_lower : 0;
        differs_[at] = static_cast<std::uint8_t>(right | lower);
      }
    }
  });
}

/// Whether one colour suits all samples of a pixel.
bool Painter::is_plain(int x, int y) const {
  const int x0 = x * fine_, y0 = y * fine_;
  int bits = 0;
  for (int k = 0; k < fine_; ++k) {
    for (int j = 0; j < fine_; ++j) bits |= differs_[seen_.index(x0 + j, y0 + k)];
    if (x0 > 0) bits |= differs_[seen_.index(x0 - 1, y0 + k)] & with_right;
    if (y0 > 0) bits |= differs_[seen_.index(x0 + k, y0 - 1)] & with_lower;
  }
  return bits == 0;
}

Colour Painter::background(int y) const {
  const double t = static_cast<double>(y) / std::max(1, seen_.height - 1);
  return (1.0 - t) * sky_top_ + t * sky_low_;
}

/// The colour of a surface in sample row y, without lines.
Colour Painter::shade(const Seen& seen, int y) const {
  if (seen.triangle == kCutFace) return srgb_.linear(kSectionColour);
  const Point3& n = seen.normal;
  const Point3 light = -1.0 * sun_.into;
  const double closed = std::min(1.0, 1.35 * seen.occlusion);
  const double open = 1.0 - 0.9 * closed;
  const double facing = dot(n, light);
  const double lit = facing > 0.0 ? lit_fraction(seen.at, n) : 0.0;
  if (seen.triangle == kNothing) return (1.0 - (0.28 * (1.0 - lit) + 0.3 * closed)) * background(y);

  const Colour albedo =
      seen.triangle < colours_.size() ? srgb_.linear(colours_[seen.triangle]) : kMissingColour;
  const double key = 0.85 * std::max(0.0, facing) * lit * (1.0 - 0.25 * closed);
  const double fill = 0.16 * std::max(0.0, dot(n, fill_)) * open;
  const double up = 0.5 + 0.5 * n.z;
  const Colour sky = (0.36 * up * open) * Colour{0.97, 1.0, 1.04};
  const Colour bounce = (0.16 * (1.0 - up) * open) * Colour{1.05, 1.0, 0.94};
  const Colour direct = key * Colour{1.03, 1.0, 0.95} + fill * Colour{0.95, 0.98, 1.05};
  const double mirror = dot(n, half_);
  const double m4 = mirror * mirror * mirror * mirror, m12 = m4 * m4 * m4;
  const double shine = lit > 0.0 && mirror > 0.7 ? 0.08 * lit * m12 * m12 * m4 : 0.0;
  return times(albedo, direct + sky + bounce) + Colour{shine, shine, shine};
}

Colour Painter::sample(int x, int y) const {
  const std::size_t at = seen_.index(x, y);
  const std::uint32_t triangle = seen_.triangle[at];
  if (triangle == kNothing && seen_.depth[at] >= kFarDepth) return background(y);
  const Colour colour = shade({eye_.point(x + 0.5, y + 0.5, seen_.depth[at]), normals_[at].get(), triangle,
                               occlusion_[pixel(x / fine_, y / fine_)]},
                              y);
  return triangle == kNothing ? colour : line_at(x, y) * colour;
}

/// The colour of a pixel that is_plain, at its centre.
Colour Painter::plain_pixel(int x, int y) const {
  const int x0 = x * fine_, y0 = y * fine_;
  const std::size_t at = seen_.index(x0, y0);
  if (seen_.triangle[at] == kNothing && seen_.depth[at] >= kFarDepth) return background(y0);
  double depth = 0.0;
  Point3 normal{};
  for (int k = 0; k < fine_; ++k) {
    for (int j = 0; j < fine_; ++j) {
      depth += static_cast<double>(seen_.depth[seen_.index(x0 + j, y0 + k)]) / (fine_ * fine_);
      normal = normal + normals_[seen_.index(x0 + j, y0 + k)].get();
    }
  }
  return shade({eye_.point(x0 + fine_ / 2.0, y0 + fine_ / 2.0, depth), unit(normal), seen_.triangle[at],
                occlusion_[pixel(x, y)]},
               y0);
}

void Painter::paint_row(int y, std::uint8_t* rgba) const {
  const bool drawn = !differs_.empty();
  for (int x = 0; x < width_; ++x) {
    Colour colour{};
    if (!drawn || is_plain(x, y)) {
      colour = plain_pixel(x, y);
    } else {
      for (int s = 0; s < fine_ * fine_; ++s)
        colour = colour + sample(x * fine_ + s % fine_, y * fine_ + s / fine_);
      colour = (1.0 / (fine_ * fine_)) * colour;
    }
    *rgba++ = srgb_.encoded(colour.x);
    *rgba++ = srgb_.encoded(colour.y);
    *rgba++ = srgb_.encoded(colour.z);
    *rgba++ = 255;
  }
}

Image Painter::paint() {
  seen_.width = width_ * fine_;
  seen_.height = height_ * fine_;
  const std::size_t samples = static_cast<std::size_t>(seen_.width) * static_cast<std::size_t>(seen_.height);
  fill(seen_.depth, samples, kFarDepth);
  fill(seen_.triangle, samples, kNothing);
  fill(occlusion_, static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0f);
  if (!box_.empty() && finite(box_.low) && finite(box_.high)) {
    screen_ = project_all(mesh_, eye_);
    draw(mesh_, screen_, cut_in(eye_), seen_);
    draw_shadows();
    smooth_normals();
    add_ground_and_normals();
    occlude();
    compare_neighbours();
  }
  Image image{width_, height_, {}};
  image.rgba.resize(4 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  in_bands(height_, [&](int first, int last) {
    for (int y = first; y < last; ++y) paint_row(y, image.rgba.data() + 4 * pixel(0, y));
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
