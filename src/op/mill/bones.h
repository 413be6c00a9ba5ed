// Dog-bones and T-bones: cuts beyond the inner corners of a path, so that square corners of another part fit.
#pragma once

#include "op/base/reach.h"

#include "kerf/op/mill.h"

namespace kerf::op_detail {

/// What the bones are those of.
struct BoneWork {
  const Region& region;
  const Tool& tool;
  const Reach& reach;  ///< of the last pass along the walls
  ReachSide side;
  const BoneOptions& options;
  const CutOptions& cut;
  Length finish{};  ///< what the passes before the last leave
};
/// Adds a cut to the tip of a bone and back wherever the path comes to a corner of the walls on a level, once
/// on each, and removes what that cuts from `unreached`. False, with an error, where that fails.
bool add_bones(Operation& made, const BoneWork& work, Diagnostics& diagnostics);

/// False, with an error, where options are out of range.
bool valid(const BoneOptions& options, const CutOptions& cut, Diagnostics& diagnostics);

}  // namespace kerf::op_detail
