// In the mesh of the columns a triangle has the step of its column. Where vertices have moved to an edge
// between the stock's surface and a cut, some triangles now lie on the other side of that edge.
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
/// A triangle without a neighbour that was cut may get the step of one that has been assigned before.
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
  std::vector<std::size_t> find_unassigned();
  bool assign_steps(std::vector<std::size_t>& unassigned);

  Mesh& mesh_;
  const Box3& block_;
};

/// Sets kStockSurface on the block's top and bottom. Returns the other triangles with kStockSurface that lie
/// on no side of the block.
std::vector<std::size_t> Relabeller::find_unassigned() {
  std::vector<std::size_t> unassigned;
  for (std::size_t t = 0; t < mesh_.step.size(); ++t) {
    if (mesh_.step[t] == kStockSurface) {
      if (!lies_on_block(t, 0)) unassigned.push_back(t);
    } else if (lies_on_block(t, 2)) {
      mesh_.step[t] = kStockSurface;
    }
  }
  return unassigned;
}

/// Assigns and removes those with a neighbour that has a step. False if there is none.
bool Relabeller::assign_steps(std::vector<std::size_t>& unassigned) {
  std::vector<bool> near(mesh_.positions.size() / 3, false);
  std::unordered_map<std::uint64_t, std::uint32_t> step_beside;
  for (const std::size_t t : unassigned)
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
  const std::size_t before = unassigned.size();
  unassigned.erase(std::remove_if(unassigned.begin(), unassigned.end(), takes), unassigned.end());
  return unassigned.size() < before;
}

void Relabeller::run() {
  std::vector<std::size_t> unassigned = find_unassigned();
  for (int round = 0; round < kMaxRounds && !unassigned.empty(); ++round)
    if (!assign_steps(unassigned)) return;
}

}  // namespace

void relabel_triangles(Mesh& mesh, const Box3& block) { Relabeller(mesh, block).run(); }

}  // namespace kerf::sim
