// The codes of the diagnostics of OpenSCAD programs, from scad.def.
#pragma once

#include "kerf/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "kerf/codes/scad.def"
#undef KERF_CODE

}  // namespace kerf::codes
