// Text as strokes: the fonts that are built in.
#pragma once

#include <cstdint>
#include <string>

#include "front/gcmc/value/runtime.h"

namespace kerf::gcmc {

/// The vector list of typeset(): pen marks and points, capital letters 1.0 high. Undef where there is no such
/// font.
Value typeset_text(Runtime& rt, const std::u32string& text, std::int32_t font);

}  // namespace kerf::gcmc
