// The codes of the diagnostics of tools and tool libraries, from tools.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/tools.def"
#undef KERF_CODE

}  // namespace kerf::codes
