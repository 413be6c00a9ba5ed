// Finds and measures the cells that walls pass through.
#include "sim/rotary/rotary_walls.h"

#include <algorithm>
#include <cmath>

namespace kerf::sim {
namespace {

/// A surface that is this far from straight over three rays, in distances of rays, is a wall or an edge.
constexpr double kStraight = 0.1;
/// Each cell has a lattice of its own, so that few rays in many cells find a long wall as well as many in
/// few.
constexpr std::size_t kCellsOf16 = 1 << 12, kCellsOf4 = 1 << 15;

using Runs = std::vector<Interval>;

const WallLattice& lattice_for(std::size_t cells) {
  return kWallLattices[cells <= kCellsOf16 ? 0 : cells <= kCellsOf4 ? 1 : 2];
}

/// The largest deviation of three neighbouring rays from a straight line; infinite if the runs differ.
double curvature(const Runs& a, const Runs& b, const Runs& c) {
  if (a.size() != b.size() || b.size() != c.size()) return HUGE_VAL;
  double max = 0.0;
  const auto add = [&](float p, float q, float r) {
    max = std::max(max,
                   std::abs(static_cast<double>(p) + static_cast<double>(r) - 2.0 * static_cast<double>(q)));
  };
  for (std::size_t k = 0; k < b.size(); ++k) {
    add(a[k].low, b[k].low, c[k].low);
    add(a[k].high, b[k].high, c[k].high);
  }
  return max;
}

}  // namespace

RotaryWalls::RotaryWalls(const RotaryWorkpiece& work) : work_(work) {
  for (int i = 0; i < work.along; ++i)
    for (int j = 0; j < work.around; ++j)
      if (is_wall(i, j)) cells_.push_back({i, j});
}

const Runs& RotaryWalls::runs(int i, int j) const {
  const int row = (j + work_.around) % work_.around, column = std::clamp(i, 0, work_.along - 1);
  return work_.rays[static_cast<std::size_t>(row) * static_cast<std::size_t>(work_.along) +
                    static_cast<std::size_t>(column)];
}

bool RotaryWalls::is_wall(int i, int j) const {
  const Runs& here = runs(i, j);
  const double limit = kStraight * work_.dx;
  return curvature(runs(i - 1, j), here, runs(i + 1, j)) > limit ||
         curvature(runs(i, j - 1), here, runs(i, j + 1)) > limit;
}

double RotaryWalls::cut(int first, int last, const std::vector<RotaryMotion>& motions,
                        const std::vector<RotaryTool>& tools, double hazard_depth, SlabResult& result) const {
  const auto before = [](const Cell& cell, int i) { return cell.i < i; };
  const auto begin = std::lower_bound(cells_.begin(), cells_.end(), first, before);
  const auto end = std::lower_bound(begin, cells_.end(), last + 1, before);
  if (begin == end) return 0.0;
  const WallLattice& lattice = lattice_for(cells_.size());
  const double width = kTurn / work_.around, area = work_.dx * width;
  const Runs whole{{0.0f, static_cast<float>(0.5 * work_.bar.diameter), kStockSurface, kStockSurface}};
  std::vector<Runs> all(static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(lattice.count + 1),
                        whole);
  std::vector<std::vector<SlabRay>> rows(static_cast<std::size_t>(work_.around));
  std::vector<SlabRay> rays;
  auto next = all.begin();
  for (auto cell = begin; cell != end; ++cell) {
    const auto add = [&](double along, double around, double weight) {
      rays.push_back({work_.bar.x_low + (cell->i + along) * work_.dx, RayAngle((cell->j + around) * width),
                      weight, &*next++});
      rows[static_cast<std::size_t>(cell->j)].push_back(rays.back());
    };
    visit_points(lattice, cell->i, cell->j,
                 [&](double along, double around) { add(along, around, area / lattice.count); });
    add(0.5, 0.5, -area);
  }
  Slab slab(work_.bar, std::move(rows), hazard_depth);
  for (const RotaryMotion& motion : motions) slab.cut(motion, tools[motion.tool]);
  result = std::move(slab.result);
  double lacking = 0.0;
  for (const SlabRay& ray : rays) lacking += ray.weight * sector(*ray.runs);
  return lacking;
}

}  // namespace kerf::sim
