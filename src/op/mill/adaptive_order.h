// The order of the runs of an adaptive clearing.
#pragma once

#include <vector>

#include "op/mill/adaptive.h"

namespace kerf::op_detail {

/// The runs of one advance, each after all that is near to it in the passes before.
struct AdaptivePass {
  Region cleared;  ///< what the axis has covered before; empty for an entry
  std::vector<AdaptiveRun> runs;
};

/// One branch of a region after the other, instead of a step in each in turn, where the branches are far
/// enough from each other. A run comes after all runs of earlier passes whose cuts can be near to it.
std::vector<AdaptiveRun> in_order(std::vector<AdaptivePass> passes, double radius, const CutOptions& options);

}  // namespace kerf::op_detail
