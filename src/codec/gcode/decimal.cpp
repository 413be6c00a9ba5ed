// Decimal numbers of G-code. The usual ones take the short way: up to 15 digits and 22 places are one exact division,
// which rounds to the nearest double; all others go through kerf/number.h.
#include "codec/gcode/decimal.h"

#include <cmath>
#include <string>

#include "kerf/number.h"

namespace kerf::gcode {
namespace {

constexpr int kExactDigits = 15;  // any integer of so many digits is a double
constexpr double kTenTo[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                             1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
constexpr std::size_t kLongest = 600;  // more than kerf/number.h reads, so that it refuses them

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// True if the number goes on after the blanks at `p` ("X 1 0" is X10).
bool goes_on_after_blanks(const char* p, const char* end, bool point_seen) {
  if (p == end || !is_blank(*p)) return false;
  while (p != end && is_blank(*p)) ++p;
  return p != end && (is_digit(*p) || (*p == '.' && !point_seen));
}

/// After a number may not follow what would have belonged to it.
Decimal checked(Decimal number, const char* end) {
  const char* p = number.end;
  if (p == end) return number;
  const bool sign_or_point = *p == '.' || *p == '+' || *p == '-';
  const char* q = p + 1;
  if (q != end && (*q == '+' || *q == '-')) ++q;
  const bool exponent = (*p == 'e' || *p == 'E') && q != end && is_digit(*q);
  if (sign_or_point || exponent) number.fault = DecimalFault::malformed;
  return number;
}

/// The long way: blanks inside, or more digits than are exact.
Decimal read_slowly(const char* begin, const char* end) {
  std::string digits;
  bool point_seen = false, digit_seen = false;
  const char* p = begin;
  const char* last = begin;
  for (; p != end; ++p) {
    if (is_blank(*p)) continue;
    const bool sign = (*p == '+' || *p == '-') && digits.empty();
    const bool point = *p == '.' && !point_seen;
    if (!sign && !point && !is_digit(*p)) break;
    point_seen = point_seen || point;
    digit_seen = digit_seen || is_digit(*p);
    if (digits.size() <= kLongest) digits += *p;
    last = p + 1;
  }
  if (!digit_seen) return {0.0, last, DecimalFault::missing};
  const std::optional<double> value = parse_number(digits);
  if (!value) return {0.0, begin, DecimalFault::too_large};
  return {*value + 0.0, last, DecimalFault::none};
}

Decimal bounded(Decimal number) {
  if (number.fault == DecimalFault::none && std::abs(number.value) > kLargestNumber)
    number.fault = DecimalFault::too_large;
  return number;
}

}  // namespace

Decimal read_decimal(const char* begin, const char* end) {
  const char* p = begin;
  while (p != end && is_blank(*p)) ++p;
  const char* first = p;
  bool negative = false;
  if (p != end && (*p == '-' || *p == '+')) {
    negative = *p == '-';
    ++p;
  }
  std::uint64_t digits = 0;
  const char* whole = p;
  for (; p != end && is_digit(*p); ++p) digits = digits * 10 + static_cast<unsigned>(*p - '0');
  auto count = p - whole;
  std::ptrdiff_t places = 0;
  const bool point_seen = p != end && *p == '.';
  if (point_seen) {
    const char* point = p++;
    for (; p != end && is_digit(*p); ++p) digits = digits * 10 + static_cast<unsigned>(*p - '0');
    places = p - point - 1;
    count += places;
  }
  const bool is_short = count > 0 && count <= kExactDigits;
  if (!is_short || goes_on_after_blanks(p, end, point_seen)) return checked(bounded(read_slowly(first, end)), end);
  const double size = static_cast<double>(digits) / kTenTo[places];
  return checked(bounded({(negative ? -size : size) + 0.0, p, DecimalFault::none}), end);
}

}  // namespace kerf::gcode
