// The codes of the diagnostics of files and the command line, from files.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/files.def"
#undef KERF_CODE

}  // namespace kerf::codes
