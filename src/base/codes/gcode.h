// The codes of the diagnostics of G-code: reading (20xx), posts and their rules (21xx), from gcode.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/gcode.def"
#undef KERF_CODE

}  // namespace kerf::codes
