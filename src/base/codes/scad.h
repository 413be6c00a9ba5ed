// The codes of the diagnostics of OpenSCAD programs, from scad.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/scad.def"
#undef KERF_CODE

}  // namespace kerf::codes
