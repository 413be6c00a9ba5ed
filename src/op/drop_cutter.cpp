// Drop-cutter by cells.
#include "op/drop_cutter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace kerf::op_detail {
namespace {

constexpr std::size_t kPart = 4096;  // triangles that a thread takes at once
constexpr double kTrianglesPerCell = 2.0;
constexpr double kMinCells = 4096.0, kMaxCells = 4e6;
constexpr double kMaxEntries = 16.0;  // per triangle; larger cells where there would be more
constexpr double kLargest = 0.5;      // of the tool's radius, of the squares that a search starts with
constexpr double kBeside = 1e-3;      // of its size, that a square is larger for what is at its border
constexpr double kSlack = 1e-7;       // mm, of a bound: less is not worth an examination
constexpr double kSteep = 20.0;       // slopes above it do not count for the plane of a cell
constexpr double kNothing = -std::numeric_limits<double>::infinity();

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
  plane_facets(thread_count(threads));
  choose_grid();
  sort_triangles();
  bound_squares(thread_count(threads));
}

void DropCutter::plane_facets(unsigned threads) {
  const std::size_t count = mesh_.triangles.size();
  facets_.resize(count);
  const auto part = [&](std::size_t n) {
    for (std::size_t i = n * kPart; i < std::min(count, (n + 1) * kPart); ++i) {
      const auto& t = mesh_.triangles[i];
      const Gradient g = gradient_of(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]);
      const double slope = std::sqrt(g.x * g.x + g.y * g.y), r = tool_.contact(slope);
      Facet& made = facets_[i];
      made = {g.area > 0.0 ? slope * r - tool_.height(r) : INFINITY, g.x, g.y, 0.0, 0.0};
      if (slope > 0.0) made.contact_x = r / slope * g.x, made.contact_y = r / slope * g.y;
    }
  };
  parallel_for(threads, (count + kPart - 1) / kPart, part, [] { return false; });
}

void DropCutter::choose_grid() {
  const double wide = std::max(box_.high.x - box_.low.x, 1e-3),
               high = std::max(box_.high.y - box_.low.y, 1e-3);
  const double triangles = static_cast<double>(mesh_.triangles.size());
  const double cells = std::clamp(triangles / kTrianglesPerCell, kMinCells, kMaxCells);
  // A long strip has no more cells than a square.
  double size = std::max(std::sqrt(wide * high / cells), std::max(wide, high) / kMaxCells * 8.0);
  const auto entries = [&] {
    double sum = 0.0;
    for (const auto& t : mesh_.triangles) {
      const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
      const double x = std::max({a.x, b.x, c.x}) - std::min({a.x, b.x, c.x});
      const double y = std::max({a.y, b.y, c.y}) - std::min({a.y, b.y, c.y});
      sum += (1.0 + x / size) * (1.0 + y / size);
    }
    return sum;
  };
  while (entries() > kMaxEntries * triangles + 32.0 * kMinCells) size *= 1.5;
  choose_levels(size, std::max(1, static_cast<int>(std::ceil(wide / size))),
                std::max(1, static_cast<int>(std::ceil(high / size))));
}

/// Levels up to squares that are not much smaller than the tool, or until there is one square.
void DropCutter::choose_levels(double size, int nx, int ny) {
  const auto even = [](int n) { return n + n % 2; };
  std::size_t count = 0;
  for (;; size *= 2.0, nx = (nx + 1) / 2, ny = (ny + 1) / 2) {
    levels_.push_back({size, even(nx), even(ny), count});
    count += static_cast<std::size_t>(even(nx)) * static_cast<std::size_t>(even(ny));
    if (2.0 * size > kLargest * tool_.radius || (nx <= 1 && ny <= 1)) break;
  }
  squares_.assign(count, {.highest = kNothing});
}

Box2 DropCutter::cell_box(int i, int j) const {
  const Point2 low = box_.low + levels_[0].corner(i, j);
  return {low, low + Point2{levels_[0].size, levels_[0].size}};
}

template <class Visit>
void DropCutter::visit_cells(std::uint32_t triangle, const Visit& visit) const {
  const auto& t = mesh_.triangles[triangle];
  const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
  const Level& cells = levels_[0];
  const auto index = [&](double v, int count) {
    return std::clamp(static_cast<int>(v / cells.size), 0, count - 1);
  };
  const int i0 = index(std::min({a.x, b.x, c.x}) - box_.low.x, cells.nx);
  const int i1 = index(std::max({a.x, b.x, c.x}) - box_.low.x, cells.nx);
  const int j0 = index(std::min({a.y, b.y, c.y}) - box_.low.y, cells.ny);
  const int j1 = index(std::max({a.y, b.y, c.y}) - box_.low.y, cells.ny);
  const bool many = (i1 - i0) > 3 && (j1 - j0) > 3;
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      // Of a large triangle, only the cells that it passes through.
      if (many && clipped(a, b, c, cell_box(i, j).grown(kBeside * cells.size)).count == 0) continue;
      visit(cells.index(i, j));
    }
}

void DropCutter::sort_triangles() {
  const std::size_t cells = static_cast<std::size_t>(levels_[0].nx) * static_cast<std::size_t>(levels_[0].ny);
  first_.assign(cells + 1, 0);
  const auto n = static_cast<std::uint32_t>(mesh_.triangles.size());
  for (std::uint32_t t = 0; t < n; ++t) visit_cells(t, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t i = 0; i < cells; ++i) first_[i + 1] += first_[i];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < n; ++t) visit_cells(t, [&](std::size_t cell) { entries_[next[cell]++] = t; });
}

void DropCutter::set_plane(Square& square, Point2 rise, double plane) const {
  const double slope = std::hypot(rise.x, rise.y), r = tool_.contact(slope);
  square.plane = plane;
  square.height = plane + slope * r - tool_.height(r);
  square.rise_x = rise.x, square.rise_y = rise.y;
  const double across = tool_.cone > 0.0 || slope == 0.0 ? 0.0 : (r - tool_.flat) / slope;
  square.shift_x = across * rise.x, square.shift_y = across * rise.y;
}

void DropCutter::bound_cell(int i, int j) {
  const std::size_t cell = levels_[0].index(i, j);
  if (first_[cell] == first_[cell + 1]) return;
  const double size = levels_[0].size;
  const Box2 box = cell_box(i, j);
  const Point2 centre = 0.5 * (box.low + box.high);
  Gradient sum;
  for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
    const auto& t = mesh_.triangles[entries_[k]];
    const Gradient g = gradient_of(mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]);
    if (std::abs(g.x) > kSteep || std::abs(g.y) > kSteep) continue;
    sum.x += g.area * g.x, sum.y += g.area * g.y, sum.area += g.area;
  }
  if (sum.area > 0.0) sum.x /= sum.area, sum.y /= sum.area;
  double top = kNothing, plane = kNothing;
  const Box2 wider = box.grown(kBeside * size), wide = box.grown(size);
  for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
    const auto& t = mesh_.triangles[entries_[k]];
    const Point3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
    // A small triangle counts whole.
    const bool small = wide.contains({{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
                                      {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})}});
    const Polygon part = small ? Polygon{{a, b, c}, 3} : clipped(a, b, c, wider);
    for (int n = 0; n < part.count; ++n) {
      const Point3 p = part.points[static_cast<std::size_t>(n)];
      top = std::max(top, p.z);
      plane = std::max(plane, p.z - sum.x * (p.x - centre.x) - sum.y * (p.y - centre.y));
    }
  }
  squares_[cell].highest = top;
  set_plane(squares_[cell], {sum.x, sum.y}, plane);
}

/// From the four squares that it is made of.
void DropCutter::bound_square(std::size_t level, int i, int j) {
  const Level& below = levels_[level - 1];
  Square& made = squares_[levels_[level].index(i, j)];
  if (2 * i >= below.nx || 2 * j >= below.ny) return;
  const Square* const parts = &squares_[below.index(2 * i, 2 * j)];
  Point2 rise;
  double count = 0.0;
  for (int k = 0; k < 4; ++k)
    if (parts[k].highest > kNothing) rise = rise + Point2{parts[k].rise_x, parts[k].rise_y}, count += 1.0;
  if (count == 0.0) return;
  rise = (1.0 / count) * rise;
  double plane = kNothing;
  for (int k = 0; k < 4; ++k) {
    const Square& part = parts[k];
    if (part.highest == kNothing) continue;
    const Point2 away = (0.5 * below.size) * Point2{k % 2 == 0 ? -1.0 : 1.0, k / 2 == 0 ? -1.0 : 1.0};
    const double spread =
        (0.5 + kBeside) * below.size * (std::abs(part.rise_x - rise.x) + std::abs(part.rise_y - rise.y));
    plane = std::max(plane, part.plane - dot(rise, away) + spread);
    made.highest = std::max(made.highest, part.highest);
  }
  set_plane(made, rise, plane);
}

void DropCutter::bound_squares(unsigned threads) {
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const auto row_of_squares = [&](std::size_t row) {
      for (int i = 0; i < levels_[level].nx; ++i)
        if (level == 0)
          bound_cell(i, static_cast<int>(row));
        else
          bound_square(level, i, static_cast<int>(row));
    };
    parallel_for(threads, static_cast<std::size_t>(levels_[level].ny), row_of_squares, [] { return false; });
  }
}

/// An upper bound of the tool's height on a plane that it touches at `height`, over points that are at least
/// the root of `away` from where the rounded part of the tool touches it: the height falls with the square
/// of the distance at least as fast as a parabola does.
double DropCutter::fallen(double height, double away) const {
  if (tool_.flat == 0.0) return height - away * parabola_;
  if (away <= tool_.flat * tool_.flat) return height;
  return height - square(std::sqrt(away) - tool_.flat) * parabola_;
}

/// An upper bound of the tool's height over the contents of a square, whose lower corner is at x, y relative
/// to the axis.
double DropCutter::bound(const Square& of, double x, double y, double size) const {
  const double half = 0.5 * size;
  const double height = of.height - of.rise_x * (x + half) - of.rise_y * (y + half);
  if (parabola_ == 0.0) return height;
  return fallen(height, square(outside(of.shift_x, x, size)) + square(outside(of.shift_y, y, size)));
}

/// Whether a tool whose contact with the plane of a triangle is outside of it is surely lower than `above`
/// below its height on that plane. `corners` relative to the axis.
bool DropCutter::is_low(const Facet& facet, double above, const std::array<Point3, 3>& corners) const {
  Point2 round{facet.contact_x, facet.contact_y};
  if (tool_.flat > 0.0) {
    const double r = std::sqrt(dot(round, round));
    round = r > 0.0 ? ((r - tool_.flat) / r) * round : round;
  }
  const auto [x0, x1] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [y0, y1] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  const double away = square(outside(round.x, x0, x1 - x0)) + square(outside(round.y, y0, y1 - y0));
  return -fallen(0.0, away) >= above;
}

double DropCutter::touch(std::uint32_t triangle, Point2 p, double best) const {
  const Facet& facet = facets_[triangle];
  const auto& t = mesh_.triangles[triangle];
  const Point3 axis{p.x, p.y, 0.0};
  const Point3 first = mesh_.points[t[0]] - axis;
  const double height = first.z + facet.lift - facet.rise_x * first.x - facet.rise_y * first.y;
  if (height <= best) return best;
  const std::array<Point3, 3> v{first, mesh_.points[t[1]] - axis, mesh_.points[t[2]] - axis};
  if (std::isinf(facet.lift)) {
    for (std::size_t k = 0; k < 3; ++k) best = std::max(best, touch_line(tool_, v[k], v[(k + 1) % 3]));
    return best;
  }
  if (parabola_ > 0.0 && is_low(facet, height - best, v)) return best;
  const double turn = cross(v[1].xy() - v[0].xy(), v[2].xy() - v[0].xy()) > 0.0 ? 1.0 : -1.0;
  const Point2 q{facet.contact_x, facet.contact_y};
  // As in fallen(), with squares on both sides.
  const double fall = tool_.flat > 0.0 ? 0.0 : parabola_;
  bool inside = true;
  // Where the contact with the plane is outside of the triangle, the highest point is on a side that it is
  // beyond.
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 &a = v[k], &b = v[(k + 1) % 3];
    const Point2 along = b.xy() - a.xy();
    const double beyond = turn * cross(along, q - a.xy());
    if (beyond >= 0.0) continue;
    inside = false;
    if (fall * beyond * beyond < (height - best) * dot(along, along))
      best = std::max(best, touch_line(tool_, a, b));
  }
  return inside ? height : best;
}

/// The search for the highest contact at one position.
class DropCutter::Search {
 public:
  Search(const DropCutter& cutter, Point2 p, double floor, Scratch& scratch)
      : cutter_(cutter), p_(p), from_(p - cutter.box_.low), best_(floor), scratch_(scratch) {
    if (scratch.examined.empty()) scratch.examined.assign(cutter.mesh_.triangles.size(), 0);
    ++scratch.query;
  }

  double run() {
    examine(scratch_.last);
    const std::size_t top = cutter_.levels_.size() - 1;
    const Level& level = cutter_.levels_[top];
    const double reach = cutter_.tool_.radius;
    const auto index = [&](double v, int count) {
      return static_cast<int>(std::clamp(std::floor(v / level.size), -1.0, static_cast<double>(count)));
    };
    const int i0 = std::max(index(from_.x - reach, level.nx), 0);
    const int i1 = std::min(index(from_.x + reach, level.nx), level.nx - 1);
    const int j0 = std::max(index(from_.y - reach, level.ny), 0);
    const int j1 = std::min(index(from_.y + reach, level.ny), level.ny - 1);
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i) visit(top, i, j, level.index(i, j));
    return best_;
  }

 private:
  void examine(std::uint32_t triangle) {
    if (scratch_.examined[triangle] == scratch_.query) return;
    scratch_.examined[triangle] = scratch_.query;
    if (const double z = cutter_.touch(triangle, p_, best_); z > best_) best_ = z, scratch_.last = triangle;
  }

  bool may_be_higher(const Square& square, Point2 corner, double size) const {
    const double least = best_ + kSlack, reach = cutter_.tool_.radius;
    if (square.highest <= least) return false;
    const double away =
        op_detail::square(outside(0.0, corner.x, size)) + op_detail::square(outside(0.0, corner.y, size));
    if (away > reach * reach || cutter_.bound(square, corner.x, corner.y, size) <= least) return false;
    return square.highest - cutter_.tool_.height(std::sqrt(away)) > least;
  }

  void visit(std::size_t level, int i, int j, std::size_t index) {
    const Level& squares = cutter_.levels_[level];
    if (!may_be_higher(cutter_.squares_[index], squares.corner(i, j) - from_, squares.size)) return;
    if (level == 0) {
      for (std::uint32_t k = cutter_.first_[index]; k < cutter_.first_[index + 1]; ++k)
        examine(cutter_.entries_[k]);
      return;
    }
    const std::size_t first = cutter_.levels_[level - 1].index(2 * i, 2 * j);
    for (int k = 0; k < 4; ++k)
      visit(level - 1, 2 * i + k % 2, 2 * j + k / 2, first + static_cast<std::size_t>(k));
  }

  const DropCutter& cutter_;
  Point2 p_, from_;  // of the axis; relative to the corner of the grid
  double best_;
  Scratch& scratch_;
};

double DropCutter::at(Point2 p, double floor, Scratch& scratch) const {
  return mesh_.triangles.empty() ? floor : Search(*this, p, floor, scratch).run();
}

}  // namespace kerf::op_detail
