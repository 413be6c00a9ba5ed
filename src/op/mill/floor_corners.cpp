// A mill leaves the corners of a floor round, up to the cone of the carving tool along the walls. The carving
// tool removes that in rings: as sharp as its edge is, each leaves a ridge beside it, which the distance of
// the rings keeps low.
#include "op/mill/floor_corners.h"

#include <fmt/format.h>

#include "base/codes/op.h"
#include "op/base/cutter.h"
#include "op/base/reach.h"
#include "op/mill/pocket_rings.h"

namespace kerf::op_detail {
namespace {

constexpr double kSpacing = 1.6;   // of rings, by the radius at the height of a ridge; 2: they just touch
constexpr double kMinLoop = 10.0;  // of the weld tolerance: a shorter ring is a point

/// Outer rings first: beside the wall or the ring before, which are cut, there is nearly nothing to plunge
/// into.
bool cut_rings(const Rings& rings, const Tool& tool, CutOptions cut, Operation& made,
               Diagnostics& diagnostics) {
  cut.entry.kind = EntryKind::plunge;
  std::vector<std::uint32_t> open = rings.roots;
  while (!open.empty()) {
    const RingCell& cell = rings.cells[open.back()];
    open.pop_back();
    open.insert(open.end(), cell.inner.begin(), cell.inner.end());
    std::vector<Outline> loops;
    for (const Outline& loop : cell.loops)
      if (length(loop) > kMinLoop * cut.tolerance.weld)
        loops.push_back(cut.direction == CutDirection::climb ? loop : reversed(loop));
    if (loops.empty()) continue;
    const auto along = contour_on(loops, tool, cut, diagnostics);
    if (!along) return false;
    if (made.path.size() + along->path.size() > cut.max_steps) {
      fail(cut, codes::op_limit, fmt::format("more than {} steps", cut.max_steps), diagnostics);
      return false;
    }
    append(made.path, along->path);
  }
  return true;
}

}  // namespace

std::optional<Operation> carved_corners(const FloorCorners& corners, const Region& permitted,
                                        const Tool& tool, const CarvingEdge& edge, const CutOptions& cut,
                                        Diagnostics& diagnostics) {
  Operation none;
  if (corners.left.empty() || permitted.empty()) return none;
  const auto axis = combine(corners.left, permitted, Boolean::intersect, region_options(cut), diagnostics);
  if (!axis) return std::nullopt;
  const double radius = edge.radius_at(corners.ridge.mm());
  const auto rings = pocket_rings(without_slivers(axis->region, cut.tolerance.chord), mm(kSpacing * radius),
                                  radius, cut, diagnostics);
  if (!rings) return std::nullopt;
  Operation made;
  if (!cut_rings(*rings, tool, cut, made, diagnostics)) return std::nullopt;
  return made;
}

}  // namespace kerf::op_detail
