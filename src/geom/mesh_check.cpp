// Is a mesh closed, and what does it hold: edges counted by sorting them under their lower vertex.
#include "kerf/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.h"

#include "kerf/geometry.h"
#include "kerf/number.h"

namespace kerf {
namespace {

using Positions = std::span<const float>;
using Triangles = std::span<const std::uint32_t>;

constexpr std::size_t kChunk = std::size_t{3} << 14;  // indices
/// Each share of the edges is found in all triangles: with more of them there is nothing to be won.
constexpr std::size_t kMostShares = 16;
/// Of a vertex's number one bit is left for the way in which a side goes.
constexpr std::size_t kMostVertices = std::size_t{1} << 31;

bool never() { return false; }

/// Six times the signed volume of the tetrahedra from a place, in double precision: no digit is lost far from
/// zero.
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

/// In chunks that are summed in order, whatever the threads.
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

/// A triangle's side under the lower of its two vertices: twice the other one, and one more if it goes down
/// in number.
using Side = std::uint32_t;

std::size_t count_bad(Side* begin, Side* end) {
  std::sort(begin, end);
  std::size_t bad = 0;
  while (begin != end) {
    Side* last = begin;
    int downwards = 0;
    for (; last != end && *last / 2 == *begin / 2; ++last) downwards += static_cast<int>(*last % 2);
    if (last - begin != 2 || downwards != 1) ++bad;
    begin = last;
  }
  return bad;
}

/// Edges, by their lower vertex from `first` to `end` - 1, without two triangles in opposite directions.
std::size_t count_bad_edges(Triangles triangles, std::size_t first, std::size_t end) {
  const auto each_side = [&](auto&& visit) {
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
      const std::uint32_t a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        const std::size_t low = std::min(from, to);
        if (low - first < end - first) visit(low - first, 2 * std::max(from, to) + (from < to ? 0u : 1u));
      }
    }
  };
  // Of each vertex the place of its first side, once its sides have gone there one by one.
  std::vector<std::size_t> start(end - first + 2, 0);
  each_side([&](std::size_t low, Side) { ++start[low + 2]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Side> sides(start.back());
  each_side([&](std::size_t low, Side side) { sides[start[low + 1]++] = side; });
  std::size_t bad = 0;
  for (std::size_t v = 0; v < end - first; ++v)
    bad += count_bad(sides.data() + start[v], sides.data() + start[v + 1]);
  return bad;
}

}  // namespace

MeshCheck check_mesh(Positions positions, Triangles triangles, unsigned threads) {
  const std::size_t vertices = positions.size() / 3;
  triangles = triangles.first(triangles.size() / 3 * 3);
  MeshCheck check;
  if (triangles.empty()) return check;
  if (*std::max_element(triangles.begin(), triangles.end()) >= std::min(vertices, kMostVertices)) {
    check.bad_edges = triangles.size();  // not a mesh at all
    return check;
  }
  threads = thread_count(threads);
  check.volume = mm3(enclosed(positions, triangles, threads));
  std::vector<std::size_t> bad(std::min<std::size_t>(threads, kMostShares));
  parallel_for(
      threads, bad.size(),
      [&](std::size_t n) {
        bad[n] = count_bad_edges(triangles, n * vertices / bad.size(), (n + 1) * vertices / bad.size());
      },
      never);
  check.bad_edges = std::accumulate(bad.begin(), bad.end(), std::size_t{0});
  return check;
}

bool verify_mesh(std::span<const float> positions, std::span<const std::uint32_t> triangles,
                 const VolumeRange& volume, Diagnostics& diagnostics) {
  const MeshCheck check = check_mesh(positions, triangles);
  std::string fault;
  if (check.bad_edges != 0) {
    fault = fmt::format("{} edges are not shared by two triangles", check.bad_edges);
  } else if (!(std::abs((check.volume - volume.expected).mm3()) <= volume.tolerance.mm3())) {
    fault = fmt::format("it holds {} mm3 instead of {}, which may differ by {}",
                        number_text(check.volume.mm3(), 3), number_text(volume.expected.mm3(), 3),
                        number_text(volume.tolerance.mm3(), 3));
  } else {
    return true;
  }
  diagnostics.error(Code::mesh_unsound, {}, "the mesh is not written, as it is not sound: " + fault).hint =
      "this is a fault of Kerf; please report it with the program. Another --resolution may help meanwhile";
  return false;
}

}  // namespace kerf
