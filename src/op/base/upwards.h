// Passes that add heights require to know which way is up.
#pragma once

#include <fmt/format.h>
#include <string_view>

#include "base/codes/op.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/check.h"

namespace kerf::op_detail {

/// False, with an error, for a program that seems to count Z downwards. `what`: the heights that a pass adds.
inline bool counts_upwards(const Toolpath& path, std::string_view what, Diagnostics& diagnostics) {
  const auto downwards = find_z_downwards(path);
  if (!downwards) return true;
  diagnostics
      .error(codes::pass_refused, path.origin_of(downwards->step),
             fmt::format("{} require Z upwards; {}", what, downwards->message))
      .hint = downwards->hint;
  return false;
}

}  // namespace kerf::op_detail
