// The codes of the diagnostics of operations, cutting jobs and passes, from op.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/op.def"
#undef KERF_CODE

}  // namespace kerf::codes
