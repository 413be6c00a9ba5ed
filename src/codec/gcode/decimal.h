// Decimal numbers of G-code: sign, digits, a point; no exponent. Blanks between the characters do not count.
#pragma once

#include <cstdint>

namespace kerf::gcode {

enum class DecimalFault : std::uint8_t { none, missing, malformed, too_large };

struct Decimal {
  double value = 0.0;
  const char* end = nullptr;  // first character after the number, or the one that is wrong
  DecimalFault fault = DecimalFault::none;
};

/// No number of a program is as large as this; larger ones are refused.
inline constexpr double kLargestNumber = 1e12;

/// Reads the number that begins at `begin`, to the nearest double; never "-0".
Decimal read_decimal(const char* begin, const char* end);

}  // namespace kerf::gcode
