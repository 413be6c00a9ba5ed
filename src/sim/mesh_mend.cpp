// Takes out triangles without area. They come where three corners of a level face lie on one line, and where
// two corners of a line have one height: harmless to the shape, but programs that read a mesh stumble over
// them. Nothing moves, and the mesh stays closed.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/parallel.h"
#include "sim/mesh_build.h"

#include "kerf/geometry.h"

namespace kerf::meshing {
namespace {

/// A flip can leave another flat triangle, which is looked at again; not for ever.
constexpr int kMostRounds = 8;

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
  template <class Test>
  std::vector<std::size_t> find(std::size_t count, const Test& test) const;
  void find_flat();
  void find_flat_again();
  void gather_around();
  const std::vector<std::uint32_t>& around(std::uint32_t v) const { return around_[place_[v]]; }
  std::size_t across(std::uint32_t a, std::uint32_t b) const;
  bool joined(std::uint32_t a, std::uint32_t b) const;
  bool flip(std::size_t t);
  bool collapse(std::uint32_t keep, std::uint32_t gone);
  bool mend(std::size_t t);
  void mend_all();
  void drop_gone();
  void drop_unused();

  Mesh& mesh_;
  unsigned threads_;
  const std::vector<std::size_t>* among_;
  std::vector<std::size_t> flat_, changed_;         // changed: since the flat ones were found
  std::vector<std::size_t> gone_;                   // triangles that are no more
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

/// Numbers below `count` for which test(number) holds, in order.
template <class Test>
std::vector<std::size_t> Mender::find(std::size_t count, const Test& test) const {
  constexpr std::size_t kEach = 1 << 14;
  std::vector<std::vector<std::size_t>> found(count / kEach + 1);
  parallel_for(
      threads_, found.size(),
      [&](std::size_t n) {
        for (std::size_t k = n * kEach; k < std::min((n + 1) * kEach, count); ++k)
          if (test(k)) found[n].push_back(k);
      },
      [] { return false; });
  std::vector<std::size_t> all;
  for (const std::vector<std::size_t>& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void Mender::find_flat() {
  const auto wrong = [&](std::size_t t) { return !is_gone(t) && is_flat(corners(t)); };
  if (among_ == nullptr) {
    flat_ = find(mesh_.step.size(), wrong);
    return;
  }
  flat_ = find(among_->size(), [&](std::size_t k) { return wrong((*among_)[k]); });
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

/// The triangles around all vertices that flat triangles or their neighbours have.
void Mender::gather_around() {
  place_.assign(mesh_.positions.size() / 3, kNone);
  around_.clear();
  const auto want = [&](std::uint32_t v) {
    if (place_[v] != kNone) return;
    place_[v] = static_cast<std::uint32_t>(around_.size());
    around_.emplace_back();
  };
  std::vector<std::uint8_t> near(place_.size(), 0);
  for (const std::size_t t : flat_)
    for (const std::uint32_t v : corners(t)) near[v] = 1;
  const auto beside = find(mesh_.step.size(), [&](std::size_t t) {
    const Corners c = corners(t);
    return (near[c[0]] | near[c[1]] | near[c[2]]) != 0;
  });
  for (const std::size_t t : beside)
    for (const std::uint32_t v : corners(t)) want(v);
  const auto around = find(mesh_.step.size(), [&](std::size_t t) {
    const Corners c = corners(t);
    return !is_gone(t) && (place_[c[0]] & place_[c[1]] & place_[c[2]]) != kNone;
  });
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
  return true;
}

bool Mender::mend(std::size_t t) {
  const Corners c = corners(t);
  for (std::size_t k = 0; k < 3; ++k)
    if (point(c[k]) == point(c[(k + 1) % 3])) return collapse(c[k], c[(k + 1) % 3]);
  return flip(t);
}

void Mender::drop_gone() {
  std::sort(gone_.begin(), gone_.end());
  std::size_t kept = 0, next = 0;
  for (std::size_t n = 0; n <= gone_.size(); ++n) {
    const std::size_t end = n < gone_.size() ? gone_[n] : mesh_.step.size();
    if (kept != next) {
      std::copy(mesh_.step.data() + next, mesh_.step.data() + end, mesh_.step.data() + kept);
      std::copy(mesh_.triangles.data() + 3 * next, mesh_.triangles.data() + 3 * end,
                mesh_.triangles.data() + 3 * kept);
    }
    kept += end - next;
    next = end + 1;
  }
  mesh_.triangles.resize(3 * kept);
  mesh_.step.resize(kept);
}

/// Leaves out the vertices that no triangle has any more.
void Mender::drop_unused() {
  std::vector<std::uint32_t> number(mesh_.positions.size() / 3, kNone);
  for (const std::uint32_t v : mesh_.triangles) number[v] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    for (std::size_t axis = 0; axis < 3; ++axis)
      mesh_.positions[std::size_t{3} * kept + axis] = mesh_.positions[3 * v + axis];
    number[v] = kept++;
  }
  mesh_.positions.resize(std::size_t{3} * kept);
  for (std::uint32_t& v : mesh_.triangles) v = number[v];
}

void Mender::mend_all() {
  find_flat();
  for (int round = 0; round < kMostRounds && !flat_.empty(); ++round) {
    gather_around();
    bool any = false;
    for (const std::size_t t : flat_)
      if (!is_gone(t) && is_flat(corners(t))) any = mend(t) || any;
    if (!any) break;
    find_flat_again();
  }
}

void Mender::run() {
  mend_all();
  if (gone_.empty()) return;
  drop_gone();
  drop_unused();
}

}  // namespace

void mend_flat_triangles(Mesh& mesh, unsigned threads) { Mender(mesh, threads, nullptr).run(); }

void mend_flat_triangles(Mesh& mesh, unsigned threads, const std::vector<std::size_t>& among) {
  Mender(mesh, threads, &among).run();
}

}  // namespace kerf::meshing
