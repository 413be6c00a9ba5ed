// Spirals: rings of a pocket that lie around one another, as one path outwards.
#pragma once

#include <optional>
#include <vector>

#include "op/base/cutter.h"

namespace kerf::op_detail {

/// Once around the first ring, along the points, and once around the last ring.
struct Spiral {
  Track first, last;
  std::vector<Point2> points;  ///< from the start of the first ring to a point of the last
};

/// The rings, closed outlines in the direction of the cut, each around the one before; at least two. A turn
/// starts on one ring and ends on the next: its distance from both is in proportion to its length. Nothing
/// where that leaves material which the tool reaches from the rings, or leaves the region.
std::optional<Spiral> spiral_through(const std::vector<Outline>& rings, double tool_radius,
                                     const Walls& walls, const CutOptions& options);

}  // namespace kerf::op_detail
