// Decimal numbers of G-code that are not plain: blanks inside, many digits, faults. Through base/number.h.
#include "codec/gcode/decimal.h"

#include <cmath>
#include <string>

#include "base/number.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxDigits = 600;  // more than base/number.h reads, so that it refuses them

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// The character after a number must not be a part of it.
Decimal checked(Decimal number, const char* end) {
  const char* p = number.end;
  if (p == end) return number;
  const bool sign_or_point = *p == '.' || *p == '+' || *p == '-';
  const char* q = p + 1;
  if (q != end && (*q == '+' || *q == '-')) ++q;
  while (q != end && is_digit(*q)) ++q;
  const bool integer = q != p + 1 && is_digit(q[-1]) && (q == end || *q != '.');  // "0E0.5" is two words
  const bool exponent = (*p == 'e' || *p == 'E') && integer;
  if (sign_or_point || exponent) number.fault = DecimalFault::malformed;
  return number;
}

}  // namespace

Decimal detail::read_any_decimal(const char* begin, const char* end) {
  std::string digits;
  bool point_seen = false, digit_seen = false;
  const char* last = begin;
  for (const char* p = begin; p != end; ++p) {
    if (is_blank(*p)) continue;
    const bool sign = (*p == '+' || *p == '-') && digits.empty();
    const bool point = *p == '.' && !point_seen;
    if (!sign && !point && !is_digit(*p)) break;
    point_seen = point_seen || point;
    digit_seen = digit_seen || is_digit(*p);
    if (digits.size() <= kMaxDigits) digits += *p;
    last = p + 1;
  }
  if (!digit_seen) return {0.0, last, DecimalFault::missing};
  const std::optional<double> value = parse_number(digits);
  if (!value || std::abs(*value) > limits::kMaxNumber) return {0.0, begin, DecimalFault::too_large};
  return checked({*value + 0.0, last, DecimalFault::none}, end);
}

}  // namespace kerf::gcode
