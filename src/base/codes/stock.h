// The codes of the diagnostics of stock, meshes and fixtures, from stock.def.
#pragma once

#include "kerf/base/diagnostics.h"

namespace kerf::codes {

#define KERF_CODE(number, name, meaning) inline constexpr Code name{number};
#include "base/codes/stock.def"
#undef KERF_CODE

}  // namespace kerf::codes
