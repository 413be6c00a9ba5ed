// Durations as text.
#include "base/clock_text.h"

#include <cmath>
#include <fmt/format.h>

namespace kerf {

std::string clock_text(double seconds) {
  if (!(seconds >= 0.0) || seconds > 1e9) return "?";
  const long long total = std::llround(seconds);
  if (total < 3600) return fmt::format("{}:{:02}", total / 60, total % 60);
  return fmt::format("{}:{:02}:{:02}", total / 3600, total / 60 % 60, total % 60);
}

}  // namespace kerf
