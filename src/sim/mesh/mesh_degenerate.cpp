// Takes out triangles without area. They come where three corners of a level face lie on one line, and where
// two corners of a line have one height: harmless to the shape, but programs that read a mesh stumble over
// them. Nothing moves, and the mesh stays closed.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "sim/mesh/mesh_build.h"

#include "kerf/geometry.h"

namespace kerf::meshing {
namespace {

/// A flip can leave another flat triangle, which is looked at again; not for ever.
constexpr int kMaxRounds = 8;
/// Triangles around a vertex, mostly no more.
constexpr std::size_t kAround = 8;

/// Puts the last things into the places of those that are no more: move(from, to). Returns how many there
/// are then. Sorts `holes`.
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

class Mender {
 public:
  /// Looks at the triangles `among`, or at all.
  Mender(Mesh& mesh, unsigned threads, const std::vector<std::size_t>* among)
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
  bool is_gone(std::size_t t) const { return mesh_.triangles[3 * t] == mesh_.triangles[3 * t + 1]; }

  int longest_side(const Corners& c) const;
  bool is_flat(const Corners& c) const;
  void find_flat();
  void find_flat_again();
  bool knows_around() const;
  void gather_around();
  const std::vector<std::uint32_t>& around(std::uint32_t v) const { return around_[place_[v]]; }
  std::size_t across(std::uint32_t a, std::uint32_t b) const;
  bool joined(std::uint32_t a, std::uint32_t b) const;
  bool flip(std::size_t t);
  bool collapse(std::uint32_t keep, std::uint32_t gone);
  bool mend(std::size_t t);
  void mend_all();
  void drop_gone_triangles();
  void drop_gone_vertices();

  Mesh& mesh_;
  unsigned threads_;
  const std::vector<std::size_t>* among_;
  std::vector<std::size_t> flat_, changed_;         // changed: since the flat ones were found
  std::vector<std::size_t> gone_, gone_vertices_;   // triangles and vertices that are no more
  std::vector<std::uint32_t> place_;                // of a vertex in around_, kNone: of no interest
  std::vector<std::vector<std::uint32_t>> around_;  // triangles at a vertex, some of them gone or moved away
};

/// Number of the corner before the longest side.
int Mender::longest_side(const Corners& c) const {
  const Point3 a = point(c[0]), b = point(c[1]), d = point(c[2]);
  const std::array<double, 3> squares{dot(b - a, b - a), dot(d - b, d - b), dot(a - d, a - d)};
  return static_cast<int>(std::max_element(squares.begin(), squares.end()) - squares.begin());
}

bool Mender::is_flat(const Corners& c) const { return has_no_area(point(c[0]), point(c[1]), point(c[2])); }

void Mender::find_flat() {
  const auto wrong = [&](std::size_t t) { return !is_gone(t) && is_flat(corners(t)); };
  if (among_ == nullptr) {
    flat_ = numbers_where(threads_, mesh_.step.size(), wrong);
    return;
  }
  flat_ = numbers_where(threads_, among_->size(), [&](std::size_t k) { return wrong((*among_)[k]); });
  for (std::size_t& t : flat_) t = (*among_)[t];
}

/// The flat ones among those that were flat and those that were changed.
void Mender::find_flat_again() {
  flat_.insert(flat_.end(), changed_.begin(), changed_.end());
  std::sort(flat_.begin(), flat_.end());
  flat_.erase(std::unique(flat_.begin(), flat_.end()), flat_.end());
  const auto is_done = [&](std::size_t t) { return is_gone(t) || !is_flat(corners(t)); };
  flat_.erase(std::remove_if(flat_.begin(), flat_.end(), is_done), flat_.end());
  changed_.clear();
}

/// Whether all is gathered that mending the flat triangles asks for.
bool Mender::knows_around() const {
  const auto knows = [&](std::uint32_t v) { return place_[v] != kNone; };
  const auto knows_all = [&](std::size_t t) {
    const Corners c = corners(t);
    return std::all_of(c.begin(), c.end(), knows);
  };
  const auto knows_beside = [&](std::size_t t) {
    const Corners c = corners(t);
    return knows_all(t) && std::all_of(c.begin(), c.end(), [&](std::uint32_t v) {
             return std::all_of(around(v).begin(), around(v).end(), knows_all);
           });
  };
  return !place_.empty() && std::all_of(flat_.begin(), flat_.end(), knows_beside);
}

/// The triangles around all vertices that flat triangles or their neighbours have.
void Mender::gather_around() {
  place_.assign(mesh_.positions.size() / 3, kNone);
  around_.clear();
  constexpr std::uint8_t kOfFlat = 1, kWanted = 2;
  std::vector<std::uint8_t> near(place_.size(), 0);
  const auto want = [&](std::uint32_t v) {
    if (place_[v] != kNone) return;
    place_[v] = static_cast<std::uint32_t>(around_.size());
    around_.emplace_back().reserve(kAround);
    near[v] |= kWanted;
  };
  const auto has = [&](std::size_t t, std::uint8_t mark) {
    const Corners c = corners(t);
    return ((near[c[0]] | near[c[1]] | near[c[2]]) & mark) != 0;
  };
  for (const std::size_t t : flat_)
    for (const std::uint32_t v : corners(t)) near[v] = kOfFlat;
  const auto beside =
      numbers_where(threads_, mesh_.step.size(), [&](std::size_t t) { return has(t, kOfFlat); });
  for (const std::size_t t : beside)
    for (const std::uint32_t v : corners(t)) want(v);
  const auto around = numbers_where(threads_, mesh_.step.size(),
                                    [&](std::size_t t) { return has(t, kWanted) && !is_gone(t); });
  for (const std::size_t t : around)
    for (const std::uint32_t v : corners(t))
      if (place_[v] != kNone) around_[place_[v]].push_back(static_cast<std::uint32_t>(t));
}

/// The triangle with the edge from a to b; SIZE_MAX if there is none.
std::size_t Mender::across(std::uint32_t a, std::uint32_t b) const {
  for (const std::uint32_t t : around(a)) {
    if (is_gone(t)) continue;
    const Corners c = corners(t);
    for (std::size_t k = 0; k < 3; ++k)
      if (c[k] == a && c[(k + 1) % 3] == b) return t;
  }
  return SIZE_MAX;
}

bool Mender::joined(std::uint32_t a, std::uint32_t b) const {
  return across(a, b) != SIZE_MAX || across(b, a) != SIZE_MAX;
}

/// Turns the edge that a flat triangle shares with the neighbour of its longest side.
bool Mender::flip(std::size_t t) {
  const Corners c = corners(t);
  const auto k = static_cast<std::size_t>(longest_side(c));
  const std::uint32_t a = c[(k + 1) % 3], middle = c[(k + 2) % 3], b = c[k];  // a, middle, b in order
  const std::size_t neighbour = across(a, b);
  if (neighbour == SIZE_MAX) return false;
  std::uint32_t far = kNone;
  for (const std::uint32_t v : corners(neighbour))
    if (v != a && v != b) far = v;
  const Corners one{a, middle, far}, other{middle, b, far};
  if (far == kNone || joined(middle, far) || is_flat(one) || is_flat(other)) return false;
  set(t, one);
  set(neighbour, other);
  mesh_.step[t] = mesh_.step[neighbour];
  around_[place_[far]].push_back(static_cast<std::uint32_t>(t));
  around_[place_[middle]].push_back(static_cast<std::uint32_t>(neighbour));
  return true;
}

/// Makes one of two vertices that lie at one place and have an edge, if that leaves every edge two triangles.
bool Mender::collapse(std::uint32_t keep, std::uint32_t gone) {
  const auto neighbours = [&](std::uint32_t v) {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t t : around(v)) {
      const Corners c = corners(t);
      if (is_gone(t) || std::find(c.begin(), c.end(), v) == c.end()) continue;
      for (const std::uint32_t other : c)
        if (other != v) found.push_back(other);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  };
  const std::vector<std::uint32_t> a = neighbours(keep), b = neighbours(gone);
  std::vector<std::uint32_t> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  if (common.size() != 2 || joined(common[0], common[1])) return false;
  for (const std::uint32_t t : std::vector(around(gone))) {
    Corners c = corners(t);
    if (is_gone(t) || std::find(c.begin(), c.end(), gone) == c.end()) continue;
    const bool had_both = std::find(c.begin(), c.end(), keep) != c.end();
    std::replace(c.begin(), c.end(), gone, keep);
    set(t, had_both ? Corners{keep, keep, keep} : c);
    if (had_both) gone_.push_back(t);
    if (!had_both) around_[place_[keep]].push_back(t);
  }
  gone_vertices_.push_back(gone);
  return true;
}

bool Mender::mend(std::size_t t) {
  const Corners c = corners(t);
  for (std::size_t k = 0; k < 3; ++k)
    if (point(c[k]) == point(c[(k + 1) % 3])) return collapse(c[k], c[(k + 1) % 3]);
  return flip(t);
}

void Mender::drop_gone_triangles() {
  const std::size_t kept = fill_holes(gone_, mesh_.step.size(), [&](std::size_t from, std::size_t to) {
    mesh_.step[to] = mesh_.step[from];
    std::copy_n(mesh_.triangles.data() + 3 * from, 3, mesh_.triangles.data() + 3 * to);
  });
  mesh_.triangles.resize(3 * kept);
  mesh_.step.resize(kept);
}

void Mender::drop_gone_vertices() {
  if (gone_vertices_.empty()) return;
  const std::size_t count = mesh_.positions.size() / 3;
  std::vector<std::uint32_t> moved(gone_vertices_.size(), kNone);  // where the last vertices are now
  const std::size_t kept = fill_holes(gone_vertices_, count, [&](std::size_t from, std::size_t to) {
    moved[from - (count - gone_vertices_.size())] = static_cast<std::uint32_t>(to);
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

void Mender::mend_all() {
  find_flat();
  for (int round = 0; round < kMaxRounds && !flat_.empty(); ++round) {
    if (!knows_around()) gather_around();
    bool any = false;
    for (const std::size_t t : flat_)
      if (!is_gone(t) && is_flat(corners(t))) any = mend(t) || any;
    if (!any) break;
    find_flat_again();
  }
}

void Mender::run() {
  mend_all();
  drop_gone_triangles();
  drop_gone_vertices();
}

}  // namespace

void remove_degenerate_triangles(Mesh& mesh, unsigned threads) { Mender(mesh, threads, nullptr).run(); }

void remove_degenerate_triangles(Mesh& mesh, unsigned threads, const std::vector<std::size_t>& among) {
  Mender(mesh, threads, &among).run();
}

}  // namespace kerf::meshing
