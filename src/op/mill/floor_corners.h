// The parts of a carved floor that another tool leaves, by the carving tool.
#pragma once

#include <optional>

#include "op/mill/carving_edge.h"

#include "kerf/op/mill.h"

namespace kerf::op_detail {

/// Rings at the depth, with the axis of the tool within `permitted`. An empty path where nothing is left.
std::optional<Operation> carved_corners(const FloorCorners& corners, const Region& permitted,
                                        const Tool& tool, const CarvingEdge& edge, const CutOptions& cut,
                                        Diagnostics& diagnostics);

}  // namespace kerf::op_detail
