// The codes of the diagnostics of the toolpath and its check, from path.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/path.def"
#undef KERF_CODE

}  // namespace kerf::codes
