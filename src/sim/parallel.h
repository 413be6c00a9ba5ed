// base/parallel.h under the simulator's own names.
#pragma once

#include "base/parallel.h"

namespace kerf::sim {

using kerf::kHasThreads;
using kerf::parallel_for;
using kerf::thread_count;

}  // namespace kerf::sim
