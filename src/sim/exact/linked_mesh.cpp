// Links between neighbouring triangles, and the changes: flipping an edge, splitting edges, repairing folds.
#include "sim/exact/linked_mesh.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace kerf::sim {
namespace {

/// A flip can fold another triangle, which is repaired in the next round.
constexpr int kMaxUnfolds = 8;

}  // namespace

LinkedMesh::LinkedMesh(Mesh& mesh, Point3 low, unsigned threads) : mesh_(mesh), low_(low) {
  link(threads);
  update_normals(threads);
  marked_.assign(mesh.triangles.size(), 0);
  split_number_.assign(mesh.step.size(), kNone);
}

/// Sorts the sides by the lower of their vertices (counting sort) and compares the few with the same one.
void LinkedMesh::link(unsigned threads) {
  const std::size_t corners = mesh_.triangles.size(), count = mesh_.positions.size() / 3;
  const std::uint32_t* of = mesh_.triangles.data();
  std::vector<std::uint32_t> first(count + 1, 0), sides(corners);
  first_.assign(count, kNone);
  across_.assign(corners, kNone);
  for (std::uint32_t c = 0; c < corners; ++c) {
    ++first[std::min(of[c], of[next(c)]) + std::size_t{1}];
    first_[of[c]] = c;
  }
  for (std::size_t v = 0; v < count; ++v) first[v + 1] += first[v];
  for (std::uint32_t c = 0; c < corners; ++c) sides[first[std::min(of[c], of[next(c)])]++] = c;
  // first[v] has moved to the end of v's sides, which is the start of those of v + 1.
  constexpr std::size_t kAtATime = 1 << 14;
  const auto work = [&](std::size_t piece) {
    for (std::size_t v = piece * kAtATime; v < std::min(count, (piece + 1) * kAtATime); ++v)
      for (std::uint32_t k = v == 0 ? 0 : first[v - 1]; k < first[v]; ++k)
        for (std::uint32_t n = k + 1; n < first[v] && across_[sides[k]] == kNone; ++n) {
          const std::uint32_t one = sides[k], other = sides[n];
          if (across_[other] != kNone || of[one] != of[next(other)] || of[other] != of[next(one)]) continue;
          across_[one] = other;
          across_[other] = one;
        }
  };
  parallel_for(threads, (count + kAtATime - 1) / kAtATime, work, [] { return false; });
}

void LinkedMesh::update_normals(unsigned threads) {
  constexpr std::size_t kAtATime = 1 << 14;
  const std::size_t count = mesh_.step.size();
  normal_.resize(3 * count);
  const auto work = [&](std::size_t piece) {
    for (std::size_t t = piece * kAtATime; t < std::min(count, (piece + 1) * kAtATime); ++t)
      update_normal(static_cast<std::uint32_t>(t));
  };
  parallel_for(threads, (count + kAtATime - 1) / kAtATime, work, [] { return false; });
}

Point3 LinkedMesh::facing(std::uint32_t triangle) const {
  const std::uint32_t* c = mesh_.triangles.data() + std::size_t{3} * triangle;
  const Point3 a = point(c[0]);
  return cross(point(c[1]) - a, point(c[2]) - a);
}

void LinkedMesh::update_normal(std::uint32_t triangle) {
  const Point3 n = facing(triangle);
  const double size = length(n), per_size = size > 0.0 ? 1.0 / size : 0.0;
  for (int axis = 0; axis < 3; ++axis)
    normal_[std::size_t{3} * triangle + static_cast<std::size_t>(axis)] =
        static_cast<float>(per_size * n[axis]);
}

Point3 LinkedMesh::centroid(std::uint32_t triangle) const {
  const std::uint32_t* c = mesh_.triangles.data() + std::size_t{3} * triangle;
  return (1.0 / 3.0) * (point(c[0]) + point(c[1]) + point(c[2]));
}

std::uint32_t LinkedMesh::find_side(std::uint32_t a, std::uint32_t b) const {
  std::uint32_t found = kNone;
  corners_around(a, [&](std::uint32_t corner) {
    if (vertex(next(corner)) == b) found = corner;
    if (found == kNone && vertex(before(corner)) == b) found = before(corner);
  });
  return found;
}

void LinkedMesh::mark(std::uint32_t corner) {
  marked_[corner] = 1;
  if (across_[corner] != kNone) marked_[across_[corner]] = 1;
}

void LinkedMesh::move(std::uint32_t vertex, Point3 position) {
  const Point3 at = position + low_;
  for (int axis = 0; axis < 3; ++axis)
    mesh_.positions[std::size_t{3} * vertex + static_cast<std::size_t>(axis)] = static_cast<float>(at[axis]);
}

std::uint32_t LinkedMesh::add_vertex(Point3 position) {
  mesh_.positions.resize(mesh_.positions.size() + 3);
  first_.push_back(kNone);
  const auto vertex = static_cast<std::uint32_t>(first_.size() - 1);
  move(vertex, position);
  return vertex;
}

// ---- flipping

void LinkedMesh::flip(std::uint32_t corner) {
  const std::uint32_t other = across_[corner], t = 3 * (corner / 3), u = 3 * (other / 3);
  const std::array<std::uint32_t, 4> sides{next(corner), before(corner), next(other), before(other)};
  std::array<std::uint32_t, 4> beyond{};  // of the sides bc, ca, ad, db
  std::array<std::uint8_t, 4> marks{};
  for (std::size_t k = 0; k < 4; ++k) {
    beyond[k] = across_[sides[k]];
    marks[k] = marked_[sides[k]];
  }
  const std::uint32_t a = vertex(corner), b = vertex(other);
  const std::uint32_t c = vertex(sides[1]), d = vertex(sides[3]);
  std::uint32_t* const corners = mesh_.triangles.data();
  std::copy_n(std::array{a, d, c}.data(), 3, corners + t);
  std::copy_n(std::array{d, b, c}.data(), 3, corners + u);
  const std::array<std::uint32_t, 4> now{u + 1, t + 2, t, u};
  for (std::size_t k = 0; k < 4; ++k) {
    join(now[k], beyond[k]);
    marked_[now[k]] = marks[k];
  }
  join(t + 1, u + 2);
  marked_[t + 1] = marked_[u + 2] = 0;
  first_[a] = t;
  first_[d] = u;
  first_[b] = u + 1;
  first_[c] = u + 2;
}

// ---- splitting

/// A triangle to be split: the new vertices on its sides (kNone: none), and the corners of the one or two
/// sides that replace each side, in order.
struct LinkedMesh::SplitTriangle {
  std::uint32_t triangle = 0;
  std::array<std::uint32_t, 3> new_vertices{kNone, kNone, kNone};
  std::array<std::uint32_t, 3> beyond{};  // sides, before
  std::array<std::array<std::uint32_t, 2>, 3> parts{};
  std::array<std::uint8_t, 3> marks{};
  std::array<std::uint32_t, 4> made{};
  std::size_t count = 0;  // of triangles made
};

std::uint32_t LinkedMesh::new_triangle(std::uint32_t like) {
  const auto triangle = static_cast<std::uint32_t>(mesh_.step.size());
  mesh_.triangles.resize(mesh_.triangles.size() + 3);
  mesh_.step.push_back(mesh_.step[like]);
  across_.resize(mesh_.triangles.size(), kNone);
  marked_.resize(mesh_.triangles.size(), 0);
  split_number_.push_back(kNone);
  for (std::size_t k = 0; k < 3; ++k) normal_.push_back(normal_[std::size_t{3} * like + k]);
  return triangle;
}

/// Replaces a triangle by two to four triangles over its corners and the new vertices on its sides.
void LinkedMesh::split_triangle(SplitTriangle& split) {
  std::array<std::uint32_t, 6> polygon{};  // corners and new vertices in order
  std::array<std::uint8_t, 6> side{};  // from there to the next: number of the side, + 4 for its second half
  std::size_t count = 0, first_new = 0;
  for (std::uint8_t k = 0; k < 3; ++k) {
    const std::uint32_t corner = 3 * split.triangle + k;
    split.beyond[k] = across_[corner];
    split.marks[k] = marked_[corner];
    side[count] = k;
    polygon[count++] = vertex(corner);
    if (split.new_vertices[k] == kNone) continue;
    first_new = count;
    side[count] = k + 4;
    polygon[count++] = split.new_vertices[k];
  }
  // inner[m][n]: the inner side from polygon[m] to polygon[n], until the other triangle at it is added.
  std::array<std::array<std::uint32_t, 6>, 6> inner{};
  for (auto& row : inner) row.fill(kNone);
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    const std::uint32_t triangle = split.count == 0 ? split.triangle : new_triangle(split.triangle);
    split.made[split.count++] = triangle;
    const std::array<std::size_t, 3> at{a, b, c};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::size_t from = at[k], to = at[(k + 1) % 3];
      const std::uint32_t corner = 3 * triangle + k;
      mesh_.triangles[corner] = polygon[from];
      first_[polygon[from]] = corner;
      marked_[corner] = 0;
      if (to == (from + 1) % count) {
        split.parts[side[from] % 4][side[from] / 4] = corner;
      } else if (inner[to][from] != kNone) {
        join(corner, inner[to][from]);
      } else {
        inner[from][to] = corner;
      }
    }
  };
  if (count == 6) {
    for (std::size_t k = 0; k < 3; ++k) add(2 * k, 2 * k + 1, (2 * k + 5) % 6);
    return add(1, 3, 5);
  }
  // Four or five corners: a fan around the last new vertex.
  for (std::size_t k = 1; k + 1 < count; ++k)
    add(first_new, (first_new + k) % count, (first_new + k + 1) % count);
}

/// Links the outer sides of a split triangle to the neighbours, which may be split too.
void LinkedMesh::join_split(const SplitTriangle& split, const std::vector<SplitTriangle>& all) {
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_split = split.new_vertices[k] != kNone;
    const std::uint32_t beyond = split.beyond[k];
    const std::uint32_t number = beyond == kNone ? kNone : split_number_[beyond / 3];
    if (number == kNone) {
      join(split.parts[k][0], beyond);
      if (is_split) across_[split.parts[k][1]] = kNone;
    } else {
      const auto& parts = all[number].parts[beyond % 3];
      across_[split.parts[k][0]] = parts[is_split ? 1 : 0];
      if (is_split) across_[split.parts[k][1]] = parts[0];
    }
    if (!is_split) marked_[split.parts[k][0]] = split.marks[k];
  }
}

std::vector<std::uint32_t> LinkedMesh::split(const std::vector<EdgeSplit>& splits) {
  std::vector<SplitTriangle> all;
  const auto take = [&](std::uint32_t corner, std::uint32_t vertex) {
    std::uint32_t& number = split_number_[corner / 3];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(all.size());
      all.emplace_back().triangle = corner / 3;
    }
    all[number].new_vertices[corner % 3] = vertex;
  };
  for (const EdgeSplit& each : splits) {
    take(each.corner, each.vertex);
    if (across_[each.corner] != kNone) take(across_[each.corner], each.vertex);
  }
  for (SplitTriangle& each : all) split_triangle(each);
  for (const SplitTriangle& each : all) join_split(each, all);
  std::vector<std::uint32_t> made;
  for (const SplitTriangle& split : all) {
    split_number_[split.triangle] = kNone;
    made.insert(made.end(), split.made.begin(),
                split.made.begin() + static_cast<std::ptrdiff_t>(split.count));
  }
  return made;
}

// ---- folds

bool LinkedMesh::faces(std::uint32_t a, std::uint32_t b, std::uint32_t c, Point3 outwards) const {
  const Point3 p = point(a);
  return dot(cross(point(b) - p, point(c) - p), outwards) >= 0.0;
}

/// Flips the longest side of a triangle if both resulting triangles face the neighbour's way.
bool LinkedMesh::unfold(std::uint32_t triangle, std::vector<std::uint32_t>& changed) {
  std::uint32_t side = 3 * triangle;
  double longest = -1.0;
  for (std::uint32_t c = 3 * triangle; c < 3 * triangle + 3; ++c) {
    const double size = distance(point(vertex(c)), point(vertex(next(c))));
    if (size <= longest) continue;
    longest = size;
    side = c;
  }
  const std::uint32_t beyond = across_[side];
  if (beyond == kNone || beyond / 3 == triangle) return false;
  const std::uint32_t neighbour = beyond / 3;
  const std::uint32_t a = vertex(side), b = vertex(beyond), c = vertex(before(side)),
                      d = vertex(before(beyond));
  if (c == d || find_side(c, d) != kNone || has_no_area(a, d, c) || has_no_area(d, b, c)) return false;
  const Point3 outwards = normal(neighbour);
  if (!faces(a, d, c, outwards) || !faces(d, b, c, outwards)) return false;
  flip(side);
  std::copy_n(normal_.begin() + static_cast<std::ptrdiff_t>(std::size_t{3} * neighbour), 3,
              normal_.begin() + static_cast<std::ptrdiff_t>(std::size_t{3} * triangle));
  mesh_.step[triangle] = mesh_.step[neighbour];
  changed.push_back(neighbour);
  return true;
}

void LinkedMesh::unfold_all(std::vector<std::uint32_t>& changed) {
  std::vector<std::uint32_t> folded;
  for (const std::uint32_t t : changed)
    if (is_folded(t)) folded.push_back(t);
  for (int round = 0; round < kMaxUnfolds && !folded.empty(); ++round) {
    bool any = false;
    std::vector<std::uint32_t> again;
    for (const std::uint32_t t : folded) {
      if (!is_folded(t)) continue;
      any = unfold(t, changed) || any;
      if (is_folded(t)) again.push_back(t);
    }
    if (!any) break;
    folded = std::move(again);
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
}

}  // namespace kerf::sim
