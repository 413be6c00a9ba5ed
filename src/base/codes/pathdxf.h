// The codes of the diagnostics of path drawings and measured heights, from pathdxf.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/pathdxf.def"
#undef KERF_CODE

}  // namespace kerf::codes
