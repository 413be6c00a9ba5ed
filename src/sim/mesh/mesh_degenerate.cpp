// Removes degenerate triangles: those with three corners of a level face in one line, and those with two
// corners of a wall at one height. They do not change the shape, but some programs that read meshes reject
// them. No vertex moves, and the mesh stays closed.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "sim/mesh/mesh_build.h"

#include "kerf/geom/geometry.h"

namespace kerf::meshing {
namespace {

/// A flip can produce another degenerate triangle, which is removed in the next round.
constexpr int kMaxRounds = 8;
/// Usual maximum of triangles around a vertex.
constexpr std::size_t kAround = 8;

/// Fills the holes in a list of `count` elements by calling move(from, to) for its last elements. Returns the
/// new number of elements. Sorts `holes`.
template <class Move>
std::size_t fill_holes(std::vector<std::size_t>& holes, std::size_t count, const Move& move) {
  std::sort(holes.begin(), holes.end());
  const std::size_t kept = count - holes.size();
  std::size_t last = count, holes_left = holes.size();
  for (const std::size_t hole : holes) {
    if (hole >= kept) break;
    --last;
    for (; holes[holes_left - 1] == last; --holes_left) --last;
    move(last, hole);
  }
  return kept;
}

class DegenerateRemover {
 public:
  /// `among`: the triangles to examine; null: all.
  DegenerateRemover(Mesh& mesh, unsigned threads, const std::vector<std::size_t>* among)
      : mesh_(mesh), threads_(threads), among_(among) {}
  void run();

 private:
  using Corners = std::array<std::uint32_t, 3>;

  Point3 point(std::uint32_t v) const {
    const float* p = mesh_.positions.data() + std::size_t{3} * v;
    return {p[0], p[1], p[2]};
  }
  Corners corners(std::size_t t) const {
    return {mesh_.triangles[3 * t], mesh_.triangles[3 * t + 1], mesh_.triangles[3 * t + 2]};
  }
  void set(std::size_t t, Corners c) {
    changed_.push_back(t);
    std::copy(c.begin(), c.end(), mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(3 * t));
  }
  bool is_removed(std::size_t t) const { return mesh_.triangles[3 * t] == mesh_.triangles[3 * t + 1]; }

  int longest_side(const Corners& c) const;
  bool is_degenerate(const Corners& c) const;
  void find_degenerate();
  void update_degenerate();
  bool has_all_around() const;
  void gather_around();
  const std::vector<std::uint32_t>& around(std::uint32_t v) const { return around_[index_around_[v]]; }
  std::size_t across(std::uint32_t a, std::uint32_t b) const;
  bool has_edge(std::uint32_t a, std::uint32_t b) const;
  bool flip(std::size_t t);
  bool collapse(std::uint32_t keep, std::uint32_t removed);
  bool remove(std::size_t t);
  void remove_all();
  void compact_triangles();
  void compact_vertices();

  Mesh& mesh_;
  unsigned threads_;
  const std::vector<std::size_t>* among_;
  std::vector<std::size_t> degenerate_, changed_;        // changed_: since degenerate_ was updated
  std::vector<std::size_t> removed_, removed_vertices_;  // triangles and vertices
  std::vector<std::uint32_t> index_around_;              // of a vertex in around_, or kNone
  // Triangles at a vertex; may include some that were removed or no longer have the vertex.
  std::vector<std::vector<std::uint32_t>> around_;
};

/// Number of the corner at which the longest side starts.
int DegenerateRemover::longest_side(const Corners& c) const {
  const Point3 a = point(c[0]), b = point(c[1]), d = point(c[2]);
  const std::array<double, 3> squares{dot(b - a, b - a), dot(d - b, d - b), dot(a - d, a - d)};
  return static_cast<int>(std::max_element(squares.begin(), squares.end()) - squares.begin());
}

bool DegenerateRemover::is_degenerate(const Corners& c) const {
  return has_no_area(point(c[0]), point(c[1]), point(c[2]));
}

void DegenerateRemover::find_degenerate() {
  const auto wrong = [&](std::size_t t) { return !is_removed(t) && is_degenerate(corners(t)); };
  if (among_ == nullptr) {
    degenerate_ = numbers_where(threads_, mesh_.step.size(), wrong);
    return;
  }
  degenerate_ = numbers_where(threads_, among_->size(), [&](std::size_t k) { return wrong((*among_)[k]); });
  for (std::size_t& t : degenerate_) t = (*among_)[t];
}

/// Keeps those that are still degenerate, and adds those of the changed triangles that are.
void DegenerateRemover::update_degenerate() {
  degenerate_.insert(degenerate_.end(), changed_.begin(), changed_.end());
  std::sort(degenerate_.begin(), degenerate_.end());
  degenerate_.erase(std::unique(degenerate_.begin(), degenerate_.end()), degenerate_.end());
  const auto is_done = [&](std::size_t t) { return is_removed(t) || !is_degenerate(corners(t)); };
  degenerate_.erase(std::remove_if(degenerate_.begin(), degenerate_.end(), is_done), degenerate_.end());
  changed_.clear();
}

/// Whether around_ has all vertices that removing the degenerate triangles needs.
bool DegenerateRemover::has_all_around() const {
  const auto has_list = [&](std::uint32_t v) { return index_around_[v] != kNone; };
  const auto has_corners = [&](std::size_t t) {
    const Corners c = corners(t);
    return std::all_of(c.begin(), c.end(), has_list);
  };
  const auto has_neighbours = [&](std::size_t t) {
    const Corners c = corners(t);
    return has_corners(t) && std::all_of(c.begin(), c.end(), [&](std::uint32_t v) {
             return std::all_of(around(v).begin(), around(v).end(), has_corners);
           });
  };
  return !index_around_.empty() && std::all_of(degenerate_.begin(), degenerate_.end(), has_neighbours);
}

/// Fills around_ for all vertices of degenerate triangles and of triangles with a vertex in common with them.
void DegenerateRemover::gather_around() {
  index_around_.assign(mesh_.positions.size() / 3, kNone);
  around_.clear();
  constexpr std::uint8_t kOfDegenerate = 1, kWanted = 2;
  std::vector<std::uint8_t> near(index_around_.size(), 0);
  const auto want = [&](std::uint32_t v) {
    if (index_around_[v] != kNone) return;
    index_around_[v] = static_cast<std::uint32_t>(around_.size());
    around_.emplace_back().reserve(kAround);
    near[v] |= kWanted;
  };
  const auto has = [&](std::size_t t, std::uint8_t mark) {
    const Corners c = corners(t);
    return ((near[c[0]] | near[c[1]] | near[c[2]]) & mark) != 0;
  };
  for (const std::size_t t : degenerate_)
    for (const std::uint32_t v : corners(t)) near[v] = kOfDegenerate;
  const auto beside =
      numbers_where(threads_, mesh_.step.size(), [&](std::size_t t) { return has(t, kOfDegenerate); });
  for (const std::size_t t : beside)
    for (const std::uint32_t v : corners(t)) want(v);
  const auto around = numbers_where(threads_, mesh_.step.size(),
                                    [&](std::size_t t) { return has(t, kWanted) && !is_removed(t); });
  for (const std::size_t t : around)
    for (const std::uint32_t v : corners(t))
      if (index_around_[v] != kNone) around_[index_around_[v]].push_back(static_cast<std::uint32_t>(t));
}

/// The triangle with the edge from a to b; SIZE_MAX if there is none.
std::size_t DegenerateRemover::across(std::uint32_t a, std::uint32_t b) const {
  for (const std::uint32_t t : around(a)) {
    if (is_removed(t)) continue;
    const Corners c = corners(t);
    for (std::size_t k = 0; k < 3; ++k)
      if (c[k] == a && c[(k + 1) % 3] == b) return t;
  }
  return SIZE_MAX;
}

bool DegenerateRemover::has_edge(std::uint32_t a, std::uint32_t b) const {
  return across(a, b) != SIZE_MAX || across(b, a) != SIZE_MAX;
}

/// Flips the longest side of a degenerate triangle, together with the neighbour there.
bool DegenerateRemover::flip(std::size_t t) {
  const Corners c = corners(t);
  const auto k = static_cast<std::size_t>(longest_side(c));
  const std::uint32_t a = c[(k + 1) % 3], between = c[(k + 2) % 3], b = c[k];  // a, between, b in order
  const std::size_t neighbour = across(a, b);
  if (neighbour == SIZE_MAX) return false;
  std::uint32_t far = kNone;
  for (const std::uint32_t v : corners(neighbour))
    if (v != a && v != b) far = v;
  const Corners one{a, between, far}, other{between, b, far};
  if (far == kNone || has_edge(between, far) || is_degenerate(one) || is_degenerate(other)) return false;
  set(t, one);
  set(neighbour, other);
  mesh_.step[t] = mesh_.step[neighbour];
  around_[index_around_[far]].push_back(static_cast<std::uint32_t>(t));
  around_[index_around_[between]].push_back(static_cast<std::uint32_t>(neighbour));
  return true;
}

/// Merges two vertices at one position that have an edge, if each edge then still has two triangles.
bool DegenerateRemover::collapse(std::uint32_t keep, std::uint32_t removed) {
  const auto neighbours = [&](std::uint32_t v) {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : around(v)) {
      const Corners c = corners(t);
      if (is_removed(t) || std::find(c.begin(), c.end(), v) == c.end()) continue;
      for (const std::uint32_t other : c)
        if (other != v) found.push_back(other);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  };
  const std::vector<std::uint32_t> a = neighbours(keep), b = neighbours(removed);
  std::vector<std::uint32_t> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  if (common.size() != 2 || has_edge(common[0], common[1])) return false;
  for (const std::uint32_t t : std::vector(around(removed))) {
    Corners c = corners(t);
    if (is_removed(t) || std::find(c.begin(), c.end(), removed) == c.end()) continue;
    const bool had_both = std::find(c.begin(), c.end(), keep) != c.end();
    std::replace(c.begin(), c.end(), removed, keep);
    set(t, had_both ? Corners{keep, keep, keep} : c);
    if (had_both) removed_.push_back(t);
    if (!had_both) around_[index_around_[keep]].push_back(t);
  }
  removed_vertices_.push_back(removed);
  return true;
}

bool DegenerateRemover::remove(std::size_t t) {
  const Corners c = corners(t);
  for (std::size_t k = 0; k < 3; ++k)
    if (point(c[k]) == point(c[(k + 1) % 3])) return collapse(c[k], c[(k + 1) % 3]);
  return flip(t);
}

void DegenerateRemover::compact_triangles() {
  const std::size_t kept = fill_holes(removed_, mesh_.step.size(), [&](std::size_t from, std::size_t to) {
    mesh_.step[to] = mesh_.step[from];
    std::copy_n(mesh_.triangles.data() + 3 * from, 3, mesh_.triangles.data() + 3 * to);
  });
  mesh_.triangles.resize(3 * kept);
  mesh_.step.resize(kept);
}

void DegenerateRemover::compact_vertices() {
  if (removed_vertices_.empty()) return;
  const std::size_t count = mesh_.positions.size() / 3;
  std::vector<std::uint32_t> moved(removed_vertices_.size(), kNone);  // new numbers of the last vertices
  const std::size_t kept = fill_holes(removed_vertices_, count, [&](std::size_t from, std::size_t to) {
    moved[from - (count - removed_vertices_.size())] = static_cast<std::uint32_t>(to);
    std::copy_n(mesh_.positions.data() + 3 * from, 3, mesh_.positions.data() + 3 * to);
  });
  mesh_.positions.resize(3 * kept);
  constexpr std::size_t kEach = 1 << 16;
  std::vector<std::uint32_t>& indices = mesh_.triangles;
  parallel_for(
      threads_, indices.size() / kEach + 1,
      [&](std::size_t n) {
        for (std::size_t k = n * kEach; k < std::min((n + 1) * kEach, indices.size()); ++k)
          if (indices[k] >= kept) indices[k] = moved[indices[k] - kept];
      },
      [] { return false; });
}

void DegenerateRemover::remove_all() {
  find_degenerate();
  for (int round = 0; round < kMaxRounds && !degenerate_.empty(); ++round) {
    if (!has_all_around()) gather_around();
    bool any = false;
    for (const std::size_t t : degenerate_)
      if (!is_removed(t) && is_degenerate(corners(t))) any = remove(t) || any;
    if (!any) break;
    update_degenerate();
  }
}

void DegenerateRemover::run() {
  remove_all();
  compact_triangles();
  compact_vertices();
}

}  // namespace

void remove_degenerate_triangles(Mesh& mesh, unsigned threads) {
  DegenerateRemover(mesh, threads, nullptr).run();
}

void remove_degenerate_triangles(Mesh& mesh, unsigned threads, const std::vector<std::size_t>& among) {
  DegenerateRemover(mesh, threads, &among).run();
}

}  // namespace kerf::meshing
