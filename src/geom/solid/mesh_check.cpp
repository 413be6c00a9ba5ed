// Checks whether a mesh is closed, by sorting its edges by their lower vertex, and computes its volume.
#include "kerf/geom/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "base/codes/sim.h"
#include "base/huge_pages.h"
#include "base/number.h"
#include "base/parallel.h"

#include "kerf/geom/geometry.h"

namespace kerf {
namespace {

using Positions = std::span<const float>;
using Triangles = std::span<const std::uint32_t>;

constexpr std::size_t kChunk = std::size_t{3} << 14;  // indices
/// Maximum number of parts of the triangle list that are counted in parallel. Each part has a counter per
/// vertex, so that more parts are not faster.
constexpr std::size_t kMaxParts = 4;
/// One bit of a vertex number is used for the direction of a side; sides are counted in 32 bits.
constexpr std::size_t kMaxVertices = std::size_t{1} << 31, kMaxSides = 0xffffffffu;

bool never() { return false; }

/// Six times the signed volume of the tetrahedra with apex `from`. A nearby apex avoids cancellation far from
/// the origin.
double six_volumes(Positions positions, Triangles triangles, Point3 from) {
  const auto at = [&](std::uint32_t v) {
    const float* p = positions.data() + std::size_t{3} * v;
    return Point3{p[0], p[1], p[2]};
  };
  double six = 0.0;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Point3 a = at(triangles[t]) - from, b = at(triangles[t + 1]) - from,
                 c = at(triangles[t + 2]) - from;
    six += dot(a, cross(b, c));
  }
  return six;
}

/// Enclosed volume, summed in chunks in a fixed order, so that it does not depend on the number of threads.
double enclosed(Positions positions, Triangles triangles, unsigned threads) {
  if (triangles.empty()) return 0.0;
  const float* const p = positions.data() + std::size_t{3} * triangles[0];
  const Point3 from{p[0], p[1], p[2]};
  std::vector<double> chunks((triangles.size() + kChunk - 1) / kChunk);
  parallel_for(
      threads, chunks.size(),
      [&](std::size_t n) {
        const std::size_t size = std::min(kChunk, triangles.size() - n * kChunk);
        chunks[n] = six_volumes(positions, triangles.subspan(n * kChunk, size), from);
      },
      never);
  return std::accumulate(chunks.begin(), chunks.end(), 0.0) / 6.0;
}

/// A side of a triangle, stored with the lower of its two vertices: 2 * the higher one, + 1 if it runs from
/// the higher to the lower.
using Side = std::uint32_t;

/// Whether a few sides form pairs of opposite directions, with no other side on the same edge. Without
/// data-dependent branches.
bool are_pairs(const Side* sides, std::size_t count) {
  std::size_t opposite = 0, same = 0;
  for (std::size_t k = 1; k < count; ++k) {
    for (std::size_t n = 0; n < k; ++n) {
      const Side difference = sides[k] ^ sides[n];
      opposite += difference == 1 ? 1 : 0;
      same += difference == 0 ? 1 : 0;
    }
  }
  return same == 0 && 2 * opposite == count;
}

/// The number of edges with one lower vertex that do not have exactly two triangles in opposite directions.
std::size_t count_bad(Side* first, Side* end) {
  constexpr std::ptrdiff_t kFew = 16;
  if (end - first <= kFew && are_pairs(first, static_cast<std::size_t>(end - first))) return 0;
  std::sort(first, end);
  std::size_t bad = 0;
  while (first != end) {
    Side* last = first;
    int downwards = 0;
    for (; last != end && *last / 2 == *first / 2; ++last) downwards += static_cast<int>(*last % 2);
    if (last - first != 2 || downwards != 1) ++bad;
    first = last;
  }
  return bad;
}

/// Sorts the sides of all triangles by their lower vertices (counting sort, the triangle list in parts).
class Edges {
 public:
  Edges(Triangles triangles, std::size_t vertices, unsigned threads)
      : triangles_(triangles),
        vertices_(vertices),
        threads_(threads),
        next_(std::min<std::size_t>(threads, kMaxParts)) {}

  /// The number of edges without exactly two triangles in opposite directions; nothing if a triangle has a
  /// vertex that does not exist.
  std::optional<std::size_t> bad() {
    std::vector<std::uint8_t> valid(next_.size());
    parallel_for(
        threads_, next_.size(), [&](std::size_t n) { valid[n] = count(n) ? 1 : 0; }, never);
    if (std::find(valid.begin(), valid.end(), 0) != valid.end()) return std::nullopt;
    find_positions();
    parallel_for(
        threads_, next_.size(), [&](std::size_t n) { put(n); }, never);
    std::vector<std::size_t> bad(vertices_ / kEach + 1);
    parallel_for(
        threads_, bad.size(),
        [&](std::size_t n) { bad[n] = count_bad_of(n * kEach, std::min((n + 1) * kEach, vertices_)); },
        never);
    return std::accumulate(bad.begin(), bad.end(), std::size_t{0});
  }

 private:
  static constexpr std::size_t kEach = std::size_t{1} << 14;  // vertices

  Triangles part(std::size_t n) const {
    const std::size_t count = triangles_.size() / 3;
    const std::size_t first = n * count / next_.size(), end = (n + 1) * count / next_.size();
    return triangles_.subspan(3 * first, 3 * (end - first));
  }
  template <class Visit>
  static void each_side(Triangles triangles, const Visit& visit) {
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
      const std::uint32_t a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        visit(std::min(from, to), 2 * std::max(from, to) + (from < to ? 0u : 1u));
    }
  }

  /// Counts the sides of each vertex in a part; false if a vertex does not exist.
  bool count(std::size_t n) {
    const Triangles mine = part(n);
    next_[n].assign(vertices_, 0);
    for (std::size_t first = 0; first < mine.size(); first += kChunk) {
      const Triangles chunk = mine.subspan(first, std::min(kChunk, mine.size() - first));
      if (*std::max_element(chunk.begin(), chunk.end()) >= vertices_) return false;
      each_side(chunk, [&](std::uint32_t low, Side) { ++next_[n][low]; });
    }
    return true;
  }
  /// Computes the positions of the sides, sorted by vertex and then by part.
  void find_positions() {
    std::uint32_t position = 0;
    for (std::size_t v = 0; v < vertices_; ++v)
      for (std::vector<std::uint32_t>& next : next_) position += std::exchange(next[v], position);
    sides_.reset(new Side[position]);  // not cleared, as all are written
    use_huge_pages(sides_.get(), position * sizeof(Side));
  }
  void put(std::size_t n) {
    each_side(part(n), [&](std::uint32_t low, Side side) { sides_[next_[n][low]++] = side; });
  }
  std::size_t count_bad_of(std::size_t first, std::size_t end) const {
    std::size_t bad = 0;
    std::uint32_t start = first == 0 ? 0 : next_.back()[first - 1];
    for (std::size_t v = first; v < end; ++v)
      bad += count_bad(sides_.get() + std::exchange(start, next_.back()[v]), sides_.get() + next_.back()[v]);
    return bad;
  }

  Triangles triangles_;
  std::size_t vertices_;
  unsigned threads_;
  std::vector<std::vector<std::uint32_t>> next_;  // by part: of each vertex, the position of its next side
  std::unique_ptr<Side[]> sides_;
};

}  // namespace

MeshCheck check_mesh(Positions positions, Triangles triangles, unsigned threads) {
  const std::size_t vertices = positions.size() / 3;
  triangles = triangles.first(triangles.size() / 3 * 3);
  MeshCheck check;
  if (triangles.empty()) return check;
  threads = thread_count(threads);
  std::optional<std::size_t> bad;
  if (vertices <= kMaxVertices && triangles.size() <= kMaxSides)
    bad = Edges(triangles, vertices, threads).bad();
  check.bad_edges = bad.value_or(triangles.size());  // invalid vertex numbers
  if (bad) check.volume = mm3(enclosed(positions, triangles, threads));
  return check;
}

bool verify_mesh(std::span<const float> positions, std::span<const std::uint32_t> triangles,
                 const VolumeRange& volume, Diagnostics& diagnostics) {
  const MeshCheck check = check_mesh(positions, triangles);
  std::string fault;
  if (check.bad_edges != 0) {
    fault = fmt::format("{} edges do not have exactly two triangles", check.bad_edges);
  } else if (!(std::abs((check.volume - volume.expected).mm3()) <= volume.tolerance.mm3())) {
    fault = fmt::format("its volume is {} mm3, expected are {} +- {}", number_text(check.volume.mm3(), 3),
                        number_text(volume.expected.mm3(), 3), number_text(volume.tolerance.mm3(), 3));
  } else {
    return true;
  }
  diagnostics.error(codes::mesh_unsound, {}, "the mesh is not written, as it is not valid: " + fault).hint =
      "this is a defect of Kerf; please report it with the program. Another --resolution may avoid it";
  return false;
}

}  // namespace kerf
