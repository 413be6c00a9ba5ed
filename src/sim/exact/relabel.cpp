// A triangle of the columns' mesh is whose its column is. Where vertices have moved to an edge between the
// stock's surface and a cut, some triangles have come to lie on the other side of it.
#include "sim/exact/relabel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "sim/mesh/mesh_build.h"

namespace kerf::sim {
namespace {

/// Vertices within this of the block's sides are on them, mm; single precision in work coordinates.
constexpr double kOnBlock = 1e-4;
/// A triangle that no cut one touches may be reached through others.
constexpr int kMaxRounds = 4;

class Relabeller {
 public:
  Relabeller(Mesh& mesh, const Box3& block) : mesh_(mesh), block_(block) {}
  void run();

 private:
  double at(std::uint32_t vertex, int axis) const {
    return mesh_.positions[std::size_t{3} * vertex + static_cast<std::size_t>(axis)];
  }
  bool lies_on(std::size_t triangle, int axis, double side) const {
    const std::uint32_t* c = mesh_.triangles.data() + 3 * triangle;
    return std::all_of(c, c + 3, [&](std::uint32_t v) { return std::abs(at(v, axis) - side) <= kOnBlock; });
  }
  bool lies_on_block(std::size_t triangle, int first_axis) const {
    for (int axis = first_axis; axis < 3; ++axis)
      if (lies_on(triangle, axis, block_.low[axis]) || lies_on(triangle, axis, block_.high[axis]))
        return true;
    return false;
  }
  std::vector<std::size_t> find_strays();
  bool take_steps(std::vector<std::size_t>& strays);

  Mesh& mesh_;
  const Box3& block_;
};

/// Gives what lies on the block's top and bottom to the block; the triangles of the block that lie nowhere on
/// it.
std::vector<std::size_t> Relabeller::find_strays() {
  std::vector<std::size_t> strays;
  for (std::size_t t = 0; t < mesh_.step.size(); ++t) {
    if (mesh_.step[t] == kStockSurface) {
      if (!lies_on_block(t, 0)) strays.push_back(t);
    } else if (lies_on_block(t, 2)) {
      mesh_.step[t] = kStockSurface;
    }
  }
  return strays;
}

/// Of those beside a triangle that was cut; the others stay in the list. False if there was none.
bool Relabeller::take_steps(std::vector<std::size_t>& strays) {
  std::vector<bool> near(mesh_.positions.size() / 3, false);
  std::unordered_map<std::uint64_t, std::uint32_t> step_beside;
  for (const std::size_t t : strays)
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) near[mesh_.triangles[k]] = true;
  for (std::size_t t = 0; t < mesh_.step.size(); ++t) {
    if (mesh_.step[t] == kStockSurface) continue;
    const std::uint32_t* c = mesh_.triangles.data() + 3 * t;
    for (std::size_t k = 0; k < 3; ++k)
      if (near[c[k]] && near[c[(k + 1) % 3]])
        step_beside[meshing::edge_key(c[k], c[(k + 1) % 3])] = mesh_.step[t];
  }
  const auto takes = [&](std::size_t t) {
    const std::uint32_t* c = mesh_.triangles.data() + 3 * t;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto beside = step_beside.find(meshing::edge_key(c[k], c[(k + 1) % 3]));
      if (beside == step_beside.end()) continue;
      mesh_.step[t] = beside->second;
      return true;
    }
    return false;
  };
  const std::size_t before = strays.size();
  strays.erase(std::remove_if(strays.begin(), strays.end(), takes), strays.end());
  return strays.size() < before;
}

void Relabeller::run() {
  std::vector<std::size_t> strays = find_strays();
  for (int round = 0; round < kMaxRounds && !strays.empty(); ++round)
    if (!take_steps(strays)) return;
}

}  // namespace

void relabel_triangles(Mesh& mesh, const Box3& block) { Relabeller(mesh, block).run(); }

}  // namespace kerf::sim
