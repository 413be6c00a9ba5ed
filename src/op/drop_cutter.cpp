// Drop-cutter by cells.
#include "op/drop_cutter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace kerf::op_detail {
namespace {

constexpr double kTrianglesPerCell = 2.0;
constexpr double kMinCells = 4096.0, kMaxCells = 4e6;
constexpr double kMaxEntries = 16.0;  // per triangle; larger cells where there would be more
constexpr int kBlock = 8;             // cells along a block
constexpr double kSlack = 1e-7;       // mm, of a bound: less is not worth an examination
constexpr double kSteep = 20.0;       // slopes above it do not count for the plane of a cell
constexpr float kNothing = -std::numeric_limits<float>::infinity();

/// The float that is not below a number.
float rounded_up(double v) {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) >= v ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
}

struct Gradient {
  double x = 0.0, y = 0.0, area = 0.0;  // slopes; twice the area seen from above
};
/// Of the plane through three points; no area where it is vertical.
Gradient gradient_of(const Point3& a, const Point3& b, const Point3& c) {
  const Point3 n = cross(b - a, c - a);
  if (n.z == 0.0) return {};
  return {-n.x / n.z, -n.y / n.z, std::abs(n.z)};
}

/// The part of a polygon within `box`: at most three points more per side.
struct Polygon {
  std::array<Point3, 8> points;
  int count = 0;

  void cut(int axis, double limit, double side) {
    Polygon left;
    for (int i = 0; i < count; ++i) {
      const Point3 a = points[static_cast<std::size_t>(i)],
                   b = points[static_cast<std::size_t>((i + 1) % count)];
      const double da = side * (a[axis] - limit), db = side * (b[axis] - limit);
      if (da <= 0.0) left.add(a);
      if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) left.add(a + (da / (da - db)) * (b - a));
    }
    *this = left;
  }
  void add(Point3 p) {
    if (count < 8) points[static_cast<std::size_t>(count++)] = p;
  }
};

Polygon clipped(const Point3& a, const Point3& b, const Point3& c, const Box2& box) {
  Polygon p{{a, b, c}, 3};
  p.cut(0, box.low.x, -1.0), p.cut(0, box.high.x, 1.0);
  p.cut(1, box.low.y, -1.0), p.cut(1, box.high.y, 1.0);
  return p;
}

double square(double v) { return v * v; }
/// How far `v` is outside of the interval from `low` to `low + size`.
double outside(double v, double low, double size) { return std::max({low - v, v - low - size, 0.0}); }

}  // namespace

DropCutter::DropCutter(const SurfaceMesh& mesh, const SurfaceTool& tool, unsigned threads)
    : mesh_(mesh), tool_(tool) {
  if (tool.cone == 0.0 && tool.corner > 0.0) parabola_ = 0.5 / tool.corner;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box_.add(mesh.points[v].xy());
  if (mesh.triangles.empty()) return;
  choose_grid();
  sort_triangles();
  bound_cells(thread_count(threads));
}

void DropCutter::choose_grid() {
  const double wide = std::max(box_.high.x - box_.low.x, 1e-3),
               high = std::max(box_.high.y - box_.low.y, 1e-3);
  const double triangles = static_cast<double>(mesh_.triangles.size());
  const double cells = std::clamp(triangles / kTrianglesPerCell, kMinCells, kMaxCells);
  // A long strip has no more cells than a square.
  size_ = std::max(std::sqrt(wide * high / cells), std::max(wide, high) / kMaxCells * 8.0);
  const auto entries = [&] {
    double sum = 0.0;
    for (const auto& t : mesh_.triangles) {
      const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
      const double x = std::max({a.x, b.x, c.x}) - std::min({a.x, b.x, c.x});
      const double y = std::max({a.y, b.y, c.y}) - std::min({a.y, b.y, c.y});
      sum += (1.0 + x / size_) * (1.0 + y / size_);
    }
    return sum;
  };
  while (entries() > kMaxEntries * triangles + 32.0 * kMinCells) size_ *= 1.5;
  nx_ = std::max(1, static_cast<int>(std::ceil(wide / size_)));
  ny_ = std::max(1, static_cast<int>(std::ceil(high / size_)));
  blocks_x_ = (nx_ + kBlock - 1) / kBlock, blocks_y_ = (ny_ + kBlock - 1) / kBlock;
}

Box2 DropCutter::cell_box(std::size_t cell) const {
  const auto nx = static_cast<std::size_t>(nx_);
  const double x = box_.low.x + size_ * static_cast<double>(cell % nx);
  const double y = box_.low.y + size_ * static_cast<double>(cell / nx);
  return {{x, y}, {x + size_, y + size_}};
}

template <class Visit>
void DropCutter::visit_cells(std::uint32_t triangle, const Visit& visit) const {
  const auto& t = mesh_.triangles[triangle];
  const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
  const auto index = [&](double v, int count) {
    return std::clamp(static_cast<int>(v / size_), 0, count - 1);
  };
  const int i0 = index(std::min({a.x, b.x, c.x}) - box_.low.x, nx_);
  const int i1 = index(std::max({a.x, b.x, c.x}) - box_.low.x, nx_);
  const int j0 = index(std::min({a.y, b.y, c.y}) - box_.low.y, ny_);
  const int j1 = index(std::max({a.y, b.y, c.y}) - box_.low.y, ny_);
  const bool many = (i1 - i0) > 3 && (j1 - j0) > 3;
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const std::size_t cell =
          static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
      // Of a large triangle, only the cells that it passes through.
      if (many && clipped(a, b, c, cell_box(cell).grown(1e-3 * size_)).count == 0) continue;
      visit(cell);
    }
}

void DropCutter::sort_triangles() {
  const std::size_t cells = static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_);
  first_.assign(cells + 1, 0);
  const auto n = static_cast<std::uint32_t>(mesh_.triangles.size());
  for (std::uint32_t t = 0; t < n; ++t) visit_cells(t, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t i = 0; i < cells; ++i) first_[i + 1] += first_[i];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < n; ++t) visit_cells(t, [&](std::size_t cell) { entries_[next[cell]++] = t; });
}

void DropCutter::bound_cell(std::size_t cell) {
  const Box2 box = cell_box(cell);
  const Point2 centre = 0.5 * (box.low + box.high);
  Gradient sum;
  for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
    const auto& t = mesh_.triangles[entries_[k]];
    const Gradient g = gradient_of(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]);
    if (std::abs(g.x) > kSteep || std::abs(g.y) > kSteep) continue;
    sum.x += g.area * g.x, sum.y += g.area * g.y, sum.area += g.area;
  }
  if (sum.area > 0.0) sum.x /= sum.area, sum.y /= sum.area;
  double top = -INFINITY, plane = -INFINITY;
  const Box2 wider = box.grown(1e-3 * size_), wide = box.grown(size_);
  for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
    const auto& t = mesh_.triangles[entries_[k]];
    const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
    // A small triangle counts whole.
    const bool small = wide.contains({{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                                      {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}});
    const Polygon part = small ? Polygon{{a, b, c}, 3} : clipped(a, b, c, wider);
    for (int i = 0; i < part.count; ++i) {
      const Point3 p = part.points[static_cast<std::size_t>(i)];
      top = std::max(top, p.z);
      plane = std::max(plane, p.z - sum.x * (p.x - centre.x) - sum.y * (p.y - centre.y));
    }
  }
  highest_[cell] = std::isfinite(top) ? rounded_up(top) : kNothing;
  const double slope = std::hypot(sum.x, sum.y), r = tool_.contact(slope);
  Cell& made = cells_[cell];
  made.height = plane + slope * r - tool_.height(r);
  made.rise_x = sum.x, made.rise_y = sum.y;
  const double across = tool_.cone > 0.0 || slope == 0.0 ? 0.0 : (r - tool_.flat) / slope;
  made.shift_x = across * sum.x, made.shift_y = across * sum.y;
}

void DropCutter::bound_cells(unsigned threads) {
  highest_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), kNothing);
  cells_.resize(highest_.size());
  block_highest_.assign(static_cast<std::size_t>(blocks_x_) * static_cast<std::size_t>(blocks_y_), kNothing);
  const auto row_of_blocks = [&](std::size_t row) {
    const int first = static_cast<int>(row) * kBlock, last = std::min(first + kBlock, ny_);
    for (int j = first; j < last; ++j)
      for (int i = 0; i < nx_; ++i) {
        const std::size_t cell =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
        if (first_[cell] == first_[cell + 1]) continue;
        bound_cell(cell);
        float& block =
            block_highest_[row * static_cast<std::size_t>(blocks_x_) + static_cast<std::size_t>(i / kBlock)];
        block = std::max(block, highest_[cell]);
      }
  };
  parallel_for(threads, static_cast<std::size_t>(blocks_y_), row_of_blocks, [] { return false; });
}

/// An upper bound of the tool's height on a plane that it touches at `height`, over points that are at least
/// the root of `away` from where the rounded part of the tool touches it: the height falls with the square
/// of the distance at least as fast as a parabola does.
double DropCutter::fallen(double height, double away) const {
  if (tool_.flat == 0.0) return height - away * parabola_;
  if (away <= tool_.flat * tool_.flat) return height;
  return height - square(std::sqrt(away) - tool_.flat) * parabola_;
}

/// An upper bound of the tool's height over the contents of a cell, whose lower corner is at x, y relative to
/// the axis.
double DropCutter::bound(const Cell& cell, double x, double y) const {
  const double half = 0.5 * size_;
  const double height = cell.height - cell.rise_x * (x + half) - cell.rise_y * (y + half);
  if (parabola_ == 0.0) return height;
  return fallen(height, square(outside(cell.shift_x, x, size_)) + square(outside(cell.shift_y, y, size_)));
}

double DropCutter::touch(std::uint32_t triangle, Point2 p, double best) const {
  const auto& t = mesh_.triangles[triangle];
  const Point3 axis{p.x, p.y, 0.0};
  const std::array<Point3, 3> v{mesh_.points[t[0]] - axis, mesh_.points[t[1]] - axis,
                                mesh_.points[t[2]] - axis};
  const Gradient g = gradient_of(v[0], v[1], v[2]);
  if (g.area == 0.0)
    return std::max(
        {best, touch_line(tool_, v[0], v[1]), touch_line(tool_, v[1], v[2]), touch_line(tool_, v[2], v[0])});
  const double slope = std::sqrt(g.x * g.x + g.y * g.y), r = tool_.contact(slope);
  const Point2 q = slope > 0.0 ? (r / slope) * Point2{g.x, g.y} : Point2{};
  const double height = v[0].z + g.x * (q.x - v[0].x) + g.y * (q.y - v[0].y) - tool_.height(r);
  if (height <= best) return best;
  if (parabola_ > 0.0) {
    const Point2 c = slope > 0.0 ? ((r - tool_.flat) / slope) * Point2{g.x, g.y} : Point2{};
    const auto [x0, x1] = std::minmax({v[0].x, v[1].x, v[2].x});
    const auto [y0, y1] = std::minmax({v[0].y, v[1].y, v[2].y});
    const double away = square(outside(c.x, x0, x1 - x0)) + square(outside(c.y, y0, y1 - y0));
    if (fallen(height, away) <= best) return best;
  }
  const double turn = cross(v[1].xy() - v[0].xy(), v[2].xy() - v[0].xy()) > 0.0 ? 1.0 : -1.0;
  bool inside = true;
  // Where the contact with the plane is outside of the triangle, the highest point is on a side that it is
  // beyond.
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 &a = v[k], &b = v[(k + 1) % 3];
    if (turn * cross(b.xy() - a.xy(), q - a.xy()) >= 0.0) continue;
    inside = false;
    best = std::max(best, touch_line(tool_, a, b));
  }
  return inside ? height : best;
}

double DropCutter::at(Point2 p, double floor, Scratch& scratch) const {
  if (mesh_.triangles.empty()) return floor;
  if (scratch.examined.empty()) scratch.examined.assign(mesh_.triangles.size(), 0);
  ++scratch.query;
  double best = floor;
  const auto examine = [&](std::uint32_t triangle) {
    if (scratch.examined[triangle] == scratch.query) return;
    scratch.examined[triangle] = scratch.query;
    if (const double z = touch(triangle, p, best); z > best) best = z, scratch.last = triangle;
  };
  examine(scratch.last);
  const double x = p.x - box_.low.x, y = p.y - box_.low.y, reach = tool_.radius;
  const auto index = [&](double v, int count) {
    return static_cast<int>(std::clamp(std::floor(v / size_), -1.0, static_cast<double>(count)));
  };
  const int i0 = std::max(index(x - reach, nx_), 0), i1 = std::min(index(x + reach, nx_), nx_ - 1);
  const int j0 = std::max(index(y - reach, ny_), 0), j1 = std::min(index(y + reach, ny_), ny_ - 1);
  const double square_reach = reach * reach;
  const auto examine_cells = [&](int bi, int bj) {
    for (int j = std::max(j0, bj * kBlock); j <= std::min(j1, bj * kBlock + kBlock - 1); ++j) {
      const double low_y = size_ * j - y, dy = square(outside(0.0, low_y, size_));
      for (int i = std::max(i0, bi * kBlock); i <= std::min(i1, bi * kBlock + kBlock - 1); ++i) {
        const std::size_t cell =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
        if (highest_[cell] <= best + kSlack) continue;
        const double low_x = size_ * i - x, away = square(outside(0.0, low_x, size_)) + dy;
        if (away > square_reach) continue;
        if (bound(cells_[cell], low_x, low_y) <= best + kSlack) continue;
        if (highest_[cell] - tool_.height(std::sqrt(away)) <= best + kSlack) continue;
        for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) examine(entries_[k]);
      }
    }
  };
  const double block = kBlock * size_;
  for (int bj = j0 / kBlock; bj <= j1 / kBlock; ++bj) {
    const double dy = square(outside(0.0, block * bj - y, block));
    for (int bi = i0 / kBlock; bi <= i1 / kBlock; ++bi) {
      const double highest =
          block_highest_[static_cast<std::size_t>(bj) * static_cast<std::size_t>(blocks_x_) +
                         static_cast<std::size_t>(bi)];
      if (highest <= best + kSlack) continue;
      const double away = square(outside(0.0, block * bi - x, block)) + dy;
      if (away > square_reach || highest - tool_.height(std::sqrt(away)) <= best + kSlack) continue;
      examine_cells(bi, bj);
    }
  }
  return best;
}

}  // namespace kerf::op_detail
