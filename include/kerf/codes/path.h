// The codes of the diagnostics of the toolpath and its check, from path.def.
#pragma once

#include "kerf/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "kerf/codes/path.def"
#undef KERF_CODE

}  // namespace kerf::codes
