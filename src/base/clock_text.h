// Durations as text.
#pragma once

#include <string>

namespace kerf {

/// "0:05", "12:30", "1:02:03"; "?" for what is no duration.
std::string clock_text(double seconds);

}  // namespace kerf
