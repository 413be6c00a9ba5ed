// The renderer's lower half: projections, and triangles into a depth buffer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "kerf/geometry.h"
#include "kerf/render.h"

namespace kerf::rendering {

inline constexpr std::uint32_t kNothing = 0xffffffffu;
inline constexpr std::uint32_t kCutFace = 0xfffffffeu;  // in the place of a triangle: the face of a section
inline constexpr float kFarDepth = 3.0e38f;

/// What a section leaves out: all p with dot(normal, p) above `at`.
struct CutPlane {
  Point3 normal;  // unit vector
  double at = 0.0;
  /// The nearest point that is not left out.
  Point3 kept(Point3 p) const { return p - std::max(0.0, dot(normal, p) - at) * normal; }
};

/// From mm to samples of a picture and back. Mildly perspective, or parallel where `nearness` is 0. Depth is
/// affine over the picture for plane faces in both cases.
struct Projection {
  Point3 centre;           // mm
  Point3 right, up, into;  // unit vectors of the picture; into: away from the viewer
  double nearness = 0.0;   // 1 over the viewer's distance from the centre, 1/mm
  double scale = 1.0;      // samples a mm at the centre
  double x0 = 0.0, y0 = 0.0;

  /// x, y in samples from the upper left, z the depth.
  Point3 project(Point3 p) const {
    const Point3 d = p - centre;
    const double depth = dot(d, into), w = 1.0 + nearness * depth;
    return {x0 + scale * dot(d, right) / w, y0 - scale * dot(d, up) / w, depth / w};
  }
  Point3 point(double x, double y, double depth) const {
    const double far = depth / (1.0 - nearness * depth), w = 1.0 + nearness * far;
    return centre + (x - x0) * w / scale * right + (y0 - y) * w / scale * up + far * into;
  }
  /// Places and scales the picture so that what a section leaves of the mesh fills `width` x `height` samples
  /// but for a margin (share of it).
  void fit(const Mesh& mesh, const std::optional<CutPlane>& section, int width, int height, double margin);
};

/// A section's plane in a picture, where it is a plane as well.
class Cut {
 public:
  Cut(const CutPlane& plane, const Projection& projection);
  bool leaves_out(double x, double y, double depth) const {
    return x_ * x + y_ * y + depth_ * depth + constant_ > 0.0;
  }
  /// Whether what is left out lies before the plane, not behind it.
  bool is_before() const { return depth_ < 0.0; }
  /// Depth of the plane at a sample, where it is_before.
  double depth_at(double x, double y) const { return -(x_ * x + y_ * y + constant_) / depth_; }

 private:
  double x_, y_, depth_, constant_;
};

/// A vertex in the picture.
struct ScreenVertex {
  float x, y, z;
};

/// Depth and the number of the triangle seen at each sample; `triangle` is left empty for a depth-only
/// target.
struct Target {
  int width = 0, height = 0;
  std::vector<float> depth;
  std::vector<std::uint32_t> triangle;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

std::vector<ScreenVertex> project_all(const Mesh& mesh, const Projection& projection);
/// Draws the triangles that face the viewer, but for what `cut` leaves out, and the cut's face as kCutFace.
void draw(const Mesh& mesh, const std::vector<ScreenVertex>& vertices, const std::optional<Cut>& cut,
          Target& target);
/// Calls work(begin, end) for bands of 0 to count, on as many threads as there are.
void in_bands(int count, const std::function<void(int, int)>& work);

inline Point3 vertex(const Mesh& mesh, std::uint32_t v) {
  const float* p = mesh.positions.data() + std::size_t{3} * v;
  return {p[0], p[1], p[2]};
}

}  // namespace kerf::rendering
