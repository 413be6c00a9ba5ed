// The codes of the diagnostics of outlines, regions and drawings, from outline.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/outline.def"
#undef KERF_CODE

}  // namespace kerf::codes
