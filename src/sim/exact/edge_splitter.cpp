// Which edges stray, where their new vertices go, and which get the other diagonal.
#include "sim/exact/edge_splitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace kerf::sim {
namespace {

/// Edges shorter than this are left alone, pitches.
constexpr double kShortest = 0.2;
/// The other diagonal is taken where it strays by less than this share.
constexpr double kBetter = 0.5;
/// Triangles that turning would make thinner than this are not made, mm.
constexpr double kThinnest = 1e-4;
/// A new vertex is no further from its edge than this share of the edge.
constexpr double kMaxMoved = 0.35;

/// Of the triangles around a vertex those that face within so much (cosine) of a given one are its surface;
/// a triangle that bridges an edge belongs to both sides.
constexpr double kOneSurface = 0.2;
/// Triangles that all face within half that angle of their mean are one surface, whichever is asked for.
const double kAllOneSurface = std::sqrt(0.5 * (1.0 + kOneSurface));

/// Pieces of work have so many triangles or vertices.
constexpr std::size_t kAtATime = 1 << 12;

}  // namespace

EdgeSplitter::EdgeSplitter(LinkedMesh& mesh, const Workpiece::Body& body, const SweepsByTile& sweeps,
                           std::vector<bool> bends, double tolerance, unsigned threads)
    : mesh_(mesh),
      size_(body.bounds.size()),
      pitch_(body.pitch),
      tolerance_(tolerance),
      is_block_(!body.start),
      sweeps_(sweeps),
      bends_(std::move(bends)),
      threads_(threads) {
  for (std::uint32_t t = 0; t < mesh_.triangles(); ++t)
    if (bends_[mesh_.vertex(3 * t)] || bends_[mesh_.vertex(3 * t + 1)] || bends_[mesh_.vertex(3 * t + 2)])
      changed_.push_back(t);
}

Point3 EdgeSplitter::middle_of(std::uint32_t corner) const {
  return 0.5 * (mesh_.point(mesh_.vertex(corner)) + mesh_.point(mesh_.vertex(LinkedMesh::next(corner))));
}

/// Normal of a surface at a vertex: the sum of those of its triangles, as long as 1.
Point3 EdgeSplitter::normal_at(std::uint32_t vertex, Point3 facing) const {
  Point3 sum;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    if (dot(normal, facing) >= kOneSurface) sum = sum + normal;
  });
  const double size = length(sum);
  return size > 0.0 ? (1.0 / size) * sum : sum;
}

/// Finds normal_at of a vertex where it is the same for all triangles.
void EdgeSplitter::find_one_surface(std::uint32_t vertex) {
  Point3 sum;
  mesh_.around(vertex, [&](std::uint32_t triangle) { sum = sum + mesh_.normal(triangle); });
  const double size = length(sum);
  bool is_one = size > 0.0;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    is_one = is_one && (dot(normal, sum) >= kAllOneSurface * size || dot(normal, normal) == 0.0);
  });
  const double scale = is_one ? 1.0 / size : 0.0;
  for (int axis = 0; axis < 3; ++axis)
    smoothed_[vertex][static_cast<std::size_t>(axis)] = static_cast<float>(scale * sum[axis]);
}

/// For all vertices of changed triangles.
void EdgeSplitter::find_one_surfaces() {
  smoothed_.resize(mesh_.vertices());
  std::vector<bool> seen(mesh_.vertices(), false);
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t t : changed_)
    for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
      if (seen[mesh_.vertex(c)]) continue;
      seen[mesh_.vertex(c)] = true;
      vertices.push_back(mesh_.vertex(c));
    }
  const auto work = [&](std::size_t piece) {
    for (std::size_t n = piece * kAtATime; n < std::min(vertices.size(), (piece + 1) * kAtATime); ++n)
      find_one_surface(vertices[n]);
  };
  parallel_for(threads_, (vertices.size() + kAtATime - 1) / kAtATime, work, [] { return false; });
}

/// By how much the surfaces beside an edge turn from its begin to its end, radians. A circle strays from its
/// chord by an eighth of the chord times this.
double EdgeSplitter::bend_of(std::uint32_t corner) const {
  const std::uint32_t a = mesh_.vertex(corner), b = mesh_.vertex(LinkedMesh::next(corner));
  const auto known = [&](std::uint32_t vertex) {
    return Point3{smoothed_[vertex][0], smoothed_[vertex][1], smoothed_[vertex][2]};
  };
  const Point3 of_a = known(a), of_b = known(b);
  const bool is_one_a = dot(of_a, of_a) > 0.0, is_one_b = dot(of_b, of_b) > 0.0;
  if (is_one_a && is_one_b) return distance(of_a, of_b);
  double most = 0.0;
  for (const std::uint32_t side : {corner, mesh_.across(corner)}) {
    if (side == kNone) continue;
    const Point3 facing = mesh_.normal(side / 3);
    most = std::max(most,
                    distance(is_one_a ? of_a : normal_at(a, facing), is_one_b ? of_b : normal_at(b, facing)));
  }
  return most;
}

/// Whether an edge's ends' normals say that the surface may bend away between them.
bool EdgeSplitter::is_suspect(std::uint32_t corner) const {
  if (mesh_.is_marked(corner)) return false;
  const std::uint32_t a = mesh_.vertex(corner), b = mesh_.vertex(LinkedMesh::next(corner));
  if (first_new_ == 0 ? !bends_[a] && !bends_[b] : std::max(a, b) < first_new_) return false;
  const double size = distance(mesh_.point(a), mesh_.point(b));
  return size >= kShortest * pitch_ && size * bend_of(corner) > 8.0 * tolerance_;
}

/// Takes the strays out whose triangles have changed; and, if none may be turned any more, those that waited
/// for that.
void EdgeSplitter::look_again() {
  const auto is_taken = [&](const Stray& stray) {
    const std::uint32_t across = mesh_.across(stray.corner);
    const bool has_changed =
        is_changed_[stray.corner / 3] != 0 || (across != kNone && is_changed_[across / 3] != 0);
    if (!has_changed && (may_turn_ || stray.found.verdict != Verdict::turns)) return false;
    const std::uint32_t corner = mesh_.find(stray.a, stray.b);
    if (corner != kNone)  // it was not turned
      queries_.push_back(sweeps_.query_at(middle_of(corner), std::min(corner, mesh_.across(corner))));
    return true;
  };
  strays_.erase(std::remove_if(strays_.begin(), strays_.end(), is_taken), strays_.end());
}

/// Among the edges of changed triangles; where none may be turned any more, what waited for that too.
void EdgeSplitter::find_suspects() {
  find_one_surfaces();
  is_changed_.resize(mesh_.triangles(), 0);
  for (const std::uint32_t t : changed_) is_changed_[t] = 1;
  const auto is_changed = [&](std::uint32_t corner) {
    return corner != kNone && is_changed_[corner / 3] != 0;
  };
  const std::size_t pieces = (changed_.size() + kAtATime - 1) / kAtATime;
  std::vector<std::vector<QueryPoint>> found(pieces);
  const auto work = [&](std::size_t piece) {
    for (std::size_t n = piece * kAtATime; n < std::min(changed_.size(), (piece + 1) * kAtATime); ++n)
      for (std::uint32_t c = 3 * changed_[n]; c < 3 * changed_[n] + 3; ++c) {
        if (is_changed(mesh_.across(c)) && mesh_.across(c) < c) continue;  // found from there
        if (is_suspect(c))
          found[piece].push_back(sweeps_.query_at(middle_of(c), std::min(c, mesh_.across(c))));
      }
  };
  parallel_for(threads_, pieces, work, [] { return false; });
  queries_.clear();
  for (const std::vector<QueryPoint>& some : found) queries_.insert(queries_.end(), some.begin(), some.end());
  look_again();
  for (const std::uint32_t t : changed_) is_changed_[t] = 0;
  changed_.clear();
  std::sort(queries_.begin(), queries_.end());
  const auto is_same = [](const QueryPoint& a, const QueryPoint& b) { return a.number == b.number; };
  queries_.erase(std::unique(queries_.begin(), queries_.end(), is_same), queries_.end());
}

void EdgeSplitter::look_at(std::size_t n, Around& around) {
  const std::uint32_t corner = queries_[n].number, across = mesh_.across(corner);
  const std::uint32_t triangle = corner / 3, other = across == kNone ? triangle : across / 3;
  const Point3 a = mesh_.point(mesh_.vertex(corner)), b = mesh_.point(mesh_.vertex(LinkedMesh::next(corner)));
  const bool stock = mesh_.step(triangle) == kStockSurface, other_stock = mesh_.step(other) == kStockSurface;
  if (stock && other_stock) return;
  std::array<bool, 3> fixed{};
  for (int axis = 0; axis < 3; ++axis) {
    const bool low = a[axis] <= kOnBlock && b[axis] <= kOnBlock;
    const bool high = std::min(a[axis], b[axis]) >= size_[axis] - kOnBlock;
    fixed[static_cast<std::size_t>(axis)] = (low || high) && (axis < 2 || stock || other_stock);
  }
  const Point3 middle = 0.5 * (a + b);
  Found& found = found_[n];
  if (std::abs(around.wider(middle).at(middle).value) <= tolerance_) {
    found.verdict = Verdict::good;
    return;
  }
  const Nearby& nearby = around.all(middle);
  if (may_turn_ && can_turn(corner)) {
    const Point3 turned = 0.5 * (mesh_.point(mesh_.vertex(LinkedMesh::before(corner))) +
                                 mesh_.point(mesh_.vertex(LinkedMesh::before(across))));
    if (miss_at(nearby, turned) < kBetter * miss_at(nearby, middle)) {
      found.verdict = Verdict::turns;
      return;
    }
  }
  // What is to be met faces as the surfaces do that were cut.
  const Point3 outwards = stock         ? mesh_.normal(other)
                          : other_stock ? mesh_.normal(triangle)
                                        : mesh_.normal(triangle) + mesh_.normal(other);
  Point3 at = middle, normal;
  if (!put_on_surface(nearby, kMaxMoved * distance(a, b), outwards, fixed, at, normal)) return;
  for (int axis = 0; axis < 3; ++axis)
    if (at[axis] < 0.0 || at[axis] > size_[axis]) return;
  found = {Verdict::parts, at};
}

/// How far a place is from the surface of what is left.
double EdgeSplitter::miss_at(const Nearby& nearby, Point3 place) const {
  return is_block_ ? miss_in_block(nearby, size_, place) : std::abs(nearby.at(place).value);
}

/// Whether two triangles may have their other diagonal: it is no edge yet, and both then face as they did.
bool EdgeSplitter::can_turn(std::uint32_t corner) const {
  const std::uint32_t across = mesh_.across(corner);
  if (across == kNone) return false;
  const std::uint32_t c = mesh_.vertex(LinkedMesh::before(corner));
  const std::uint32_t d = mesh_.vertex(LinkedMesh::before(across));
  if (c == d || mesh_.find(c, d) != kNone) return false;
  const Point3 a = mesh_.point(mesh_.vertex(corner)), b = mesh_.point(mesh_.vertex(across));
  const Point3 pc = mesh_.point(c), pd = mesh_.point(d);
  const Point3 facing = mesh_.normal(corner / 3) + mesh_.normal(across / 3);
  const Point3 one = cross(pd - a, pc - a), two = cross(b - pd, pc - pd);
  const double least = kThinnest * distance(pc, pd);
  return dot(one, facing) > least * length(facing) && dot(two, facing) > least * length(facing);
}

void EdgeSplitter::take_found() {
  for (std::size_t n = 0; n < queries_.size(); ++n) {
    if (found_[n].verdict == Verdict::good) mesh_.mark(queries_[n].number);
    if (found_[n].verdict == Verdict::parts || found_[n].verdict == Verdict::turns)
      add_stray(queries_[n].number, found_[n]);
  }
}

void EdgeSplitter::turn_edge(std::uint32_t corner) {
  const std::uint32_t triangle = corner / 3, other = mesh_.across(corner) / 3;
  mesh_.turn(corner);
  // What comes to lie on the block again is found later.
  if (mesh_.step(triangle) == kStockSurface) mesh_.set_step(triangle, mesh_.step(other));
  if (mesh_.step(other) == kStockSurface) mesh_.set_step(other, mesh_.step(triangle));
  mesh_.find_normal(triangle);
  mesh_.find_normal(other);
}

void EdgeSplitter::turn_edges() {
  for (const Stray& stray : strays_) {
    if (stray.found.verdict != Verdict::turns) continue;
    const std::uint32_t triangle = stray.corner / 3, other = mesh_.across(stray.corner) / 3;
    if (is_changed_[triangle] || is_changed_[other]) continue;
    // Another pair can have got the diagonal in the meantime.
    if (!can_turn(stray.corner)) continue;
    turn_edge(stray.corner);
    is_changed_[triangle] = is_changed_[other] = 1;
    changed_.insert(changed_.end(), {triangle, other});
  }
}

/// The one stray on the other two sides of a triangle; null if there is none or two.
const EdgeSplitter::Stray* EdgeSplitter::only_other(std::uint32_t corner) const {
  if (corner == kNone) return nullptr;
  const std::uint32_t one = stray_of_[LinkedMesh::next(corner)], two = stray_of_[LinkedMesh::before(corner)];
  if ((one == kNone) == (two == kNone)) return nullptr;
  return &strays_[std::min(one, two)];
}

/// Strays whose two triangles have another stray each, both shorter. On walls and other surfaces that bend
/// one way only those are along the bend, and an edge between their new vertices lies on the surface.
void EdgeSplitter::find_crossed() {
  const auto number_all = [&](const auto& number) {
    for (std::uint32_t n = 0; n < strays_.size(); ++n)
      for (const std::uint32_t c : {strays_[n].corner, mesh_.across(strays_[n].corner)})
        if (c != kNone) stray_of_[c] = number(n);
  };
  stray_of_.resize(std::size_t{3} * mesh_.triangles(), kNone);
  number_all([](std::uint32_t n) { return n; });
  const auto size = [&](const Stray& stray) {
    return distance(mesh_.point(mesh_.vertex(stray.corner)),
                    mesh_.point(mesh_.vertex(LinkedMesh::next(stray.corner))));
  };
  queries_.clear();
  for (std::uint32_t n = 0; n < strays_.size(); ++n) {
    Stray& stray = strays_[n];
    const Stray *one = only_other(stray.corner), *two = only_other(mesh_.across(stray.corner));
    if (one == nullptr || two == nullptr || one == two) continue;
    if (size(stray) <= std::max(size(*one), size(*two))) continue;
    stray.crossing = 0.5 * (one->found.at + two->found.at);
    queries_.push_back(sweeps_.query_at(stray.crossing, n));
  }
  number_all([](std::uint32_t) { return kNone; });
  std::sort(queries_.begin(), queries_.end());
}

bool EdgeSplitter::look_at_crossed(std::size_t n, Around& around) const {
  const Point3 middle = strays_[queries_[n].number].crossing;
  return std::abs(around.wider(middle).at(middle).value) <= tolerance_;
}

bool EdgeSplitter::part_strays() {
  first_new_ = static_cast<std::uint32_t>(mesh_.vertices());
  std::vector<LinkedMesh::Parting> partings;
  std::vector<Point3> straight;  // the middles of edges that have new vertices
  std::vector<Stray> crossed;
  for (const Stray& stray : strays_) {
    if (stray.found.verdict == Verdict::crossed) {
      crossed.push_back(stray);
      continue;
    }
    straight.push_back(middle_of(stray.corner));
    partings.push_back({stray.corner, mesh_.add_vertex(stray.found.at)});
  }
  strays_.clear();
  changed_ = mesh_.part(partings);
  mesh_.settle(changed_,
               [&](std::uint32_t v) { return v < first_new_ ? mesh_.point(v) : straight[v - first_new_]; });
  for (const Stray& each : crossed) {
    const std::uint32_t corner = mesh_.find(each.a, each.b);
    if (corner == kNone) continue;  // a fold was taken out there
    if (can_turn(corner)) {
      turn_edge(corner);
      mesh_.mark(3 * (corner / 3) + 1);  // it was looked at
    } else {
      add_stray(corner, {Verdict::parts, each.found.at});
    }
  }
  return !partings.empty();
}

}  // namespace kerf::sim
