// Parts edges that more than two triangles share, as where two columns touch along a line only, and vertices
// in which more than one fan of triangles meet. The triangles at such an edge are paired so that the material
// between them stays together; vertices are then parted into the fans that the pairs leave connected. An edge
// whose two pairs still meet at both ends is halved, once a pair.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "sim/mesh_build.h"

namespace kerf::meshing {
namespace {

/// A side of a triangle: `triangle` is the place of its first index, `slot` its place in triangles_.
struct Side {
  std::uint32_t low, high;  // vertices
  std::size_t triangle;
  std::uint32_t slot;
  std::uint8_t corner;  // the side runs from this corner to the next
  bool forward;         // from low to high
};

struct Pair {
  Side forward, backward;
};

class Splitter {
 public:
  Splitter(Mesh& mesh, const std::vector<std::uint32_t>& suspects, std::vector<std::size_t>& near);
  /// One round; true if edges were halved, so that another must follow.
  bool round();

 private:
  std::uint32_t& index(std::size_t triangle, std::size_t corner) {
    return mesh_.triangles[triangle + corner];
  }
  Point3 point(std::uint32_t v) const;
  double angle(const Side& side);
  void collect();
  void sort_sides();
  void pair_up();
  void pair_shared(std::size_t begin, std::size_t end);
  std::size_t root(std::size_t corner);
  void join(const Side& a, const Side& b);
  void part_vertices();
  bool halve();
  void halve_side(const Side& side, std::uint32_t middle);

  Mesh& mesh_;
  std::vector<std::size_t>& near_;              // numbers of all triangles that may have a suspect vertex
  std::vector<std::uint8_t> suspect_, parted_;  // one a vertex
  std::vector<std::size_t> triangles_;          // those with a suspect vertex
  std::vector<Side> sides_;                     // of these, with both ends suspect or one parted
  std::vector<Pair> pairs_, shared_pairs_;
  std::vector<std::size_t> parent_;  // union-find over the corners of triangles_
};

Splitter::Splitter(Mesh& mesh, const std::vector<std::uint32_t>& suspects, std::vector<std::size_t>& near)
    : mesh_(mesh), near_(near), suspect_(mesh.positions.size() / 3, 0) {
  for (const std::uint32_t v : suspects) suspect_[v] = 1;
}

Point3 Splitter::point(std::uint32_t v) const {
  const float* p = mesh_.positions.data() + std::size_t{3} * v;
  return {p[0], p[1], p[2]};
}

/// Direction of the triangle around its side, seen along low to high, in [0, 2 pi).
double Splitter::angle(const Side& side) {
  const Point3 from = point(side.low), along = point(side.high) - from;
  const Point3 out = point(index(side.triangle, (side.corner + std::size_t{2}) % 3)) - from;
  Point3 u = std::abs(along.x) < std::abs(along.z) ? Point3{1, 0, 0} : Point3{0, 0, 1};
  u = cross(along, u);
  const Point3 v = cross(along, u);
  const double scale = length(along);
  const double a = std::atan2(dot(out, v), dot(out, u) * scale);
  return a < 0.0 ? a + 2 * std::numbers::pi : a;
}

/// The sides of all triangles near suspect vertices, sorted by edge.
void Splitter::collect() {
  triangles_.clear();
  sides_.clear();
  suspect_.resize(mesh_.positions.size() / 3, 1);
  for (const std::size_t number : near_) {
    const std::size_t t = 3 * number;
    if ((suspect_[index(t, 0)] | suspect_[index(t, 1)] | suspect_[index(t, 2)]) == 0) continue;
    const auto slot = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(t);
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = index(t, k), b = index(t, (k + std::size_t{1}) % 3);
      if (suspect_[a] != 0 || suspect_[b] != 0)
        sides_.push_back({std::min(a, b), std::max(a, b), t, slot, k, a < b});
    }
  }
  sort_sides();
}

/// By edge, and the sides of an edge by triangle: first all under their lower vertex, then the few of each.
void Splitter::sort_sides() {
  std::vector<std::size_t> next(suspect_.size() + 1, 0);
  for (const Side& side : sides_) ++next[side.low + std::size_t{1}];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Side> sorted(sides_.size());
  for (const Side& side : sides_) sorted[next[side.low]++] = side;
  sides_ = std::move(sorted);
  for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
    end = next[sides_[begin].low];
    std::sort(sides_.data() + begin, sides_.data() + end, [](const Side& a, const Side& b) {
      return std::tie(a.high, a.triangle, a.corner) < std::tie(b.high, b.triangle, b.corner);
    });
  }
}

/// Pairs the two triangles of each edge; of shared edges the ones with material between them.
void Splitter::pair_up() {
  pairs_.clear();
  shared_pairs_.clear();
  parted_ = suspect_;
  for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
    while (end < sides_.size() && sides_[end].low == sides_[begin].low &&
           sides_[end].high == sides_[begin].high)
      ++end;
    if (end - begin > 2) {
      pair_shared(begin, end);
    } else if (end - begin == 2) {
      pairs_.push_back({sides_[begin], sides_[begin + 1]});
    }
  }
}

void Splitter::pair_shared(std::size_t begin, std::size_t end) {
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<std::pair<double, Side>> forward, backward;
  for (std::size_t k = begin; k < end; ++k)
    (sides_[k].forward ? forward : backward).emplace_back(angle(sides_[k]), sides_[k]);
  for (const auto& [turn, side] : forward) {
    if (backward.empty()) return;
    std::size_t best = 0;
    double least = 2 * kTurn;
    for (std::size_t k = 0; k < backward.size(); ++k) {
      double gap = turn - backward[k].first;
      if (gap < 0.0) gap += kTurn;
      if (gap < least) {
        least = gap;
        best = k;
      }
    }
    pairs_.push_back({side, backward[best].second});
    shared_pairs_.push_back(pairs_.back());
    backward.erase(backward.begin() + static_cast<std::ptrdiff_t>(best));
  }
}

std::size_t Splitter::root(std::size_t corner) {
  while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
  return corner;
}

void Splitter::join(const Side& a, const Side& b) {
  const auto corner_at = [&](const Side& side, std::uint32_t vertex) {
    std::size_t k = side.corner;
    if (index(side.triangle, k) != vertex) k = (k + 1) % 3;
    return 3 * std::size_t{side.slot} + k;
  };
  for (const std::uint32_t vertex : {a.low, a.high}) {
    if (parted_[vertex] == 0) continue;
    const std::size_t x = root(corner_at(a, vertex)), y = root(corner_at(b, vertex));
    parent_[std::max(x, y)] = std::min(x, y);
  }
}

/// Gives each fan of triangles around a parted vertex a vertex of its own; the first fan keeps the old one.
void Splitter::part_vertices() {
  parent_.resize(3 * triangles_.size());
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  for (const Pair& pair : pairs_) join(pair.forward, pair.backward);
  std::vector<std::uint32_t> vertex_of(parent_.size(), kNone);
  std::vector<std::uint8_t> kept(mesh_.positions.size() / 3, 0);
  for (std::size_t c = 0; c < parent_.size(); ++c) {
    std::uint32_t& vertex = index(triangles_[c / 3], c % 3);
    if (vertex >= parted_.size() || parted_[vertex] == 0) continue;
    std::uint32_t& mine = vertex_of[root(c)];
    if (mine == kNone) {
      mine = vertex;
      if (kept[vertex] != 0) {
        mine = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
        for (std::size_t k = 0; k < 3; ++k)
          mesh_.positions.push_back(mesh_.positions[std::size_t{3} * vertex + k]);
      }
      kept[vertex] = 1;
    }
    vertex = mine;
  }
}

/// Halves the edges that are still shared after parting. True if there were any.
bool Splitter::halve() {
  if (shared_pairs_.empty()) return false;
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::size_t>;
  std::vector<Key> keys;
  for (std::size_t k = 0; k < shared_pairs_.size(); ++k) {
    const Side& side = shared_pairs_[k].forward;
    const std::uint32_t a = index(side.triangle, side.corner),
                        b = index(side.triangle, (side.corner + 1u) % 3);
    keys.emplace_back(std::min(a, b), std::max(a, b), k);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint8_t> touched(mesh_.triangles.size() / 3, 0);
  bool any = false;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto same = [&](std::size_t n) {
      return n < keys.size() && std::get<0>(keys[n]) == std::get<0>(keys[k]) &&
             std::get<1>(keys[n]) == std::get<1>(keys[k]);
    };
    if (!same(k + 1) && !(k > 0 && same(k - 1))) continue;
    any = true;
    const Pair& pair = shared_pairs_[std::get<2>(keys[k])];
    std::uint8_t& first = touched[pair.forward.triangle / 3];
    std::uint8_t& second = touched[pair.backward.triangle / 3];
    if (first != 0 || second != 0) continue;  // its turn comes in the next round
    first = second = 1;
    const Point3 a = point(std::get<0>(keys[k])), b = point(std::get<1>(keys[k]));
    const auto middle = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
    for (int axis = 0; axis < 3; ++axis)
      mesh_.positions.push_back(static_cast<float>((a[axis] + b[axis]) / 2));
    halve_side(pair.forward, middle);
    halve_side(pair.backward, middle);
  }
  return any;
}

void Splitter::halve_side(const Side& side, std::uint32_t middle) {
  const std::uint32_t to = index(side.triangle, (side.corner + std::size_t{1}) % 3);
  const std::uint32_t apex = index(side.triangle, (side.corner + std::size_t{2}) % 3);
  index(side.triangle, (side.corner + std::size_t{1}) % 3) = middle;
  for (const std::uint32_t v : {middle, to, apex}) mesh_.triangles.push_back(v);
  near_.push_back(mesh_.step.size());
  mesh_.step.push_back(mesh_.step[side.triangle / 3]);
}

bool Splitter::round() {
  collect();
  pair_up();
  part_vertices();
  return halve();
}

}  // namespace

void split_shared_edges(Mesh& mesh, const std::vector<std::uint32_t>& suspects,
                        std::vector<std::size_t>& near) {
  if (suspects.empty()) return;
  Splitter splitter(mesh, suspects, near);
  while (splitter.round()) {
  }
}

}  // namespace kerf::meshing
