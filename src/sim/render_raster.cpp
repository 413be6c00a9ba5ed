// Projects and fills triangles. Bands of rows are independent, so the picture is the same for any number of
// threads.
#include "sim/render_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/parallel.h"

namespace kerf::rendering {
namespace {

/// A triangle's edge functions: inside where all three are positive or zero.
struct Edge {
  double a, b, c;
  Edge(const Spot& p, const Spot& q)
      : a(static_cast<double>(p.y) - q.y),
        b(static_cast<double>(q.x) - p.x),
        c(static_cast<double>(p.x) * q.y - static_cast<double>(p.y) * q.x) {}
  double at(double x, double y) const { return a * x + b * y + c; }
};

void fill(const Spot& p, const Spot& q, const Spot& r, std::uint32_t number, Target& target, int first,
          int last) {
  const float low_x = std::min({p.x, q.x, r.x}), high_x = std::max({p.x, q.x, r.x});
  const float low_y = std::min({p.y, q.y, r.y}), high_y = std::max({p.y, q.y, r.y});
  const int y_begin = std::max(first, static_cast<int>(std::ceil(low_y - 0.5f)));
  const int y_end = std::min(last - 1, static_cast<int>(std::floor(high_y - 0.5f)));
  const int x_begin = std::max(0, static_cast<int>(std::ceil(low_x - 0.5f)));
  const int x_end = std::min(target.width - 1, static_cast<int>(std::floor(high_x - 0.5f)));
  if (y_begin > y_end || x_begin > x_end) return;
  // The picture's y points down: faces seen from outside turn clockwise there.
  const Edge pq(q, p), qr(r, q), rp(p, r);
  const double area = pq.at(r.x, r.y);
  if (!(area > 0.0)) return;
  for (int y = y_begin; y <= y_end; ++y) {
    for (int x = x_begin; x <= x_end; ++x) {
      const double sx = x + 0.5, sy = y + 0.5;
      const double wr = pq.at(sx, sy), wp = qr.at(sx, sy), wq = rp.at(sx, sy);
      if (wr < 0.0 || wp < 0.0 || wq < 0.0) continue;
      const auto depth = static_cast<float>((wp * p.z + wq * q.z + wr * r.z) / area);
      const std::size_t at = target.index(x, y);
      if (depth >= target.depth[at]) continue;
      target.depth[at] = depth;
      if (!target.triangle.empty()) target.triangle[at] = number;
    }
  }
}

}  // namespace

void Projection::fit(const Mesh& mesh, int width, int height, double margin) {
  scale = 1.0;
  x0 = y0 = 0.0;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  double left = kFar, right_side = -kFar, top = kFar, bottom = -kFar;
  for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3) {
    const Point3 p = project({mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]});
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

std::vector<Spot> project_all(const Mesh& mesh, const Projection& projection) {
  std::vector<Spot> spots(mesh.positions.size() / 3);
  in_bands(static_cast<int>(spots.size()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const Point3 p = projection.project(vertex(mesh, static_cast<std::uint32_t>(v)));
      spots[static_cast<std::size_t>(v)] = {static_cast<float>(p.x), static_cast<float>(p.y),
                                            static_cast<float>(p.z)};
    }
  });
  return spots;
}

void draw(const Mesh& mesh, const std::vector<Spot>& spots, Target& target) {
  in_bands(target.height, [&](int first, int last) {
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const Spot& p = spots[mesh.triangles[t]];
      const Spot& q = spots[mesh.triangles[t + 1]];
      const Spot& r = spots[mesh.triangles[t + 2]];
      fill(p, q, r, static_cast<std::uint32_t>(t / 3), target, first, last);
    }
  });
}

void in_bands(int count, const std::function<void(int, int)>& work) {
  const unsigned bands = sim::thread_count(0);
  const auto bound = [&](std::size_t n) {
    return static_cast<int>(std::int64_t{count} * static_cast<std::int64_t>(n) / bands);
  };
  sim::parallel_for(
      bands, bands, [&](std::size_t n) { work(bound(n), bound(n + 1)); }, [] { return false; });
}

}  // namespace kerf::rendering
