// Decimal numbers of G-code: sign, digits, a point; no exponent. Blanks between the characters are ignored.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kerf/base/limits.h"

namespace kerf::gcode {

enum class DecimalFault : std::uint8_t { none, missing, malformed, too_large };

struct Decimal {
  double value = 0.0;
  const char* end = nullptr;  // first character after the number, or the one that is wrong
  DecimalFault fault = DecimalFault::none;
};

namespace detail {

inline constexpr int kExactDigits = 15;  // any integer of so many digits is a double
inline constexpr double kTenTo[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                    1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// The general case: blanks inside, any number of digits, all faults.
Decimal read_any_decimal(const char* begin, const char* end);

/// True if the number read up to `p` certainly ends there: a line end, a letter but E, or a blank before a
/// letter.
inline bool ends_plainly(const char* p, const char* end) {
  if (p == end) return true;
  if (*p == ' ' && ++p == end) return true;
  return *p >= 'F' && *p <= 'Z';
}

}  // namespace detail

/// Reads the number at the start of the range, to the nearest double; never "-0". Numbers of up to 15 digits
/// are one exact division, which rounds to the nearest double.
inline Decimal read_decimal(const char* begin, const char* end) {
  const char* p = begin;
  const bool negative = p != end && *p == '-';
  if (negative) ++p;
  std::uint64_t digits = 0;
  const char* const first = p;
  unsigned digit = 0;
  while (p != end && (digit = static_cast<unsigned>(*p) - '0') < 10) digits = digits * 10 + digit, ++p;
  std::ptrdiff_t count = p - first, decimals = 0;
  if (p != end && *p == '.') {
    const char* const point = p++;
    while (p != end && (digit = static_cast<unsigned>(*p) - '0') < 10) digits = digits * 10 + digit, ++p;
    decimals = p - point - 1;
    count += decimals;
  }
  if (count == 0 || count > detail::kExactDigits || digits > static_cast<std::uint64_t>(limits::kMaxNumber) ||
      !detail::ends_plainly(p, end))
    return detail::read_any_decimal(begin, end);
  const double size = static_cast<double>(digits) / detail::kTenTo[decimals];
  return {(negative ? -size : size) + 0.0, p, DecimalFault::none};
}

}  // namespace kerf::gcode
