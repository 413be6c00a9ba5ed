// The finishing pass along the walls of a pocket.
#pragma once

#include "op/base/reach.h"

namespace kerf::op_detail {

/// Around the walls of what `last` describes, where `rough` has left `finish`: one pass at the full depth
/// from inside the pocket, or all passes where the roughing tool did not reach a part. `rough` may be null:
/// nothing was cut before.
std::optional<Toolpath> finish_walls(const Region& region, const Tool& tool, const Reach& last,
                                     const Reach* rough, const CutOptions& cut, Length finish,
                                     Diagnostics& diagnostics);

}  // namespace kerf::op_detail
