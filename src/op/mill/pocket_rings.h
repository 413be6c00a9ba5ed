// The rings of a pocket: boundaries of the region that the axis may be in, each smaller than the one before.
#pragma once

#include <optional>
#include <vector>

#include "kerf/op/operation.h"

namespace kerf::op_detail {

/// A connected piece of one of the regions, whose loops are paths.
struct RingCell {
  std::vector<Outline> loops;
  std::vector<std::uint32_t> inner;  ///< cells of the next smaller region inside of it
};
struct Rings {
  std::vector<RingCell> cells;
  std::vector<std::uint32_t> roots;  ///< cells of the largest region
};

/// Rings at the distance `spacing`, nearer where a tool of `radius` would leave material between them.
std::optional<Rings> pocket_rings(const Region& axis, Length spacing, double radius,
                                  const CutOptions& options, Diagnostics& diagnostics);
/// The connected pieces of a region alone, without inner rings.
Rings outer_rings(const Region& axis);

}  // namespace kerf::op_detail
