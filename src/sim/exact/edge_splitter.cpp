// Finding coarse edges, flipping them, and splitting them at vertices on the surface.
#include "sim/exact/edge_splitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace kerf::sim {
namespace {

/// Shorter edges are not examined, pitches.
constexpr double kMinLength = 0.2;
/// An edge is flipped if the error of the other diagonal is below this fraction of its own.
constexpr double kFlipGain = 0.5;
/// A flip must not produce triangles of less height over the new edge, mm.
constexpr double kMinHeight = 1e-4;
/// Maximum distance of a new vertex from the midpoint of its edge, as a fraction of the edge's length.
constexpr double kMaxMoved = 0.35;

/// Triangles around a vertex belong to the same surface as a given one if the cosine of the angle between
/// their normals is at least this. A triangle that bridges an edge belongs to both surfaces.
constexpr double kOneSurface = 0.2;
/// Triangles within half that angle of their mean normal are one surface, whichever of them is given.
const double kAllOneSurface = std::sqrt(0.5 * (1.0 + kOneSurface));

/// Triangles or vertices per work item of a thread.
constexpr std::size_t kAtATime = 1 << 12;

}  // namespace

EdgeSplitter::EdgeSplitter(LinkedMesh& mesh, const Workpiece::Body& body, SweepsByTile& sweeps,
                           std::vector<bool> is_curved, double tolerance, unsigned threads)
    : mesh_(mesh),
      size_(body.bounds.size()),
      pitch_(body.pitch),
      tolerance_(tolerance),
      is_block_(!body.start),
      sweeps_(sweeps),
      is_curved_(std::move(is_curved)),
      threads_(threads) {
  for (std::uint32_t t = 0; t < mesh_.triangles(); ++t)
    if (is_curved_[mesh_.vertex(3 * t)] || is_curved_[mesh_.vertex(3 * t + 1)] ||
        is_curved_[mesh_.vertex(3 * t + 2)])
      changed_.push_back(t);
}

Point3 EdgeSplitter::midpoint_of(std::uint32_t corner) const {
  return 0.5 * (mesh_.point(mesh_.vertex(corner)) + mesh_.point(mesh_.vertex(LinkedMesh::next(corner))));
}

/// Unit normal at a vertex of the surface that faces like `facing`: the mean of its triangles' normals.
Point3 EdgeSplitter::normal_at(std::uint32_t vertex, Point3 facing) const {
  Point3 sum;
  mesh_.around(vertex, [&](std::uint32_t triangle) {
    const Point3 normal = mesh_.normal(triangle);
    if (dot(normal, facing) >= kOneSurface) sum = sum + normal;
  });
  const double size = length(sum);
  return size > 0.0 ? (1.0 / size) * sum : sum;
}

/// Computes normal_at of a vertex if it is the same for all its triangles.
void EdgeSplitter::find_smooth_normal(std::uint32_t vertex) {
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
    smooth_normal_[vertex][static_cast<std::size_t>(axis)] = static_cast<float>(scale * sum[axis]);
}

/// For all vertices of changed triangles.
void EdgeSplitter::find_smooth_normals() {
  smooth_normal_.resize(mesh_.vertices());
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
      find_smooth_normal(vertices[n]);
  };
  parallel_for(threads_, (vertices.size() + kAtATime - 1) / kAtATime, work, [] { return false; });
}

/// The larger change of the normal from one end of an edge to the other, of the surfaces on both sides,
/// radians. The sagitta of a circle is length * change / 8.
double EdgeSplitter::normal_change(std::uint32_t corner) const {
  const std::uint32_t a = mesh_.vertex(corner), b = mesh_.vertex(LinkedMesh::next(corner));
  const auto known = [&](std::uint32_t vertex) {
    return Point3{smooth_normal_[vertex][0], smooth_normal_[vertex][1], smooth_normal_[vertex][2]};
  };
  const Point3 of_a = known(a), of_b = known(b);
  const bool is_one_a = dot(of_a, of_a) > 0.0, is_one_b = dot(of_b, of_b) > 0.0;
  if (is_one_a && is_one_b) return distance(of_a, of_b);
  double largest = 0.0;
  for (const std::uint32_t side : {corner, mesh_.across(corner)}) {
    if (side == kNone) continue;
    const Point3 facing = mesh_.normal(side / 3);
    largest = std::max(
        largest, distance(is_one_a ? of_a : normal_at(a, facing), is_one_b ? of_b : normal_at(b, facing)));
  }
  return largest;
}

/// Whether the sagitta that follows from the normals at its ends exceeds the tolerance.
bool EdgeSplitter::is_suspect(std::uint32_t corner) const {
  if (mesh_.is_marked(corner)) return false;
  const std::uint32_t a = mesh_.vertex(corner), b = mesh_.vertex(LinkedMesh::next(corner));
  if (first_new_ == 0 ? !is_curved_[a] && !is_curved_[b] : std::max(a, b) < first_new_) return false;
  const double size = distance(mesh_.point(a), mesh_.point(b));
  return size >= kMinLength * pitch_ && size * normal_change(corner) > 8.0 * tolerance_;
}

/// Moves the known coarse edges whose triangles have changed back to the queries; if no more edges may be
/// flipped, those with Verdict::flip too.
void EdgeSplitter::requery_coarse() {
  const auto is_taken = [&](const CoarseEdge& edge) {
    const std::uint32_t across = mesh_.across(edge.corner);
    const bool has_changed =
        is_changed_[edge.corner / 3] != 0 || (across != kNone && is_changed_[across / 3] != 0);
    if (!has_changed && (may_flip_ || edge.found.verdict != Verdict::flip)) return false;
    const std::uint32_t corner = mesh_.find_side(edge.a, edge.b);
    if (corner != kNone)  // else it was flipped
      queries_.push_back(sweeps_.query_at(midpoint_of(corner), std::min(corner, mesh_.across(corner))));
    return true;
  };
  coarse_.erase(std::remove_if(coarse_.begin(), coarse_.end(), is_taken), coarse_.end());
}

/// Fills queries_ with the suspects among the edges of changed triangles and with requery_coarse.
void EdgeSplitter::find_suspects() {
  find_smooth_normals();
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
          found[piece].push_back(sweeps_.query_at(midpoint_of(c), std::min(c, mesh_.across(c))));
      }
  };
  parallel_for(threads_, pieces, work, [] { return false; });
  queries_.clear();
  for (const std::vector<QueryPoint>& some : found) queries_.insert(queries_.end(), some.begin(), some.end());
  requery_coarse();
  for (const std::uint32_t t : changed_) is_changed_[t] = 0;
  changed_.clear();
  std::sort(queries_.begin(), queries_.end());
  const auto is_same = [](const QueryPoint& a, const QueryPoint& b) { return a.number == b.number; };
  queries_.erase(std::unique(queries_.begin(), queries_.end(), is_same), queries_.end());
}

void EdgeSplitter::examine(std::size_t n, SweepFinder& finder) {
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
  const Point3 midpoint = 0.5 * (a + b);
  Found& found = found_[n];
  if (std::abs(finder.all_of_cube(midpoint).at(midpoint).value) <= tolerance_) {
    found.verdict = Verdict::good;
    return;
  }
  const NearbySweeps& nearby = finder.all(midpoint);
  if (may_flip_ && can_flip(corner)) {
    const Point3 flipped = 0.5 * (mesh_.point(mesh_.vertex(LinkedMesh::before(corner))) +
                                  mesh_.point(mesh_.vertex(LinkedMesh::before(across))));
    if (surface_error(nearby, flipped) < kFlipGain * surface_error(nearby, midpoint)) {
      found.verdict = Verdict::flip;
      return;
    }
  }
  // The surface to be found faces as the triangles that were cut.
  const Point3 outwards = stock         ? mesh_.normal(other)
                          : other_stock ? mesh_.normal(triangle)
                                        : mesh_.normal(triangle) + mesh_.normal(other);
  Point3 at = midpoint, normal;
  if (!project_to_surface(nearby, kMaxMoved * distance(a, b), outwards, fixed, at, normal)) return;
  for (int axis = 0; axis < 3; ++axis)
    if (at[axis] < 0.0 || at[axis] > size_[axis]) return;
  found = {Verdict::split, at};
}

/// Distance of a point from the surface of the remaining material.
double EdgeSplitter::surface_error(const NearbySweeps& nearby, Point3 point) const {
  return is_block_ ? surface_error_in_block(nearby, size_, point) : std::abs(nearby.at(point).value);
}

/// Whether two triangles may get their other diagonal: it is not an edge yet, and both keep their
/// orientation.
bool EdgeSplitter::can_flip(std::uint32_t corner) const {
  const std::uint32_t across = mesh_.across(corner);
  if (across == kNone) return false;
  const std::uint32_t c = mesh_.vertex(LinkedMesh::before(corner));
  const std::uint32_t d = mesh_.vertex(LinkedMesh::before(across));
  if (c == d || mesh_.find_side(c, d) != kNone) return false;
  const Point3 a = mesh_.point(mesh_.vertex(corner)), b = mesh_.point(mesh_.vertex(across));
  const Point3 pc = mesh_.point(c), pd = mesh_.point(d);
  const Point3 facing = mesh_.normal(corner / 3) + mesh_.normal(across / 3);
  const Point3 one = cross(pd - a, pc - a), two = cross(b - pd, pc - pd);
  const double threshold = kMinHeight * distance(pc, pd);
  return dot(one, facing) > threshold * length(facing) && dot(two, facing) > threshold * length(facing);
}

void EdgeSplitter::record_coarse() {
  for (std::size_t n = 0; n < queries_.size(); ++n) {
    if (found_[n].verdict == Verdict::good) mesh_.mark(queries_[n].number);
    if (found_[n].verdict == Verdict::split || found_[n].verdict == Verdict::flip)
      add_coarse(queries_[n].number, found_[n]);
  }
}

void EdgeSplitter::flip_edge(std::uint32_t corner) {
  const std::uint32_t triangle = corner / 3, other = mesh_.across(corner) / 3;
  mesh_.flip(corner);
  // relabel_mesh later restores kStockSurface where triangles lie on the block.
  if (mesh_.step(triangle) == kStockSurface) mesh_.set_step(triangle, mesh_.step(other));
  if (mesh_.step(other) == kStockSurface) mesh_.set_step(other, mesh_.step(triangle));
  mesh_.update_normal(triangle);
  mesh_.update_normal(other);
}

void EdgeSplitter::flip_coarse() {
  for (const CoarseEdge& edge : coarse_) {
    if (edge.found.verdict != Verdict::flip) continue;
    const std::uint32_t triangle = edge.corner / 3, other = mesh_.across(edge.corner) / 3;
    if (is_changed_[triangle] || is_changed_[other]) continue;
    // Another pair may have got this diagonal in the meantime.
    if (!can_flip(edge.corner)) continue;
    flip_edge(edge.corner);
    is_changed_[triangle] = is_changed_[other] = 1;
    changed_.insert(changed_.end(), {triangle, other});
  }
}

/// The coarse edge on the other two sides of a triangle; null if there is none or two.
const EdgeSplitter::CoarseEdge* EdgeSplitter::only_other(std::uint32_t corner) const {
  if (corner == kNone) return nullptr;
  const std::uint32_t one = coarse_of_[LinkedMesh::next(corner)],
                      two = coarse_of_[LinkedMesh::before(corner)];
  if ((one == kNone) == (two == kNone)) return nullptr;
  return &coarse_[std::min(one, two)];
}

/// Finds coarse edges whose two triangles have one other, shorter coarse edge each. On walls and other
/// surfaces that are curved in one direction only, the shorter edges run along that direction, and the edge
/// between their new vertices lies on the surface: if it does, it replaces the longer edge, which is not
/// split.
void EdgeSplitter::find_crossed() {
  const auto number_all = [&](const auto& number) {
    for (std::uint32_t n = 0; n < coarse_.size(); ++n)
      for (const std::uint32_t c : {coarse_[n].corner, mesh_.across(coarse_[n].corner)})
        if (c != kNone) coarse_of_[c] = number(n);
  };
  coarse_of_.resize(std::size_t{3} * mesh_.triangles(), kNone);
  number_all([](std::uint32_t n) { return n; });
  const auto size = [&](const CoarseEdge& edge) {
    return distance(mesh_.point(mesh_.vertex(edge.corner)),
                    mesh_.point(mesh_.vertex(LinkedMesh::next(edge.corner))));
  };
  queries_.clear();
  for (std::uint32_t n = 0; n < coarse_.size(); ++n) {
    CoarseEdge& edge = coarse_[n];
    const CoarseEdge *one = only_other(edge.corner), *two = only_other(mesh_.across(edge.corner));
    if (one == nullptr || two == nullptr || one == two) continue;
    if (size(edge) <= std::max(size(*one), size(*two))) continue;
    edge.crossing = 0.5 * (one->found.at + two->found.at);
    queries_.push_back(sweeps_.query_at(edge.crossing, n));
  }
  number_all([](std::uint32_t) { return kNone; });
  std::sort(queries_.begin(), queries_.end());
}

bool EdgeSplitter::is_crossing_good(std::size_t n, SweepFinder& finder) const {
  const Point3 midpoint = coarse_[queries_[n].number].crossing;
  return std::abs(finder.all_of_cube(midpoint).at(midpoint).value) <= tolerance_;
}

bool EdgeSplitter::split_coarse() {
  first_new_ = static_cast<std::uint32_t>(mesh_.vertices());
  std::vector<LinkedMesh::EdgeSplit> splits;
  std::vector<Point3> midpoints;  // of edges with new vertices
  std::vector<CoarseEdge> crossed;
  for (const CoarseEdge& edge : coarse_) {
    if (edge.found.verdict == Verdict::crossed) {
      crossed.push_back(edge);
      continue;
    }
    midpoints.push_back(midpoint_of(edge.corner));
    splits.push_back({edge.corner, mesh_.add_vertex(edge.found.at)});
  }
  coarse_.clear();
  changed_ = mesh_.split(splits);
  mesh_.repair_folds(
      changed_, [&](std::uint32_t v) { return v < first_new_ ? mesh_.point(v) : midpoints[v - first_new_]; });
  for (const CoarseEdge& each : crossed) {
    const std::uint32_t corner = mesh_.find_side(each.a, each.b);
    if (corner == kNone) continue;  // flipped by repair_folds
    if (can_flip(corner)) {
      flip_edge(corner);
      mesh_.mark(3 * (corner / 3) + 1);  // examined by is_crossing_good
    } else {
      add_coarse(corner, {Verdict::split, each.found.at});
    }
  }
  return !splits.empty();
}

}  // namespace kerf::sim
