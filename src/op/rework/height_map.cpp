// Surfaces through measured points: grids, triangles, profiles.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/pathdxf.h"
#include "geom/base/box_tree.h"

#include "kerf/base/limits.h"
#include "kerf/op/level.h"

namespace kerf {
namespace {

constexpr double kGridTolerance = 0.05;        // mm, of positions in one row or column
constexpr std::size_t kMaxScattered = 5000;    // points; the time for triangles grows with the square
constexpr std::size_t kMaxPoints = 4'000'000;  // of a grid
constexpr double kSamePoint = 1e-6;            // mm
constexpr double kCollinear = 1e-9;            // of the extent
// mm, of a grid's edges beyond a box: the box of a line along X or Y has no height or width, and an edge that
// ends on the line is found or not by rounding.
constexpr double kEdgeReach = 1.0;
constexpr double kInside = 1e-9;    // barycentric
constexpr double kSuperSize = 1e4;  // of the first triangle, in extents

struct Grid {
  std::vector<double> xs, ys, zs;  // zs by rows of equal y

  double at(Point2 p) const {
    const auto cell = [](const std::vector<double>& list, double v) {
      const double clamped = std::clamp(v, list.front(), list.back());
      const auto above = std::upper_bound(list.begin() + 1, list.end() - 1, clamped);
      const auto i = static_cast<std::size_t>(above - list.begin()) - 1;
      return std::pair(i, (clamped - list[i]) / (list[i + 1] - list[i]));
    };
    const auto [i, u] = cell(xs, p.x);
    const auto [j, v] = cell(ys, p.y);
    const std::size_t n = xs.size(), k = j * n + i;
    return (1 - v) * ((1 - u) * zs[k] + u * zs[k + 1]) + v * ((1 - u) * zs[k + n] + u * zs[k + n + 1]);
  }
};

struct Triangles {
  std::vector<Point3> points;
  std::vector<std::array<std::size_t, 3>> list;
  std::vector<std::pair<std::size_t, std::size_t>> hull;
  BoxTree tree;

  double at(Point2 p) const;
};

/// Points on one line, by their distance along it.
struct Profile {
  Point2 origin, along;  // a unit vector
  std::vector<std::pair<double, double>> heights;

  double at(Point2 p) const {
    const double d = dot(p - origin, along);
    const auto above = std::upper_bound(heights.begin(), heights.end(), std::pair(d, HUGE_VAL));
    if (above == heights.begin()) return above->second;
    const auto below = above - 1;
    if (above == heights.end()) return below->second;
    return below->second +
           (above->second - below->second) * (d - below->first) / (above->first - below->first);
  }
};

/// The rows or columns of a grid: positions that differ by more than the tolerance.
std::vector<double> lines_of(const std::vector<Point3>& points, double Point3::*axis) {
  std::vector<double> all, lines;
  for (const Point3& p : points) all.push_back(p.*axis);
  std::sort(all.begin(), all.end());
  for (const double v : all)
    if (lines.empty() || v - lines.back() > kGridTolerance) lines.push_back(v);
  return lines;
}

std::size_t nearest_line(const std::vector<double>& lines, double v) {
  const auto above = std::upper_bound(lines.begin(), lines.end(), v);
  return static_cast<std::size_t>(above - lines.begin()) - 1;
}

std::optional<Grid> grid_of(const std::vector<Point3>& points) {
  Grid g;
  g.xs = lines_of(points, &Point3::x);
  g.ys = lines_of(points, &Point3::y);
  if (g.xs.size() < 2 || g.ys.size() < 2 || g.xs.size() * g.ys.size() > points.size()) return std::nullopt;
  g.zs.assign(g.xs.size() * g.ys.size(), NAN);
  for (const Point3& p : points) g.zs[nearest_line(g.ys, p.y) * g.xs.size() + nearest_line(g.xs, p.x)] = p.z;
  if (std::any_of(g.zs.begin(), g.zs.end(), [](double z) { return std::isnan(z); })) return std::nullopt;
  return g;
}

std::optional<Profile> profile_of(const std::vector<Point3>& points) {
  Profile out;
  out.origin = points[0].xy();
  double extent = 0.0;
  for (const Point3& p : points)
    if (const double d = distance(p.xy(), out.origin); d > extent) {
      extent = d;
      out.along = (1.0 / d) * (p.xy() - out.origin);
    }
  for (const Point3& p : points) {
    if (std::abs(cross(out.along, p.xy() - out.origin)) > kCollinear * extent + kSamePoint)
      return std::nullopt;
    out.heights.emplace_back(dot(p.xy() - out.origin, out.along), p.z);
  }
  std::sort(out.heights.begin(), out.heights.end());
  return out;
}

// ------------------------------------------------------------------------------------------------ triangles

bool in_circumcircle(Point2 a, Point2 b, Point2 c, Point2 p) {
  a = a - p, b = b - p, c = c - p;
  const double det = dot(a, a) * cross(b, c) - dot(b, b) * cross(a, c) + dot(c, c) * cross(a, b);
  return det > 0.0;  // of counter-clockwise triangles
}

/// Bowyer and Watson: each point replaces the triangles whose circumcircle it is in.
Triangles triangulate(std::vector<Point3> points, const Box2& bounds) {
  const std::size_t n = points.size();
  const Point2 centre = 0.5 * (bounds.low + bounds.high);
  const double size = kSuperSize * std::max(distance(bounds.low, bounds.high), 1.0);
  points.push_back({centre.x - size, centre.y - size, 0.0});
  points.push_back({centre.x + size, centre.y - size, 0.0});
  points.push_back({centre.x, centre.y + size, 0.0});
  std::vector<std::array<std::size_t, 3>> list{{n, n + 1, n + 2}}, kept;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t i = 0; i < n; ++i) {
    kept.clear();
    edges.clear();
    for (const auto& t : list) {
      if (!in_circumcircle(points[t[0]].xy(), points[t[1]].xy(), points[t[2]].xy(), points[i].xy())) {
        kept.push_back(t);
        continue;
      }
      for (const std::size_t k : {0u, 1u, 2u}) edges.emplace_back(t[k], t[(k + 1) % 3]);
    }
    std::sort(edges.begin(), edges.end());
    for (const auto& [a, b] : edges) {
      if (std::binary_search(edges.begin(), edges.end(), std::pair(b, a))) continue;
      const Point2 p = points[a].xy(), q = points[b].xy(), r = points[i].xy();
      if (cross(q - p, r - p) > 0.0) kept.push_back({a, b, i});
    }
    list.swap(kept);
  }
  Triangles out;
  points.resize(n);
  out.points = std::move(points);
  for (const auto& t : list)
    if (t[0] < n && t[1] < n && t[2] < n) out.list.push_back(t);
  return out;
}

void index(Triangles& t) {
  std::vector<Box2> boxes;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (const auto& triangle : t.list) {
    Box2 box;
    for (const std::size_t k : {0u, 1u, 2u}) {
      box.add(t.points[triangle[k]].xy());
      edges.emplace_back(triangle[k], triangle[(k + 1) % 3]);
    }
    boxes.push_back(box);
  }
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : edges)
    if (!std::binary_search(edges.begin(), edges.end(), std::pair(b, a))) t.hull.emplace_back(a, b);
  t.tree = BoxTree(boxes);
}

double Triangles::at(Point2 p) const {
  std::optional<double> height;
  tree.query(Box2{p, p}, [&](std::uint32_t item) {
    if (height) return;
    const Point3 &a = points[list[item][0]], &b = points[list[item][1]], &c = points[list[item][2]];
    const double area = cross(b.xy() - a.xy(), c.xy() - a.xy());
    const double u = cross(b.xy() - p, c.xy() - p) / area, v = cross(c.xy() - p, a.xy() - p) / area;
    const double w = 1.0 - u - v;
    if (u >= -kInside && v >= -kInside && w >= -kInside) height = u * a.z + v * b.z + w * c.z;
  });
  if (height) return *height;
  double nearest = HUGE_VAL, z = 0.0;
  for (const auto& [from, to] : hull) {
    const Point3 &a = points[from], &b = points[to];
    const Point2 way = b.xy() - a.xy();
    const double t = std::clamp(dot(p - a.xy(), way) / dot(way, way), 0.0, 1.0);
    const double d = distance(p, a.xy() + t * way);
    if (d >= nearest) continue;
    nearest = d;
    z = a.z + t * (b.z - a.z);
  }
  return z;
}

/// Of points at one position the last one counts.
std::vector<Point3> without_repeated(const std::vector<Point3>& points) {
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(points[a].x, points[a].y) < std::pair(points[b].x, points[b].y);
  });
  std::vector<Point3> out;
  for (const std::size_t i : order) {
    if (!out.empty() && distance(out.back().xy(), points[i].xy()) <= kSamePoint)
      out.back() = points[i];
    else
      out.push_back(points[i]);
  }
  return out;
}

}  // namespace

struct HeightMap::Body {
  Box2 bounds;
  std::optional<Grid> grid;
  std::optional<Profile> profile;
  Triangles triangles;
};

HeightMap::HeightMap(std::unique_ptr<Body> body) : body_(std::move(body)) {}
HeightMap::HeightMap(HeightMap&&) noexcept = default;
HeightMap& HeightMap::operator=(HeightMap&&) noexcept = default;
HeightMap::~HeightMap() = default;

std::optional<HeightMap> HeightMap::make(std::vector<Point3> points, const Origin& where,
                                         Diagnostics& diagnostics) {
  const auto fail = [&](std::string message) {
    diagnostics.error(codes::level_map, where, std::move(message));
    return std::nullopt;
  };
  if (points.empty()) return fail("there is no measured height");
  if (points.size() > kMaxPoints) return fail(fmt::format("more than {} heights", kMaxPoints));
  for (const Point3& p : points)
    if (!(std::abs(p.x) <= limits::kMaxCoordinate && std::abs(p.y) <= limits::kMaxCoordinate &&
          std::abs(p.z) <= limits::kMaxCoordinate))
      return fail(fmt::format("a position is beyond {} mm", limits::kMaxCoordinate));
  auto body = std::make_unique<Body>();
  for (const Point3& p : points) body->bounds.add(p.xy());
  body->grid = grid_of(points);
  if (body->grid) return HeightMap(std::move(body));
  points = without_repeated(points);
  body->profile = profile_of(points);
  if (body->profile) return HeightMap(std::move(body));
  if (points.size() > kMaxScattered)
    return fail(fmt::format("{} heights that are no complete grid; at most {} are possible", points.size(),
                            kMaxScattered));
  body->triangles = triangulate(std::move(points), body->bounds);
  index(body->triangles);
  if (body->triangles.list.empty()) return fail("the measured positions do not span an area");
  return HeightMap(std::move(body));
}

double HeightMap::at(Point2 p) const {
  if (body_->grid) return body_->grid->at(p);
  return body_->profile ? body_->profile->at(p) : body_->triangles.at(p);
}

const Box2& HeightMap::bounds() const { return body_->bounds; }

double HeightMap::distance_outside(Point2 p) const {
  const Box2& area = body_->bounds;
  return std::hypot(std::max({area.low.x - p.x, p.x - area.high.x, 0.0}),
                    std::max({area.low.y - p.y, p.y - area.high.y, 0.0}));
}

void HeightMap::edges(const Box2& box, const std::function<void(Point2, Point2)>& visit) const {
  if (body_->grid) {
    const Grid& g = *body_->grid;
    for (auto x = std::lower_bound(g.xs.begin(), g.xs.end(), box.low.x); x != g.xs.end() && *x <= box.high.x;
         ++x)
      visit({*x, box.low.y - kEdgeReach}, {*x, box.high.y + kEdgeReach});
    for (auto y = std::lower_bound(g.ys.begin(), g.ys.end(), box.low.y); y != g.ys.end() && *y <= box.high.y;
         ++y)
      visit({box.low.x - kEdgeReach, *y}, {box.high.x + kEdgeReach, *y});
  } else if (body_->profile) {
    const Profile& f = *body_->profile;
    const Point2 across{-f.along.y, f.along.x};
    const double reach = distance(box.low, box.high) + distance(f.origin, box.low);
    for (const auto& [d, z] : f.heights) {
      const Point2 p = f.origin + d * f.along;
      visit(p - reach * across, p + reach * across);
    }
  } else {
    const Triangles& t = body_->triangles;
    t.tree.query(box, [&](std::uint32_t item) {
      for (const std::size_t k : {0u, 1u, 2u})
        visit(t.points[t.list[item][k]].xy(), t.points[t.list[item][(k + 1) % 3]].xy());
    });
  }
}

}  // namespace kerf
