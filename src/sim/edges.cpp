// Which edges stray, where their new vertices go, and the triangles that they part.
#include "sim/edges.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "sim/mesh_build.h"
#include "sim/parallel.h"

namespace kerf::sim {
namespace {

/// Edges shorter than this are left alone, pitches.
constexpr double kShortest = 0.2;
/// Rounds of turned edges before vertices are added.
constexpr int kMostFlips = 3, kMostFlipsLater = 1;
/// The other diagonal is taken where it strays by less than this share.
constexpr double kBetter = 0.5;
/// Triangles that turning would make thinner than this are not made, mm.
constexpr double kThinnest = 1e-4;
/// A new vertex is no further from its edge than this share of the edge.
constexpr double kMostMoved = 0.35;
using meshing::kNone;

/// Of the triangles around a vertex those that face within so much (cosine) of a given one are its surface;
/// a triangle that bridges an edge belongs to both sides.
constexpr double kOneSurface = 0.2;

/// Normal of a surface at a vertex: the sum of those of its triangles, as long as 1.
Point3 normal_at(const Fans& fans, std::uint32_t vertex, Point3 facing) {
  Point3 sum;
  fans.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = fans.normal(triangle);
    if (dot(normal, facing) >= kOneSurface) sum = sum + normal;
  });
  const double size = length(sum);
  return size > 0.0 ? (1.0 / size) * sum : sum;
}

}  // namespace

EdgeSplitter::EdgeSplitter(Mesh& mesh, const Workpiece::Body& body, const SweepsByTile& sweeps,
                           std::vector<bool> bends, double tolerance, unsigned threads)
    : mesh_(mesh),
      low_(body.bounds.low),
      size_(body.bounds.size()),
      pitch_(body.pitch),
      tolerance_(tolerance),
      is_block_(!body.start),
      sweeps_(sweeps),
      bends_(std::move(bends)),
      threads_(threads) {}

EdgeSplitter::Ends EdgeSplitter::ends_of(std::uint32_t corner) const {
  const std::uint32_t first = corner / 3 * 3;
  return {mesh_.triangles[corner], mesh_.triangles[first + (corner + 1 - first) % 3]};
}

Point3 EdgeSplitter::middle_of(const Fans& fans, std::uint32_t corner) const {
  const Ends ends = ends_of(corner);
  return 0.5 * (fans.point(ends.a) + fans.point(ends.b));
}

/// The triangle on the other side of an edge; the same one if there is none.
std::uint32_t EdgeSplitter::across(const Fans& fans, std::uint32_t corner) const {
  const Ends ends = ends_of(corner);
  std::uint32_t other = corner / 3;
  fans.around(ends.a, [&](std::uint32_t t) {
    for (std::uint32_t k = 3 * t; k < 3 * t + 3; ++k)
      if (t != corner / 3 && mesh_.triangles[k] == ends.b) other = t;
  });
  return other;
}

/// By how much the surfaces beside an edge turn from its begin to its end, radians. A circle strays from its
/// chord by an eighth of the chord times this.
double EdgeSplitter::bend_of(const Fans& fans, std::uint32_t corner) const {
  const Ends ends = ends_of(corner);
  double most = 0.0;
  for (const std::uint32_t triangle : {corner / 3, across(fans, corner)}) {
    const Point3 facing = fans.normal(triangle);
    most = std::max(most, distance(normal_at(fans, ends.a, facing), normal_at(fans, ends.b, facing)));
  }
  return most;
}

/// Edges of surfaces that were cut, whose ends' normals say that the surface may bend away between them.
void EdgeSplitter::find_suspects(const Fans& fans) {
  constexpr std::size_t kAtATime = 3 << 13;
  const std::size_t corners = mesh_.triangles.size(), pieces = (corners + kAtATime - 1) / kAtATime;
  std::vector<std::vector<Spot>> found(pieces);
  const auto work = [&](std::size_t piece) {
    for (std::size_t c = piece * kAtATime; c < std::min(corners, (piece + 1) * kAtATime); ++c) {
      const auto corner = static_cast<std::uint32_t>(c);
      const Ends ends = ends_of(corner);
      if (ends.a > ends.b || ends.b < first_new_) continue;
      if (first_new_ == 0 && !bends_[ends.a] && !bends_[ends.b]) continue;
      const double size = distance(fans.point(ends.a), fans.point(ends.b));
      if (size < kShortest * pitch_ || size * bend_of(fans, corner) <= 8.0 * tolerance_) continue;
      found[piece].push_back(sweeps_.spot_at(middle_of(fans, corner), corner));
    }
  };
  parallel_for(threads_, pieces, work, [] { return false; });
  spots_.clear();
  for (const std::vector<Spot>& some : found) spots_.insert(spots_.end(), some.begin(), some.end());
  std::sort(spots_.begin(), spots_.end());
}

void EdgeSplitter::look_at(const Fans& fans, std::size_t n, Around& around) {
  const std::uint32_t corner = spots_[n].number, triangle = corner / 3;
  const Ends ends = ends_of(corner);
  const Point3 a = fans.point(ends.a), b = fans.point(ends.b);
  const std::uint32_t other = across(fans, corner);
  const bool stock = fans.step(triangle) == kStockSurface, other_stock = fans.step(other) == kStockSurface;
  if (stock && other_stock) return;
  std::array<bool, 3> fixed{};
  for (int axis = 0; axis < 3; ++axis) {
    const bool low = a[axis] <= kOnBlock && b[axis] <= kOnBlock;
    const bool high = std::min(a[axis], b[axis]) >= size_[axis] - kOnBlock;
    fixed[static_cast<std::size_t>(axis)] = (low || high) && (axis < 2 || stock || other_stock);
  }
  const Point3 middle = 0.5 * (a + b);
  const Nearby& nearby = around.all(middle);
  if (std::abs(nearby.at(middle).value) <= tolerance_) return;
  const int most_flips = first_new_ == 0 ? kMostFlips : kMostFlipsLater;
  if (other != triangle && flips_ < most_flips && can_turn(fans, triangle, other, ends)) {
    const Point3 across = 0.5 * (fans.point(opposite(triangle, ends)) + fans.point(opposite(other, ends)));
    if (miss_at(nearby, across) < kBetter * miss_at(nearby, middle)) {
      found_[n].turns = true;
      return;
    }
  }
  // What is to be met faces as the surfaces do that were cut.
  const Point3 outwards = stock         ? fans.normal(other)
                          : other_stock ? fans.normal(triangle)
                                        : fans.normal(triangle) + fans.normal(other);
  Found found{true, false, middle};
  Point3 normal;
  if (!put_on_surface(nearby, kMostMoved * distance(a, b), outwards, fixed, found.at, normal)) return;
  for (int axis = 0; axis < 3; ++axis)
    if (found.at[axis] < 0.0 || found.at[axis] > size_[axis]) return;
  found_[n] = found;
}

/// The corner of a triangle that is not on an edge.
std::uint32_t EdgeSplitter::opposite(std::uint32_t triangle, Ends ends) const {
  const std::uint32_t* c = mesh_.triangles.data() + std::size_t{3} * triangle;
  return *std::find_if(c, c + 3, [&](std::uint32_t v) { return v != ends.a && v != ends.b; });
}

/// How far a place is from the surface of what is left.
double EdgeSplitter::miss_at(const Nearby& nearby, Point3 place) const {
  return is_block_ ? miss_in_block(nearby, size_, place) : std::abs(nearby.at(place).value);
}

/// Whether two triangles may have their other diagonal: it is no edge yet, and both then face as they did.
bool EdgeSplitter::can_turn(const Fans& fans, std::uint32_t triangle, std::uint32_t other, Ends ends) const {
  const std::uint32_t c = opposite(triangle, ends), d = opposite(other, ends);
  if (c == d) return false;
  bool is_edge = false;
  fans.around(c, [&](std::uint32_t t) {
    const std::uint32_t* corners = mesh_.triangles.data() + std::size_t{3} * t;
    is_edge = is_edge || std::find(corners, corners + 3, d) != corners + 3;
  });
  if (is_edge) return false;
  const Point3 a = fans.point(ends.a), b = fans.point(ends.b), pc = fans.point(c), pd = fans.point(d);
  const Point3 facing = fans.normal(triangle) + fans.normal(other);
  const Point3 one = cross(pd - a, pc - a), two = cross(b - pd, pc - pd);
  const double least = kThinnest * distance(pc, pd);
  return dot(one, facing) > least * length(facing) && dot(two, facing) > least * length(facing);
}

/// Triangle (a, b, c) and other (b, a, d) become (a, d, c) and (d, b, c).
void EdgeSplitter::turn(std::uint32_t triangle, std::uint32_t other, Ends ends) {
  const std::uint32_t c = opposite(triangle, ends), d = opposite(other, ends);
  const auto set = [&](std::uint32_t t, const std::array<std::uint32_t, 3>& corners) {
    std::copy(corners.begin(), corners.end(), mesh_.triangles.data() + std::size_t{3} * t);
  };
  set(triangle, {ends.a, d, c});
  set(other, {d, ends.b, c});
  // What comes to lie on the block again is found later.
  std::uint32_t &step = mesh_.step[triangle], &other_step = mesh_.step[other];
  if (step == kStockSurface) step = other_step;
  if (other_step == kStockSurface) other_step = step;
}

/// False if no edge was turned.
bool EdgeSplitter::flip(const Fans& fans) {
  std::vector<bool> touched(mesh_.step.size(), false);
  bool any = false;
  for (std::size_t n = 0; n < spots_.size(); ++n) {
    if (!found_[n].turns) continue;
    const std::uint32_t corner = spots_[n].number, triangle = corner / 3, other = across(fans, corner);
    if (other == triangle || touched[triangle] || touched[other]) continue;
    // A diagonal that another pair has got in the meantime would be an edge of four.
    const Ends ends = ends_of(corner);
    bool near_touched = false;
    fans.around(opposite(triangle, ends),
                [&](std::uint32_t t) { near_touched = near_touched || touched[t]; });
    if (near_touched) continue;
    turn(triangle, other, ends);
    touched[triangle] = touched[other] = true;
    any = true;
  }
  if (any) ++flips_;
  return any;
}

void EdgeSplitter::add_vertex(Point3 at, Point3 middle, MeshState& straight) {
  for (int axis = 0; axis < 3; ++axis) {
    mesh_.positions.push_back(static_cast<float>(at[axis] + low_[axis]));
    straight.positions.push_back(static_cast<float>(middle[axis] + low_[axis]));
  }
}

/// Replaces a triangle by those between its corners and the new vertices on its sides (kNone: none).
void EdgeSplitter::part_triangle(std::size_t triangle, const std::array<std::uint32_t, 3>& middles,
                                 MeshState& straight) {
  std::array<std::uint32_t, 6> ring{};  // corners and new vertices in order
  std::size_t count = 0, first_new = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    ring[count++] = mesh_.triangles[3 * triangle + k];
    if (middles[k] == kNone) continue;
    first_new = count;
    ring[count++] = middles[k];
  }
  const std::array<float, 3> facing{straight.outwards[3 * triangle], straight.outwards[3 * triangle + 1],
                                    straight.outwards[3 * triangle + 2]};
  bool is_first = true;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::array<std::uint32_t, 3> corners{a, b, c};
    if (std::exchange(is_first, false)) {
      std::copy(corners.begin(), corners.end(),
                mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(3 * triangle));
      return;
    }
    mesh_.triangles.insert(mesh_.triangles.end(), corners.begin(), corners.end());
    mesh_.step.push_back(mesh_.step[triangle]);
    straight.outwards.insert(straight.outwards.end(), facing.begin(), facing.end());
  };
  if (count == 6) {
    for (std::size_t k = 0; k < 3; ++k) add(ring[2 * k], ring[2 * k + 1], ring[(2 * k + 5) % 6]);
    return add(ring[1], ring[3], ring[5]);
  }
  // From one new vertex all others are seen.
  for (std::size_t k = 1; k + 1 < count; ++k)
    add(ring[first_new], ring[(first_new + k) % count], ring[(first_new + k + 1) % count]);
}

bool EdgeSplitter::part(const Fans& fans, MeshState& straight) {
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of;
  std::vector<bool> has_new(fans.vertices(), false);
  straight.positions = mesh_.positions;
  straight.outwards = fans.normals();
  first_new_ = static_cast<std::uint32_t>(fans.vertices());
  flips_ = 0;
  for (std::size_t n = 0; n < spots_.size(); ++n) {
    if (!found_[n].strays) continue;
    const Ends ends = ends_of(spots_[n].number);
    vertex_of[meshing::edge_key(ends.a, ends.b)] = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
    has_new[ends.a] = has_new[ends.b] = true;
    add_vertex(found_[n].at, middle_of(fans, spots_[n].number), straight);
  }
  const std::size_t triangles = mesh_.step.size();
  for (std::size_t t = 0; t < triangles && !vertex_of.empty(); ++t) {
    const std::uint32_t* c = mesh_.triangles.data() + 3 * t;
    if (has_new[c[0]] + has_new[c[1]] + has_new[c[2]] < 2) continue;
    std::array<std::uint32_t, 3> middles{kNone, kNone, kNone};
    bool any = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = vertex_of.find(meshing::edge_key(c[k], c[(k + 1) % 3]));
      if (found == vertex_of.end()) continue;
      middles[k] = found->second;
      any = true;
    }
    if (any) part_triangle(t, middles, straight);
  }
  return !vertex_of.empty();
}

}  // namespace kerf::sim
