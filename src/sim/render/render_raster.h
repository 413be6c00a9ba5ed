// Rasterisation for the renderer: projections, and triangles into a depth buffer.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/huge_pages.h"
#include "base/parallel.h"

#include "kerf/geom/geometry.h"
#include "kerf/sim/render.h"

namespace kerf::rendering {

inline constexpr std::uint32_t kNothing = 0xffffffffu;
inline constexpr std::uint32_t kCutFace = 0xfffffffeu;  // instead of a triangle: the cut face of a section
inline constexpr float kFarDepth = 3.0e38f;

/// A section removes all p with dot(normal, p) > at.
struct CutPlane {
  Point3 normal;  // unit vector
  double at = 0.0;
  /// The nearest point that is not removed.
  Point3 kept(Point3 p) const { return p - std::max(0.0, dot(normal, p) - at) * normal; }
};

/// From mm to samples of a picture and back. A perspective projection, or a parallel one if `nearness` is 0.
/// Over a plane face, depth is an affine function of x and y in both cases.
struct Projection {
  Point3 centre;           // mm
  Point3 right, up, into;  // unit vectors of the picture; into: away from the viewer
  double nearness = 0.0;   // 1 / distance of the viewer from the centre, 1/mm
  double scale = 1.0;      // samples per mm at the centre
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
  /// Positions and scales the picture so that the mesh, after the section, and `room` fill `width` x `height`
  /// samples except for a margin, a fraction of the picture.
  void fit(const Mesh& mesh, const std::optional<CutPlane>& section, std::span<const Point3> room, int width,
           int height, double margin);
};

/// The plane of a section in picture coordinates (x, y, depth), where it is a plane as well.
class Cut {
 public:
  Cut(const CutPlane& plane, const Projection& projection);
  bool removes(double x, double y, double depth) const {
    return x_ * x + y_ * y + depth_ * depth + constant_ > 0.0;
  }
  /// Whether the removed side is between the viewer and the plane.
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

/// Rows of samples.
struct Rows {
  int first, last;  // last: excluded
};

/// Depth and number of the visible triangle at each sample of some rows; `triangle` is empty for a depth-only
/// target.
struct Target {
  int width = 0;
  Rows rows{0, 0};
  std::vector<float> depth;
  std::vector<std::uint32_t> triangle;
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - rows.first) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Fills a large vector.
template <class T>
void fill(std::vector<T>& list, std::size_t size, T value) {
  if (list.capacity() < size) {
    list = {};
    list.reserve(size);
    prepare_pages(list.data(), size * sizeof(T), thread_count(0));
  }
  list.assign(size, value);
}

/// A mesh in a picture, drawn in bands of rows that do not depend on each other.
class Drawing {
 public:
  /// Bands have `extra` more rows at both ends, within the picture.
  Drawing(const Mesh& mesh, const Projection& projection, const std::optional<CutPlane>& section, int width,
          int height, int extra);

  std::size_t bands() const { return bands_; }
  /// The rows of a band, without these.
  Rows rows(std::size_t band) const;
  Rows rows_with_extra(std::size_t band) const;
  /// Draws the triangles that face the viewer, except for what the section removes, and the cut face as
  /// kCutFace, into a target that has the rows of the band.
  void draw(std::size_t band, Target& target) const;
  const std::vector<ScreenVertex>& vertices() const { return vertices_; }

 private:
  struct Corners {
    const ScreenVertex &p, &q, &r;
  };
  Corners corners(std::uint32_t t) const {
    const std::uint32_t* v = mesh_.triangles.data() + std::size_t{3} * t;
    return {vertices_[v[0]], vertices_[v[1]], vertices_[v[2]]};
  }
  bool has_cut_face() const { return cut_ && cut_->is_before(); }
  void project_vertices(const Projection& projection);
  void sort_into_bands();
  template <class Visit>
  void for_each(std::size_t band, const Visit& visit) const;
  void draw_faces(std::size_t band, Target& target, Rows rows) const;
  void draw_cut_face(std::size_t band, Target& target, Rows rows) const;

  const Mesh& mesh_;
  std::optional<Cut> cut_;
  int width_, height_, extra_;
  std::size_t bands_, pieces_ = 0;
  std::vector<ScreenVertex> vertices_;
  std::vector<std::vector<std::uint32_t>>
      lists_;  // per piece of the mesh and band: its triangles in their order
};

/// Draws lines over a picture of `samples` samples along a pixel's side.
void draw_lines(const PictureLines& lines, const Projection& eye, int samples, Image& image);
/// Calls work(first, end) for bands of 0 to count, on all threads.
void in_bands(int count, const std::function<void(int, int)>& work);

inline Point3 vertex(const Mesh& mesh, std::uint32_t v) {
  const float* p = mesh.positions.data() + std::size_t{3} * v;
  return {p[0], p[1], p[2]};
}

}  // namespace kerf::rendering
