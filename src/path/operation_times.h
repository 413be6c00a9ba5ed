// The operations of a toolpath: the sections that tool changes, layers and notes start.
#pragma once

#include <vector>

#include "kerf/path/estimate.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// As TimeEstimate::operations, from the seconds of each step, without halts.
std::vector<OperationTime> operation_times(const Toolpath& path, const std::vector<float>& seconds);

}  // namespace kerf
