// The codes of the diagnostics of OpenSCAD programs, from codes_scad.def: codes::scad_syntax and so on.
#pragma once

#include "kerf/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "kerf/codes_scad.def"
#undef KERF_CODE

}  // namespace kerf::codes
