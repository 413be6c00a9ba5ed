// Splits non-manifold edges and vertices: edges with more than two triangles, as where two columns touch
// along a line only, and vertices with more than one fan of triangles. The triangles at such an edge are
// paired across the material between them; vertices are then split into the fans that the pairs connect. An
// edge whose pairs still have both end points in common is halved once per pair.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "sim/mesh/mesh_build.h"

namespace kerf::meshing {
namespace {

/// A side of a triangle: its vertices, and the corner from which it runs to the next one. Corner k of the
/// n-th examined triangle has the number 3 n + k.
struct Side {
  std::uint32_t low, high, corner;
};

/// Numbers of the two sides of one edge.
struct Pair {
  std::uint32_t forward, backward;
};

constexpr std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

class Splitter {
 public:
  Splitter(Mesh& mesh, unsigned threads, const std::vector<std::uint32_t>& suspects,
           std::vector<std::size_t>& near);
  /// One round; true if edges were halved, so that another must follow.
  bool round();

 private:
  std::uint32_t vertex(std::uint32_t corner) const { return corners_[corner]; }
  void set_vertex(std::uint32_t corner, std::uint32_t v) {
    corners_[corner] = v;
    mesh_.triangles[3 * triangles_[corner / 3] + corner % 3] = v;
  }
  bool is_forward(const Side& side) const { return vertex(side.corner) == side.low; }
  Point3 point(std::uint32_t v) const;
  double angle(const Side& side) const;
  void collect();
  void sort_sides();
  void pair_up();
  void pair_shared(std::uint32_t first, std::uint32_t end);
  std::uint32_t root(std::uint32_t corner);
  void join(const Side& a, const Side& b);
  void split_vertices();
  bool halve();
  void halve_side(const Side& side, std::uint32_t midpoint);

  Mesh& mesh_;
  unsigned threads_;
  std::vector<std::size_t>& near_;      // numbers of all triangles that may have a suspect vertex
  std::vector<std::uint8_t> suspect_;   // per vertex
  std::vector<std::size_t> triangles_;  // those with a suspect vertex
  std::vector<std::uint32_t> corners_;  // their vertices
  std::vector<Side> sides_;             // of these, with a suspect end
  std::vector<Pair> pairs_, shared_pairs_;
  std::vector<std::uint32_t> parent_;  // union-find over the corners
};

Splitter::Splitter(Mesh& mesh, unsigned threads, const std::vector<std::uint32_t>& suspects,
                   std::vector<std::size_t>& near)
    : mesh_(mesh), threads_(threads), near_(near), suspect_(mesh.positions.size() / 3, 0) {
  for (const std::uint32_t v : suspects) suspect_[v] = 1;
}

Point3 Splitter::point(std::uint32_t v) const {
  const float* p = mesh_.positions.data() + std::size_t{3} * v;
  return {p[0], p[1], p[2]};
}

/// Direction of the triangle around its side, seen along low to high, in [0, 2 pi).
double Splitter::angle(const Side& side) const {
  const Point3 from = point(side.low), along = point(side.high) - from;
  const Point3 out = point(vertex(next_corner(next_corner(side.corner)))) - from;
  Point3 u = std::abs(along.x) < std::abs(along.z) ? Point3{1, 0, 0} : Point3{0, 0, 1};
  u = cross(along, u);
  const Point3 v = cross(along, u);
  const double scale = length(along);
  const double a = std::atan2(dot(out, v), dot(out, u) * scale);
  return a < 0.0 ? a + 2 * std::numbers::pi : a;
}

/// The sides of all triangles near suspect vertices, sorted by edge.
void Splitter::collect() {
  suspect_.resize(mesh_.positions.size() / 3, 1);
  triangles_ = numbers_where(threads_, near_.size(), [&](std::size_t n) {
    const std::uint32_t* const t = mesh_.triangles.data() + 3 * near_[n];
    return (suspect_[t[0]] | suspect_[t[1]] | suspect_[t[2]]) != 0;
  });
  for (std::size_t& t : triangles_) t = near_[t];
  corners_.resize(3 * triangles_.size());
  for (std::size_t n = 0; n < triangles_.size(); ++n)
    std::copy_n(mesh_.triangles.data() + 3 * triangles_[n], 3, corners_.data() + 3 * n);
  sides_.clear();
  for (std::uint32_t corner = 0; corner < 3 * triangles_.size(); ++corner) {
    const std::uint32_t a = vertex(corner), b = vertex(next_corner(corner));
    if (suspect_[a] != 0 || suspect_[b] != 0) sides_.push_back({std::min(a, b), std::max(a, b), corner});
  }
  sort_sides();
}

/// Sorts by edge, and the sides of an edge by triangle: a counting sort by lower vertex, then the few of
/// each.
void Splitter::sort_sides() {
  std::vector<std::uint32_t> next(suspect_.size() + 1, 0);
  for (const Side& side : sides_) ++next[side.low + std::size_t{1}];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Side> sorted(sides_.size());
  for (const Side& side : sides_) sorted[next[side.low]++] = side;
  sides_ = std::move(sorted);
  for (std::size_t first = 0, end = 0; first < sides_.size(); first = end) {
    end = next[sides_[first].low];
    std::sort(sides_.data() + first, sides_.data() + end, [](const Side& a, const Side& b) {
      return std::tie(a.high, a.corner) < std::tie(b.high, b.corner);
    });
  }
}

/// Pairs the two triangles of each edge; at edges with more triangles, those with material between them.
void Splitter::pair_up() {
  pairs_.clear();
  shared_pairs_.clear();
  const auto count = static_cast<std::uint32_t>(sides_.size());
  for (std::uint32_t first = 0, end = 0; first < count; first = end) {
    while (end < count && sides_[end].low == sides_[first].low && sides_[end].high == sides_[first].high)
      ++end;
    if (end - first > 2) {
      pair_shared(first, end);
    } else if (end - first == 2) {
      pairs_.push_back({first, first + 1});
    }
  }
}

void Splitter::pair_shared(std::uint32_t first, std::uint32_t end) {
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<std::pair<double, std::uint32_t>> forward, backward;
  for (std::uint32_t k = first; k < end; ++k)
    (is_forward(sides_[k]) ? forward : backward).emplace_back(angle(sides_[k]), k);
  for (const auto& [turn, side] : forward) {
    if (backward.empty()) return;
    std::size_t best = 0;
    double smallest = 2 * kTurn;
    for (std::size_t k = 0; k < backward.size(); ++k) {
      double gap = turn - backward[k].first;
      if (gap < 0.0) gap += kTurn;
      if (gap < smallest) {
        smallest = gap;
        best = k;
      }
    }
    pairs_.push_back({side, backward[best].second});
    shared_pairs_.push_back(pairs_.back());
    backward.erase(backward.begin() + static_cast<std::ptrdiff_t>(best));
  }
}

std::uint32_t Splitter::root(std::uint32_t corner) {
  while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
  return corner;
}

void Splitter::join(const Side& a, const Side& b) {
  const auto corner_at = [&](const Side& side, std::uint32_t v) {
    return vertex(side.corner) == v ? side.corner : next_corner(side.corner);
  };
  for (const std::uint32_t v : {a.low, a.high}) {
    if (suspect_[v] == 0) continue;
    const std::uint32_t x = root(corner_at(a, v)), y = root(corner_at(b, v));
    parent_[std::max(x, y)] = std::min(x, y);
  }
}

/// Gives each fan of triangles around a suspect vertex a vertex of its own; the first fan keeps the old one.
void Splitter::split_vertices() {
  parent_.resize(3 * triangles_.size());
  std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  for (const Pair& pair : pairs_) join(sides_[pair.forward], sides_[pair.backward]);
  std::vector<std::uint32_t> vertex_of(parent_.size(), kNone);
  std::vector<std::uint8_t> kept(suspect_.size(), 0);
  for (std::uint32_t c = 0; c < parent_.size(); ++c) {
    const std::uint32_t old = vertex(c);
    if (suspect_[old] == 0) continue;
    std::uint32_t& mine = vertex_of[root(c)];
    if (mine == kNone) {
      mine = old;
      if (kept[old] != 0) {
        mine = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
        for (std::size_t k = 0; k < 3; ++k)
          mesh_.positions.push_back(mesh_.positions[std::size_t{3} * old + k]);
      }
      kept[old] = 1;
    }
    if (mine != old) set_vertex(c, mine);
  }
}

/// Halves the edges that still have more than two triangles after split_vertices. True if there are any.
bool Splitter::halve() {
  if (shared_pairs_.empty()) return false;
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::size_t>;
  std::vector<Key> keys;
  for (std::size_t k = 0; k < shared_pairs_.size(); ++k) {
    const std::uint32_t corner = sides_[shared_pairs_[k].forward].corner;
    const std::uint32_t a = vertex(corner), b = vertex(next_corner(corner));
    keys.emplace_back(std::min(a, b), std::max(a, b), k);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint8_t> touched(triangles_.size(), 0);
  bool any = false;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto same = [&](std::size_t n) {
      return n < keys.size() && std::get<0>(keys[n]) == std::get<0>(keys[k]) &&
             std::get<1>(keys[n]) == std::get<1>(keys[k]);
    };
    if (!same(k + 1) && !(k > 0 && same(k - 1))) continue;
    any = true;
    const Pair& pair = shared_pairs_[std::get<2>(keys[k])];
    const Side &forward = sides_[pair.forward], &backward = sides_[pair.backward];
    std::uint8_t &first = touched[forward.corner / 3], &second = touched[backward.corner / 3];
    if (first != 0 || second != 0) continue;  // its turn comes in the next round
    first = second = 1;
    const Point3 a = point(std::get<0>(keys[k])), b = point(std::get<1>(keys[k]));
    const auto midpoint = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
    for (int axis = 0; axis < 3; ++axis)
      mesh_.positions.push_back(static_cast<float>((a[axis] + b[axis]) / 2));
    halve_side(forward, midpoint);
    halve_side(backward, midpoint);
  }
  return any;
}

void Splitter::halve_side(const Side& side, std::uint32_t midpoint) {
  const std::uint32_t end = next_corner(side.corner), to = vertex(end), apex = vertex(next_corner(end));
  set_vertex(end, midpoint);
  for (const std::uint32_t v : {midpoint, to, apex}) mesh_.triangles.push_back(v);
  near_.push_back(mesh_.step.size());
  mesh_.step.push_back(mesh_.step[triangles_[side.corner / 3]]);
}

bool Splitter::round() {
  collect();
  pair_up();
  split_vertices();
  return halve();
}

}  // namespace

void split_non_manifold(Mesh& mesh, unsigned threads, const std::vector<std::uint32_t>& suspects,
                        std::vector<std::size_t>& near) {
  if (suspects.empty()) return;
  Splitter splitter(mesh, threads, suspects, near);
  while (splitter.round()) {
  }
}

}  // namespace kerf::meshing
