// Projects and fills triangles. Bands of rows are independent, so the picture does not depend on the number
// of threads.
#include "sim/render/render_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace kerf::rendering {
namespace {

/// Edge function of a triangle, positive inside. A sample exactly on an edge belongs to only one of its two
/// triangles, so that each surface covers a sample once.
struct Edge {
  double a, b, c;
  Edge(const ScreenVertex& p, const ScreenVertex& q)
      : a(static_cast<double>(p.y) - q.y),
        b(static_cast<double>(q.x) - p.x),
        c(static_cast<double>(p.x) * q.y - static_cast<double>(p.y) * q.x) {}
  double at(double x, double y) const { return a * x + b * y + c; }
  bool owns(double value) const {
    return value > 0.0 || (value == 0.0 && (a > 0.0 || (a == 0.0 && b > 0.0)));
  }
};

/// Rows of a picture.
struct Band {
  int width, first, last;
};

/// Calls visit(x, y, depth) for each sample of a band that a triangle covers, if the triangle is clockwise in
/// the picture (y downwards), that is, seen from outside.
template <class Visit>
void for_each_sample(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, const Band& band,
                     const Visit& visit) {
  const float low_x = std::min({p.x, q.x, r.x}), high_x = std::max({p.x, q.x, r.x});
  const float low_y = std::min({p.y, q.y, r.y}), high_y = std::max({p.y, q.y, r.y});
  const int y_first = std::max(band.first, static_cast<int>(std::ceil(low_y - 0.5f)));
  const int y_last = std::min(band.last - 1, static_cast<int>(std::floor(high_y - 0.5f)));
  const int x_first = std::max(0, static_cast<int>(std::ceil(low_x - 0.5f)));
  const int x_last = std::min(band.width - 1, static_cast<int>(std::floor(high_x - 0.5f)));
  if (y_first > y_last || x_first > x_last) return;
  const Edge pq(q, p), qr(r, q), rp(p, r);
  const double area = pq.at(r.x, r.y);
  if (!(area > 0.0)) return;
  for (int y = y_first; y <= y_last; ++y) {
    for (int x = x_first; x <= x_last; ++x) {
      const double sx = x + 0.5, sy = y + 0.5;
      const double wr = pq.at(sx, sy), wp = qr.at(sx, sy), wq = rp.at(sx, sy);
      if (!pq.owns(wr) || !qr.owns(wp) || !rp.owns(wq)) continue;
      visit(x, y, static_cast<float>((wp * p.z + wq * q.z + wr * r.z) / area));
    }
  }
}

/// Calls visit(number, p, q, r) for each triangle.
template <class Visit>
void for_each_triangle(const Mesh& mesh, const std::vector<ScreenVertex>& vertices, const Visit& visit) {
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3)
    visit(static_cast<std::uint32_t>(t / 3), vertices[mesh.triangles[t]], vertices[mesh.triangles[t + 1]],
          vertices[mesh.triangles[t + 2]]);
}

/// The nearest of the faces towards the viewer at each sample of a band.
void draw_faces(const Mesh& mesh, const std::vector<ScreenVertex>& vertices, const std::optional<Cut>& cut,
                const Band& band, Target& target) {
  for_each_triangle(
      mesh, vertices,
      [&](std::uint32_t number, const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
        for_each_sample(p, q, r, band, [&](int x, int y, float depth) {
          const std::size_t at = target.index(x, y);
          if (depth >= target.depth[at] || (cut && cut->removes(x + 0.5, y + 0.5, depth))) return;
          target.depth[at] = depth;
          if (!target.triangle.empty()) target.triangle[at] = number;
        });
      });
}

/// The cut face in a band: a point of the plane is inside the material if the line of sight behind it leaves
/// the mesh more often than it enters it.
void draw_cut_face(const Mesh& mesh, const std::vector<ScreenVertex>& vertices, const Cut& cut,
                   const Band& band, Target& target) {
  const std::size_t from = target.index(0, band.first), samples = target.index(0, band.last) - from;
  std::vector<std::int16_t> left(samples);
  for_each_triangle(mesh, vertices,
                    [&](std::uint32_t, const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
                      const auto count = [&](std::int16_t change) {
                        return [&, change](int x, int y, float depth) {
                          if (cut.removes(x + 0.5, y + 0.5, depth)) return;
                          std::int16_t& sum = left[target.index(x, y) - from];
                          sum = static_cast<std::int16_t>(sum + change);
                        };
                      };
                      for_each_sample(p, q, r, band, count(-1));
                      for_each_sample(p, r, q, band, count(1));
                    });
  for (int y = band.first; y < band.last; ++y) {
    for (int x = 0; x < band.width; ++x) {
      const std::size_t at = target.index(x, y);
      if (left[at - from] <= 0) continue;
      target.depth[at] = static_cast<float>(cut.depth_at(x + 0.5, y + 0.5));
      if (!target.triangle.empty()) target.triangle[at] = kCutFace;
    }
  }
}

}  // namespace

void Projection::fit(const Mesh& mesh, const std::optional<CutPlane>& section, int width, int height,
                     double margin) {
  scale = 1.0;
  x0 = y0 = 0.0;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  double left = kFar, right_side = -kFar, top = kFar, bottom = -kFar;
  for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3) {
    const Point3 corner{mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]};
    const Point3 p = project(section ? section->kept(corner) : corner);
    left = std::min(left, p.x);
    right_side = std::max(right_side, p.x);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  const double room = 1.0 - 2.0 * margin;
  const double tiny = 1e-9;  // mm: a mesh without width in the picture keeps a finite scale
  scale = std::min(room * width / std::max(right_side - left, tiny),
                   room * height / std::max(bottom - top, tiny));
  x0 = width / 2.0 - scale * (left + right_side) / 2;
  y0 = height / 2.0 - scale * (top + bottom) / 2;
}

std::vector<ScreenVertex> project_all(const Mesh& mesh, const Projection& projection) {
  std::vector<ScreenVertex> vertices(mesh.positions.size() / 3);
  in_bands(static_cast<int>(vertices.size()), [&](int first, int end) {
    for (int v = first; v < end; ++v) {
      const Point3 p = projection.project(vertex(mesh, static_cast<std::uint32_t>(v)));
      vertices[static_cast<std::size_t>(v)] = {static_cast<float>(p.x), static_cast<float>(p.y),
                                               static_cast<float>(p.z)};
    }
  });
  return vertices;
}

Cut::Cut(const CutPlane& plane, const Projection& projection) {
  const double above = plane.at - dot(plane.normal, projection.centre);
  x_ = dot(plane.normal, projection.right) / projection.scale;
  y_ = -dot(plane.normal, projection.up) / projection.scale;
  depth_ = dot(plane.normal, projection.into) + projection.nearness * above;
  constant_ = -above - x_ * projection.x0 - y_ * projection.y0;
}

void draw(const Mesh& mesh, const std::vector<ScreenVertex>& vertices, const std::optional<Cut>& cut,
          Target& target) {
  in_bands(target.height, [&](int first, int last) {
    const Band band{target.width, first, last};
    draw_faces(mesh, vertices, cut, band, target);
    if (cut && cut->is_before()) draw_cut_face(mesh, vertices, *cut, band, target);
  });
}

void in_bands(int count, const std::function<void(int, int)>& work) {
  const unsigned bands = thread_count(0);
  const auto bound = [&](std::size_t n) {
    return static_cast<int>(std::int64_t{count} * static_cast<std::int64_t>(n) / bands);
  };
  parallel_for(
      bands, bands, [&](std::size_t n) { work(bound(n), bound(n + 1)); }, [] { return false; });
}

}  // namespace kerf::rendering
