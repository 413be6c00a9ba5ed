// Ear clipping: holes are connected to the outside by bridges, then ears are cut off one by one.
#include "triangulate.h"

#include <algorithm>
#include <cmath>

namespace kerf::outline_detail {
namespace {

/// Maximum difference of the triangles' area from the region's, as a fraction of it, from rounding.
constexpr double kAreaError = 1e-9;
/// Maximum of points examined, a few seconds of work. Ordinary shapes of a hundred thousand points stay far
/// below.
constexpr std::size_t kMaxExamined = 1'000'000'000;
constexpr double kMaxCells = 512.0;  // along a side of the grid

struct RingVertex {
  Point2 at;
  std::uint32_t point = 0;  // index of the caller's point
  std::size_t before = 0, after = 0;
};

/// Twice the area of a triangle, above 0 if counter-clockwise.
double turn(Point2 a, Point2 b, Point2 c) { return cross(b - a, c - a); }

bool inside(Point2 p, Point2 a, Point2 b, Point2 c) {
  return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

/// Which vertices lie near a box: squares over the whole, with the vertices in them.
class Grid {
 public:
  void build(const std::vector<RingVertex>& vertices, const std::vector<std::size_t>& chosen);
  /// Calls `visit(vertex)` for the chosen vertices near the box until it returns true; whether one did.
  template <class Visit>
  bool any(Point2 low, Point2 high, Visit visit) const {
    const int x0 = column(low.x, low_.x, step_.x), x1 = column(high.x, low_.x, step_.x);
    const int y0 = column(low.y, low_.y, step_.y), y1 = column(high.y, low_.y, step_.y);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        for (const std::size_t vertex : cells_[static_cast<std::size_t>(y * side_ + x)])
          if (visit(vertex)) return true;
    return false;
  }

 private:
  int column(double at, double low, double step) const {
    return step > 0.0 ? static_cast<int>(std::clamp((at - low) / step, 0.0, side_ - 1.0)) : 0;
  }
  int side_ = 1;
  Point2 low_, step_;
  std::vector<std::vector<std::size_t>> cells_;
};

void Grid::build(const std::vector<RingVertex>& vertices, const std::vector<std::size_t>& chosen) {
  Point2 high = low_ = vertices.front().at;
  for (const RingVertex& vertex : vertices) {
    low_ = {std::min(low_.x, vertex.at.x), std::min(low_.y, vertex.at.y)};
    high = {std::max(high.x, vertex.at.x), std::max(high.y, vertex.at.y)};
  }
  side_ = static_cast<int>(std::clamp(std::sqrt(static_cast<double>(chosen.size())), 1.0, kMaxCells));
  step_ = (1.0 / side_) * (high - low_);
  cells_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), {});
  for (const std::size_t i : chosen) {
    const int x = column(vertices[i].at.x, low_.x, step_.x), y = column(vertices[i].at.y, low_.y, step_.y);
    cells_[static_cast<std::size_t>(y * side_ + x)].push_back(i);
  }
}

class Clipper {
 public:
  explicit Clipper(const std::vector<Ring>& rings);
  Triangulation run();

 private:
  std::size_t add_ring(const Ring& ring, std::uint32_t first);
  void bridge(std::size_t hole);
  std::size_t visible_from(const RingVertex& hole) const;
  std::size_t copy(std::size_t vertex);
  bool is_ear(std::size_t i);
  void build_grid();
  bool opens_to(std::size_t i, Point2 p) const;
  double corner(std::size_t i) const {
    return turn(vertices_[vertices_[i].before].at, vertices_[i].at, vertices_[vertices_[i].after].at);
  }

  std::vector<RingVertex> vertices_;
  std::vector<bool> removed_;  // cut off
  Grid reflex_;                // the corners that turn to the right at first; no other ever will
  std::size_t examined_ = 0;
  std::size_t outside_ = 0;
  std::size_t left_ = 0;  // vertices of the outside that are not cut off yet
  double area_ = 0.0;
};

std::size_t Clipper::add_ring(const Ring& ring, std::uint32_t first) {
  const std::size_t start = vertices_.size(), n = ring.size();
  for (std::size_t i = 0; i < n; ++i)
    vertices_.push_back(
        {ring[i], first + static_cast<std::uint32_t>(i), start + (i + n - 1) % n, start + (i + 1) % n});
  left_ += n;
  area_ += area(ring);
  return start;
}

Clipper::Clipper(const std::vector<Ring>& rings) {
  std::uint32_t first = 0;
  std::vector<std::size_t> rightmost;  // vertex of each hole
  for (const Ring& ring : rings) {
    const std::size_t start = add_ring(ring, first);
    first += static_cast<std::uint32_t>(ring.size());
    if (start == 0) continue;
    std::size_t best = start;
    for (std::size_t i = start; i < vertices_.size(); ++i)
      if (vertices_[i].at.x > vertices_[best].at.x) best = i;
    rightmost.push_back(best);
  }
  // The outside is visible from the rightmost hole; once connected, that hole is outside for the next.
  std::sort(rightmost.begin(), rightmost.end(),
            [&](std::size_t a, std::size_t b) { return vertices_[a].at.x > vertices_[b].at.x; });
  for (const std::size_t hole : rightmost) {
    examined_ += vertices_.size();
    if (examined_ > kMaxExamined) return;
    bridge(hole);
  }
  build_grid();
}

void Clipper::build_grid() {
  removed_.assign(vertices_.size(), false);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    if (corner(i) <= 0.0) chosen.push_back(i);
  reflex_.build(vertices_, chosen);
}

/// The vertex of the outside that a bridge from the hole's rightmost point may go to; the number of vertices
/// if none.
std::size_t Clipper::visible_from(const RingVertex& hole) const {
  const Point2 h = hole.at;
  // The nearest edge to the right, and its end further right.
  double nearest = 0.0;
  std::size_t found = vertices_.size(), i = outside_;
  do {
    const Point2 a = vertices_[i].at, b = vertices_[vertices_[i].after].at;
    if (a.y <= h.y && b.y >= h.y && a.y != b.y) {  // an upward edge has the region on its left
      const double x = a.x + (h.y - a.y) / (b.y - a.y) * (b.x - a.x);
      if (x >= h.x && (found == vertices_.size() || x < nearest)) {
        nearest = x;
        found = a.x > b.x ? i : vertices_[i].after;
      }
    }
    i = vertices_[i].after;
  } while (i != outside_);
  if (found == vertices_.size()) return found;
  // Reflex corners inside the triangle of point, edge and end may hide the end: then the one at the smallest
  // angle to the ray is visible.
  const Point2 hit{nearest, h.y}, end = vertices_[found].at;
  double least = std::abs(end.y - h.y) / std::max(end.x - h.x, 1e-300);
  i = outside_;
  do {
    const Point2 p = vertices_[i].at;
    const bool within = end.y < h.y ? inside(p, h, end, hit) : inside(p, h, hit, end);
    if (i != found && p.x >= h.x && corner(i) <= 0.0 && within && !(p == end) && opens_to(i, h)) {
      const double slope = std::abs(p.y - h.y) / std::max(p.x - h.x, 1e-300);
      if (slope < least || (slope == least && p.x < vertices_[found].at.x)) {
        least = slope;
        found = i;
      }
    }
    i = vertices_[i].after;
  } while (i != outside_);
  return found;
}

/// Whether the region lies at a vertex in the direction of a point: bridges make several vertices of one
/// position, each with its own sector of the region.
bool Clipper::opens_to(std::size_t i, Point2 p) const {
  const RingVertex& vertex = vertices_[i];
  const Point2 before = vertices_[vertex.before].at, after = vertices_[vertex.after].at;
  const bool left_in = turn(before, vertex.at, p) >= 0.0, left_out = turn(vertex.at, after, p) >= 0.0;
  return turn(before, vertex.at, after) > 0.0 ? left_in && left_out : left_in || left_out;
}

std::size_t Clipper::copy(std::size_t vertex) {
  vertices_.push_back(vertices_[vertex]);
  ++left_;
  return vertices_.size() - 1;
}

void Clipper::bridge(std::size_t hole) {
  const std::size_t to = visible_from(vertices_[hole]);
  if (to == vertices_.size()) return;  // the hole is outside: the areas will differ
  const std::size_t to_copy = copy(to), hole_copy = copy(hole);
  // outside ... to -> hole ... hole_copy -> to_copy ... outside
  const std::size_t hole_last = vertices_[hole].before, to_next = vertices_[to].after;
  vertices_[to].after = hole;
  vertices_[hole].before = to;
  vertices_[hole_last].after = hole_copy;
  vertices_[hole_copy].before = hole_last;
  vertices_[hole_copy].after = to_copy;
  vertices_[to_copy].before = hole_copy;
  vertices_[to_copy].after = to_next;
  vertices_[to_next].before = to_copy;
}

bool Clipper::is_ear(std::size_t i) {
  const RingVertex& vertex = vertices_[i];
  const Point2 a = vertices_[vertex.before].at, b = vertex.at, c = vertices_[vertex.after].at;
  if (turn(a, b, c) < 0.0 || !opens_to(vertex.before, c) || !opens_to(vertex.after, a)) return false;
  const Point2 low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
  const Point2 high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
  return !reflex_.any(low, high, [&](std::size_t k) {
    ++examined_;
    const Point2 p = vertices_[k].at;
    if (removed_[k] || p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) return false;
    return !(p == a) && !(p == b) && !(p == c) && corner(k) <= 0.0 && inside(p, a, b, c);
  });
}

Triangulation Clipper::run() {
  Triangulation made;
  double covered = 0.0;
  std::size_t i = outside_, tried = 0;
  while (left_ >= 3 && tried <= left_ && examined_ <= kMaxExamined) {
    const RingVertex vertex = vertices_[i];
    ++examined_;
    if (!is_ear(i)) {
      ++tried;
      i = vertex.after;
      continue;
    }
    covered += 0.5 * corner(i);
    made.triangles.push_back({vertices_[vertex.before].point, vertex.point, vertices_[vertex.after].point});
    vertices_[vertex.before].after = vertex.after;
    vertices_[vertex.after].before = vertex.before;
    removed_[i] = true;
    --left_;
    tried = 0;
    i = vertices_[vertex.after].after;  // not the next one, which would make a fan of slivers
  }
  made.too_much = examined_ > kMaxExamined;
  if (left_ > 2 || !(std::abs(covered - area_) <= kAreaError * area_)) made.triangles.clear();
  return made;
}

}  // namespace

double area(const Ring& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i)
    twice += cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
  return 0.5 * twice;
}

Triangulation triangulate(const std::vector<Ring>& rings) { return Clipper(rings).run(); }

}  // namespace kerf::outline_detail
