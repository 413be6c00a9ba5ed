// Ear clipping: holes are joined to the outside by bridges, then corners are cut off one by one.
#include "triangulate.h"

#include <algorithm>
#include <cmath>

namespace kerf::outline_detail {
namespace {

/// Triangles may miss the region's area by this share of it, from rounding.
constexpr double kAreaShare = 1e-9;
/// Points looked at in all, a few seconds of work. Ordinary shapes of a hundred thousand points stay far
/// below.
constexpr std::size_t kMostLooks = 1'000'000'000;
constexpr double kMostCells = 512.0;  // along a side of the grid

struct Node {
  Point2 at;
  std::uint32_t point = 0;  // index of the caller's point
  std::size_t before = 0, after = 0;
};

/// Twice the area of a triangle, above 0 if counter-clockwise.
double turn(Point2 a, Point2 b, Point2 c) { return cross(b - a, c - a); }

bool inside(Point2 p, Point2 a, Point2 b, Point2 c) {
  return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

/// Which nodes lie near a box: squares over the whole, with the nodes in them.
class Grid {
 public:
  void build(const std::vector<Node>& nodes, const std::vector<std::size_t>& chosen);
  /// Calls `look(node)` for the chosen nodes near the box until it returns true; says whether one did.
  template <class Look>
  bool any(Point2 low, Point2 high, Look look) const {
    const int x0 = column(low.x, low_.x, step_.x), x1 = column(high.x, low_.x, step_.x);
    const int y0 = column(low.y, low_.y, step_.y), y1 = column(high.y, low_.y, step_.y);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        for (const std::size_t node : cells_[static_cast<std::size_t>(y * side_ + x)])
          if (look(node)) return true;
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

void Grid::build(const std::vector<Node>& nodes, const std::vector<std::size_t>& chosen) {
  Point2 high = low_ = nodes.front().at;
  for (const Node& node : nodes) {
    low_ = {std::min(low_.x, node.at.x), std::min(low_.y, node.at.y)};
    high = {std::max(high.x, node.at.x), std::max(high.y, node.at.y)};
  }
  side_ = static_cast<int>(std::clamp(std::sqrt(static_cast<double>(chosen.size())), 1.0, kMostCells));
  step_ = (1.0 / side_) * (high - low_);
  cells_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), {});
  for (const std::size_t i : chosen) {
    const int x = column(nodes[i].at.x, low_.x, step_.x), y = column(nodes[i].at.y, low_.y, step_.y);
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
  std::size_t visible_from(const Node& hole) const;
  std::size_t copy(std::size_t node);
  bool is_ear(std::size_t i);
  void build_grid();
  bool opens_to(std::size_t i, Point2 p) const;
  double corner(std::size_t i) const {
    return turn(nodes_[nodes_[i].before].at, nodes_[i].at, nodes_[nodes_[i].after].at);
  }

  std::vector<Node> nodes_;
  std::vector<bool> gone_;  // cut off
  Grid reflex_;             // the corners that turn to the right at first; no other ever will
  std::size_t looks_ = 0;
  std::size_t outside_ = 0;
  std::size_t left_ = 0;  // nodes of the outside that are not cut off yet
  double area_ = 0.0;
};

std::size_t Clipper::add_ring(const Ring& ring, std::uint32_t first) {
  const std::size_t begin = nodes_.size(), n = ring.size();
  for (std::size_t i = 0; i < n; ++i)
    nodes_.push_back(
        {ring[i], first + static_cast<std::uint32_t>(i), begin + (i + n - 1) % n, begin + (i + 1) % n});
  left_ += n;
  area_ += area(ring);
  return begin;
}

Clipper::Clipper(const std::vector<Ring>& rings) {
  std::uint32_t first = 0;
  std::vector<std::size_t> rightmost;  // node of each hole
  for (const Ring& ring : rings) {
    const std::size_t begin = add_ring(ring, first);
    first += static_cast<std::uint32_t>(ring.size());
    if (begin == 0) continue;
    std::size_t best = begin;
    for (std::size_t i = begin; i < nodes_.size(); ++i)
      if (nodes_[i].at.x > nodes_[best].at.x) best = i;
    rightmost.push_back(best);
  }
  // The hole furthest to the right sees the outside; joined, it is outside for the next.
  std::sort(rightmost.begin(), rightmost.end(),
            [&](std::size_t a, std::size_t b) { return nodes_[a].at.x > nodes_[b].at.x; });
  for (const std::size_t hole : rightmost) {
    looks_ += nodes_.size();
    if (looks_ > kMostLooks) return;
    bridge(hole);
  }
  build_grid();
}

void Clipper::build_grid() {
  gone_.assign(nodes_.size(), false);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (corner(i) <= 0.0) chosen.push_back(i);
  reflex_.build(nodes_, chosen);
}

/// The node of the outside that a bridge from the hole's rightmost point may go to; the number of nodes if
/// none.
std::size_t Clipper::visible_from(const Node& hole) const {
  const Point2 h = hole.at;
  // The nearest edge to the right, and its end further right.
  double nearest = 0.0;
  std::size_t found = nodes_.size(), i = outside_;
  do {
    const Point2 a = nodes_[i].at, b = nodes_[nodes_[i].after].at;
    if (a.y <= h.y && b.y >= h.y && a.y != b.y) {  // an upward edge has the region on its left
      const double x = a.x + (h.y - a.y) / (b.y - a.y) * (b.x - a.x);
      if (x >= h.x && (found == nodes_.size() || x < nearest)) {
        nearest = x;
        found = a.x > b.x ? i : nodes_[i].after;
      }
    }
    i = nodes_[i].after;
  } while (i != outside_);
  if (found == nodes_.size()) return found;
  // Reflex corners inside the triangle of point, edge and end may hide the end: the one least off the ray
  // wins.
  const Point2 hit{nearest, h.y}, end = nodes_[found].at;
  double least = std::abs(end.y - h.y) / std::max(end.x - h.x, 1e-300);
  i = outside_;
  do {
    const Point2 p = nodes_[i].at;
    const bool within = end.y < h.y ? inside(p, h, end, hit) : inside(p, h, hit, end);
    if (i != found && p.x >= h.x && corner(i) <= 0.0 && within && !(p == end) && opens_to(i, h)) {
      const double slope = std::abs(p.y - h.y) / std::max(p.x - h.x, 1e-300);
      if (slope < least || (slope == least && p.x < nodes_[found].at.x)) {
        least = slope;
        found = i;
      }
    }
    i = nodes_[i].after;
  } while (i != outside_);
  return found;
}

/// Whether the region begins at a node in the direction of a point: bridges leave several nodes at one place,
/// each with its own part of the region.
bool Clipper::opens_to(std::size_t i, Point2 p) const {
  const Node& node = nodes_[i];
  const Point2 before = nodes_[node.before].at, after = nodes_[node.after].at;
  const bool left_in = turn(before, node.at, p) >= 0.0, left_out = turn(node.at, after, p) >= 0.0;
  return turn(before, node.at, after) > 0.0 ? left_in && left_out : left_in || left_out;
}

std::size_t Clipper::copy(std::size_t node) {
  nodes_.push_back(nodes_[node]);
  ++left_;
  return nodes_.size() - 1;
}

void Clipper::bridge(std::size_t hole) {
  const std::size_t to = visible_from(nodes_[hole]);
  if (to == nodes_.size()) return;  // outside of everything: the areas will not agree
  const std::size_t to_copy = copy(to), hole_copy = copy(hole);
  // outside ... to -> hole ... hole_copy -> to_copy ... outside
  const std::size_t hole_last = nodes_[hole].before, to_next = nodes_[to].after;
  nodes_[to].after = hole;
  nodes_[hole].before = to;
  nodes_[hole_last].after = hole_copy;
  nodes_[hole_copy].before = hole_last;
  nodes_[hole_copy].after = to_copy;
  nodes_[to_copy].before = hole_copy;
  nodes_[to_copy].after = to_next;
  nodes_[to_next].before = to_copy;
}

bool Clipper::is_ear(std::size_t i) {
  const Node& node = nodes_[i];
  const Point2 a = nodes_[node.before].at, b = node.at, c = nodes_[node.after].at;
  if (turn(a, b, c) < 0.0 || !opens_to(node.before, c) || !opens_to(node.after, a)) return false;
  const Point2 low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
  const Point2 high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
  return !reflex_.any(low, high, [&](std::size_t k) {
    ++looks_;
    const Point2 p = nodes_[k].at;
    if (gone_[k] || p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) return false;
    return !(p == a) && !(p == b) && !(p == c) && corner(k) <= 0.0 && inside(p, a, b, c);
  });
}

Triangulation Clipper::run() {
  Triangulation made;
  double covered = 0.0;
  std::size_t i = outside_, tried = 0;
  while (left_ >= 3 && tried <= left_ && looks_ <= kMostLooks) {
    const Node node = nodes_[i];
    ++looks_;
    if (!is_ear(i)) {
      ++tried;
      i = node.after;
      continue;
    }
    covered += 0.5 * corner(i);
    made.triangles.push_back({nodes_[node.before].point, node.point, nodes_[node.after].point});
    nodes_[node.before].after = node.after;
    nodes_[node.after].before = node.before;
    gone_[i] = true;
    --left_;
    tried = 0;
    i = nodes_[node.after].after;  // not the next one, which would make a fan of slivers
  }
  made.too_much = looks_ > kMostLooks;
  if (left_ > 2 || !(std::abs(covered - area_) <= kAreaShare * area_)) made.triangles.clear();
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
