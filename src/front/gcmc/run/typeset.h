// Text as strokes of the built-in fonts.
#pragma once

#include <cstdint>
#include <string>

#include "front/gcmc/value/runtime.h"

namespace kerf::gcmc {

/// The vector list of typeset(): pen marks and points, capital letters of height 1. Undef if the font does
/// not exist.
Value typeset_text(Runtime& rt, const std::u32string& text, std::int32_t font);

}  // namespace kerf::gcmc
