// Is a mesh closed, and what does it hold: edges counted by sorting them under their lower vertex.
#include "kerf/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "kerf/geometry.h"
#include "kerf/number.h"

namespace kerf {
namespace {

/// One triangle's side under the lower of its two vertices; forward if it runs upwards in number.
struct Side {
  std::uint32_t other;
  int forward;
};

/// Signed volume of the tetrahedra from the first vertex, in double precision: no digit is lost far from
/// zero.
double enclosed(std::span<const float> positions, std::span<const std::uint32_t> triangles) {
  const auto at = [&](std::uint32_t v) {
    const float* p = positions.data() + std::size_t{3} * v;
    return Point3{p[0], p[1], p[2]};
  };
  if (triangles.empty()) return 0.0;
  const Point3 from = at(triangles[0]);
  double six = 0.0;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Point3 a = at(triangles[t]) - from, b = at(triangles[t + 1]) - from,
                 c = at(triangles[t + 2]) - from;
    six += dot(a, cross(b, c));
  }
  return six / 6.0;
}

std::size_t count_bad(Side* begin, Side* end) {
  std::sort(begin, end, [](const Side& a, const Side& b) { return a.other < b.other; });
  std::size_t bad = 0;
  while (begin != end) {
    Side* last = begin;
    int uses = 0, balance = 0;
    for (; last != end && last->other == begin->other; ++last, ++uses) balance += last->forward;
    if (uses != 2 || balance != 0) ++bad;
    begin = last;
  }
  return bad;
}

}  // namespace

MeshCheck check_mesh(std::span<const float> positions, std::span<const std::uint32_t> triangles) {
  const std::size_t vertices = positions.size() / 3;
  const std::size_t corners = triangles.size() / 3 * 3;
  MeshCheck check;
  for (const std::uint32_t v : triangles) {
    if (v < vertices) continue;
    check.bad_edges = triangles.size();  // not a mesh at all
    return check;
  }
  check.volume = mm3(enclosed(positions, triangles));
  std::vector<std::size_t> start(vertices + 1, 0);
  const auto each_side = [&](auto&& visit) {
    for (std::size_t t = 0; t < corners; t += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[t + k], b = triangles[t + (k + 1) % 3];
        visit(std::min(a, b), Side{std::max(a, b), a < b ? 1 : -1});
      }
    }
  };
  each_side([&](std::uint32_t low, const Side&) { ++start[low + 1]; });
  for (std::size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
  std::vector<Side> sides(corners);
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  each_side([&](std::uint32_t low, const Side& side) { sides[next[low]++] = side; });
  for (std::size_t v = 0; v < vertices; ++v)
    check.bad_edges += count_bad(sides.data() + start[v], sides.data() + start[v + 1]);
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
