// Projects and fills triangles. Bands of rows are independent, so the picture does not depend on the number
// of threads.
#include "sim/render/render_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// The samples of some rows.
struct Band {
  int width;
  Rows rows;
};

/// Rows of samples in a band.
constexpr int kBandRows = 32;

// Without the calls of the library's functions for processors that lack an instruction.
int rounded_up(float v) {
  const int below = static_cast<int>(v);
  return below + (static_cast<float>(below) < v ? 1 : 0);
}
int rounded_down(float v) {
  const int above = static_cast<int>(v);
  return above - (static_cast<float>(above) > v ? 1 : 0);
}

/// The samples within the box around a triangle; empty if no sample is.
struct Window {
  int x_first, x_last, y_first, y_last;
  Window(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, const Band& band)
      : x_first(std::max(0, rounded_up(std::min({p.x, q.x, r.x}) - 0.5f))),
        x_last(std::min(band.width - 1, rounded_down(std::max({p.x, q.x, r.x}) - 0.5f))),
        y_first(std::max(band.rows.first, rounded_up(std::min({p.y, q.y, r.y}) - 0.5f))),
        y_last(std::min(band.rows.last - 1, rounded_down(std::max({p.y, q.y, r.y}) - 0.5f))) {}
  bool empty() const { return y_first > y_last || x_first > x_last; }
};

/// Triangles of fewer samples across are tested sample by sample.
constexpr int kWide = 6;

/// The part of a row on the inner side of an edge, and up to a sample more.
class RowSpan {
 public:
  explicit RowSpan(const Edge& edge) : a_(edge.a) {
    const double per_a = a_ != 0.0 ? -1.0 / a_ : 0.0;
    by_y_ = edge.b * per_a;
    at_0_ = edge.c * per_a - 0.5;
  }
  void limit(double y, int& first, int& last) const {
    if (a_ == 0.0) return;
    const double x = std::clamp(at_0_ + by_y_ * y, first - 2.0, last + 2.0);
    constexpr int kShift = 2;  // x + kShift is not negative
    const int before = static_cast<int>(x + kShift) - kShift;
    if (a_ > 0.0)
      first = std::max(first, before);
    else
      last = std::min(last, before + 1);
  }

 private:
  double a_, by_y_, at_0_;
};

/// Calls visit(x, y, depth) for each sample of a band that a triangle covers, if the triangle is clockwise in
/// the picture (y downwards), that is, seen from outside.
template <class Visit>
void for_each_sample(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, const Band& band,
                     const Visit& visit) {
  const Window window(p, q, r, band);
  if (window.empty()) return;
  const Edge pq(q, p), qr(r, q), rp(p, r);
  const double area = pq.at(r.x, r.y);
  if (!(area > 0.0)) return;
  // The depth is an affine function; rounding must not exceed the depths of the corners.
  const double zp = p.z / area, zq = q.z / area, zr = r.z / area;
  const double by_x = qr.a * zp + rp.a * zq + pq.a * zr, by_y = qr.b * zp + rp.b * zq + pq.b * zr;
  const double at_p = p.z - by_x * p.x - by_y * p.y;
  const double nearest = std::min({p.z, q.z, r.z}), furthest = std::max({p.z, q.z, r.z});
  const bool is_wide = window.x_last - window.x_first >= kWide;
  std::optional<std::array<RowSpan, 3>> spans;
  if (is_wide) spans.emplace(std::array{RowSpan(pq), RowSpan(qr), RowSpan(rp)});
  for (int y = window.y_first; y <= window.y_last; ++y) {
    const double sy = y + 0.5;
    int first = window.x_first, last = window.x_last;
    if (spans)
      for (const RowSpan& span : *spans) span.limit(sy, first, last);
    const auto covers = [&](int x) {
      const double sx = x + 0.5;
      return pq.owns(pq.at(sx, sy)) && qr.owns(qr.at(sx, sy)) && rp.owns(rp.at(sx, sy));
    };
    // The samples of a row that are covered follow each other.
    while (first <= last && !covers(first)) ++first;
    while (first <= last && !covers(last)) --last;
    for (int x = first; x <= last; ++x)
      visit(x, y, static_cast<float>(std::clamp(at_p + by_x * (x + 0.5) + by_y * sy, nearest, furthest)));
  }
}

}  // namespace

void Projection::fit(const Mesh& mesh, const std::optional<CutPlane>& section, std::span<const Point3> room,
                     int width, int height, double margin) {
  scale = 1.0;
  x0 = y0 = 0.0;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  double left = kFar, right_side = -kFar, top = kFar, bottom = -kFar;
  const auto include = [&](const Point3& p) {
    left = std::min(left, p.x);
    right_side = std::max(right_side, p.x);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  };
  for (std::size_t k = 0; k + 2 < mesh.positions.size(); k += 3) {
    const Point3 corner{mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]};
    include(project(section ? section->kept(corner) : corner));
  }
  for (const Point3& point : room) include(project(point));
  const double inside = 1.0 - 2.0 * margin;
  const double tiny = 1e-9;  // mm: a mesh without width in the picture keeps a finite scale
  scale = std::min(inside * width / std::max(right_side - left, tiny),
                   inside * height / std::max(bottom - top, tiny));
  x0 = width / 2.0 - scale * (left + right_side) / 2;
  y0 = height / 2.0 - scale * (top + bottom) / 2;
}

Cut::Cut(const CutPlane& plane, const Projection& projection) {
  const double above = plane.at - dot(plane.normal, projection.centre);
  x_ = dot(plane.normal, projection.right) / projection.scale;
  y_ = -dot(plane.normal, projection.up) / projection.scale;
  depth_ = dot(plane.normal, projection.into) + projection.nearness * above;
  constant_ = -above - x_ * projection.x0 - y_ * projection.y0;
}

Drawing::Drawing(const Mesh& mesh, const Projection& projection, const std::optional<CutPlane>& section,
                 int width, int height, int extra)
    : mesh_(mesh),
      width_(width),
      height_(height),
      extra_(extra),
      bands_(static_cast<std::size_t>((height + kBandRows - 1) / kBandRows)) {
  if (section) cut_.emplace(*section, projection);
  project_vertices(projection);
  sort_into_bands();
}

void Drawing::project_vertices(const Projection& projection) {
  fill(vertices_, mesh_.positions.size() / 3, {});
  in_bands(static_cast<int>(vertices_.size()), [&](int first, int end) {
    for (int v = first; v < end; ++v) {
      const Point3 p = projection.project(vertex(mesh_, static_cast<std::uint32_t>(v)));
      vertices_[static_cast<std::size_t>(v)] = {static_cast<float>(p.x), static_cast<float>(p.y),
                                                static_cast<float>(p.z)};
    }
  });
}

/// Omits triangles without samples and, unless back faces are needed for the cut face, those not seen from
/// outside.
void Drawing::sort_into_bands() {
  constexpr std::size_t kAtATime = 1 << 14;
  const std::size_t count = mesh_.triangles.size() / 3;
  pieces_ = (count + kAtATime - 1) / kAtATime;
  lists_.resize(pieces_ * bands_);
  const Band whole{width_, {0, height_}};
  const bool backs = has_cut_face();
  const auto work = [&](std::size_t piece) {
    for (std::size_t t = piece * kAtATime; t < std::min(count, (piece + 1) * kAtATime); ++t) {
      const auto& [p, q, r] = corners(static_cast<std::uint32_t>(t));
      const Window window(p, q, r, whole);
      if (window.empty() || (!backs && !(Edge(q, p).at(r.x, r.y) > 0.0))) continue;
      const int first = std::max(0, window.y_first - extra_) / kBandRows;
      const int last = std::min(height_ - 1, window.y_last + extra_) / kBandRows;
      for (int band = first; band <= last; ++band)
        lists_[piece * bands_ + static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(t));
    }
  };
  parallel_for(thread_count(0), pieces_, work, [] { return false; });
}

Rows Drawing::rows(std::size_t band) const {
  const int first = static_cast<int>(band) * kBandRows;
  return {first, std::min(first + kBandRows, height_)};
}

Rows Drawing::rows_with_extra(std::size_t band) const {
  const Rows own = rows(band);
  return {std::max(0, own.first - extra_), std::min(height_, own.last + extra_)};
}

/// Calls visit(number, p, q, r) for each triangle of a band.
template <class Visit>
void Drawing::for_each(std::size_t band, const Visit& visit) const {
  for (std::size_t piece = 0; piece < pieces_; ++piece)
    for (const std::uint32_t t : lists_[piece * bands_ + band]) {
      const auto& [p, q, r] = corners(t);
      visit(t, p, q, r);
    }
}

/// The nearest of the faces towards the viewer at each sample.
void Drawing::draw_faces(std::size_t band, Target& target, Rows rows) const {
  for_each(band,
           [&](std::uint32_t number, const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
             for_each_sample(p, q, r, {width_, rows}, [&](int x, int y, float depth) {
               const std::size_t at = target.index(x, y);
               if (depth >= target.depth[at] || (cut_ && cut_->removes(x + 0.5, y + 0.5, depth))) return;
               target.depth[at] = depth;
               if (!target.triangle.empty()) target.triangle[at] = number;
             });
           });
}

/// The cut face: a point of the plane is inside the material if the line of sight behind it leaves the mesh
/// more often than it enters it.
void Drawing::draw_cut_face(std::size_t band, Target& target, Rows rows) const {
  const std::size_t from = target.index(0, rows.first), samples = target.index(0, rows.last) - from;
  std::vector<std::int16_t> left(samples);
  for_each(band, [&](std::uint32_t, const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
    const auto count = [&](std::int16_t change) {
      return [&, change](int x, int y, float depth) {
        if (cut_->removes(x + 0.5, y + 0.5, depth)) return;
        std::int16_t& sum = left[target.index(x, y) - from];
        sum = static_cast<std::int16_t>(sum + change);
      };
    };
    for_each_sample(p, q, r, {width_, rows}, count(-1));
    for_each_sample(p, r, q, {width_, rows}, count(1));
  });
  for (int y = rows.first; y < rows.last; ++y) {
    for (int x = 0; x < width_; ++x) {
      const std::size_t at = target.index(x, y);
      if (left[at - from] <= 0) continue;
      target.depth[at] = static_cast<float>(cut_->depth_at(x + 0.5, y + 0.5));
      if (!target.triangle.empty()) target.triangle[at] = kCutFace;
    }
  }
}

void Drawing::draw(std::size_t band, Target& target) const {
  const Rows rows = rows_with_extra(band);
  draw_faces(band, target, rows);
  if (has_cut_face()) draw_cut_face(band, target, rows);
}

void in_bands(int count, const std::function<void(int, int)>& work) {
  constexpr unsigned kBandsPerThread = 8;  // as some take longer than others
  const unsigned threads = thread_count(0), bands = threads > 1 ? threads * kBandsPerThread : 1;
  const auto bound = [&](std::size_t n) {
    return static_cast<int>(std::int64_t{count} * static_cast<std::int64_t>(n) / bands);
  };
  parallel_for(
      threads, bands, [&](std::size_t n) { work(bound(n), bound(n + 1)); }, [] { return false; });
}

}  // namespace kerf::rendering
