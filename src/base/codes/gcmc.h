// The codes of the diagnostics of gcmc programs, from gcmc.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/gcmc.def"
#undef KERF_CODE

}  // namespace kerf::codes
