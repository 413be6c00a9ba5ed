// Numbers as text and back, and the closest known word.
#include "base/number.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <iterator>
#include <numeric>

#include "base/names.h"

#include "kerf/base/units.h"

namespace kerf {
namespace {

/// True if all digits are zeros, so that a minus sign before them would be "-0".
bool is_zero_text(std::string_view text) { return text.find_first_of("123456789") == std::string_view::npos; }

constexpr std::uint64_t kTens[] = {1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};
constexpr int kBlock = 8;  // digits written at once

/// The eight digits of a number below 10^8, one per byte, the first in the lowest byte. The parts of the
/// number are divided in parallel in one word.
inline std::uint64_t eight_digits(std::uint64_t value) {
  std::uint64_t parts = value / 10'000 | value % 10'000 << 32;  // four digits in each half
  std::uint64_t upper = (parts * 10'486 >> 20) & 0x0000'007F'0000'007F;
  parts = upper | (parts - upper * 100) << 16;  // two digits in each quarter
  upper = (parts * 103 >> 10) & 0x000F'000F'000F'000F;
  return upper | (parts - upper * 10) << 8;
}

/// Writes eight bytes of digits.
inline void put_digits(char* at, std::uint64_t digits) {
  digits += 0x3030'3030'3030'3030;
  for (int i = 0; i < kBlock; ++i) at[i] = static_cast<char>(digits >> 8 * i);
}
inline void put_eight(char* at, std::uint64_t value) { put_digits(at, eight_digits(value)); }

/// Writes a whole number and returns the end. Up to seven bytes after it are overwritten.
inline char* put_whole(char* out, std::uint64_t value) {
  if (value < 10) {
    *out = static_cast<char>('0' + value);
    return out + 1;
  }
  if (value >= kTens[kBlock]) {
    out = put_whole(out, value / kTens[kBlock]);
    put_eight(out, value % kTens[kBlock]);
    return out + kBlock;
  }
  const std::uint64_t digits = eight_digits(value);
  const int zeros =
      std::countr_zero(digits | std::uint64_t{1} << 56) / 8;  // before the first significant digit
  put_digits(out, digits >> 8 * zeros);
  return out + (kBlock - zeros);
}

constexpr double kExactTens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
__extension__ typedef unsigned __int128 Wide;

/// digits / 10^decimals rounded to the nearest double, ties to even; 1 <= decimals <= 19. Nothing if the
/// quotient has too few bits for that.
std::optional<double> rounded_quotient(std::uint64_t digits, int decimals) {
  constexpr int kMantissa = 53;
  std::uint64_t power = 1;
  for (int i = 0; i < decimals; ++i) power *= 10;
  const Wide scaled = static_cast<Wide>(digits) << 64;
  const Wide quotient = scaled / power;
  const bool inexact = quotient * power != scaled;
  const auto high = static_cast<std::uint64_t>(quotient >> 64), low = static_cast<std::uint64_t>(quotient);
  const int bits = high != 0 ? 128 - std::countl_zero(high) : 64 - std::countl_zero(low);
  const int dropped = bits - kMantissa;
  if (dropped < 1) return std::nullopt;
  auto kept = static_cast<std::uint64_t>(quotient >> dropped);
  const Wide rest = quotient & ((static_cast<Wide>(1) << dropped) - 1);
  const Wide half = static_cast<Wide>(1) << (dropped - 1);
  if (rest > half || (rest == half && (inexact || (kept & 1) != 0))) ++kept;
  return std::ldexp(static_cast<double>(kept), dropped - 64);
}

/// Numbers of at most 19 digits without an exponent, nearly all in practice; nothing for others, well-formed
/// or not.
std::optional<double> parse_short(std::string_view text) {
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;  // whole numbers up to this are doubles
  const char* p = text.data();
  const char* const end = p + text.size();
  const bool negative = *p == '-';
  if (negative || *p == '+') ++p;
  std::uint64_t digits = 0;
  const char* const first = p;
  for (; p != end && *p >= '0' && *p <= '9'; ++p) digits = 10 * digits + static_cast<unsigned>(*p - '0');
  auto count = p - first;
  int decimals = 0;
  if (p != end && *p == '.') {
    const char* const point = p++;
    for (; p != end && *p >= '0' && *p <= '9'; ++p) digits = 10 * digits + static_cast<unsigned>(*p - '0');
    decimals = static_cast<int>(p - point) - 1;
    count += decimals;
  }
  if (p != end || count == 0 || count > 19) return std::nullopt;
  std::optional<double> value;
  if (digits <= kExact)
    value = static_cast<double>(digits) / kExactTens[decimals];
  else if (decimals > 0)
    value = rounded_quotient(digits, decimals);
  if (value && negative) value = -*value;
  return value;
}

/// Distance of two words in insertions, deletions, replacements and swaps of neighbours, ignoring case.
std::size_t slips_between(std::string_view a, std::string_view b) {
  auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0u : 1u)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

char* write_fixed(char* out, double value, int decimals) {
  constexpr int kMaxDecimals = 15;
  static constexpr double kPowers[kMaxDecimals + 1] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                       1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  constexpr double kMaxScaled =
      1125899906842624.0;             // 2^50: the scaled number and its fraction are then still exact enough
  constexpr double kDoubt = 0x1p-51;  // more than the relative error of one multiplication
  if (decimals < 0 || decimals > kMaxDecimals) return nullptr;
  const double scaled = std::fabs(value) * kPowers[decimals];
  if (!(scaled < kMaxScaled)) return nullptr;
  auto digits = static_cast<std::uint64_t>(scaled);
  const double fraction = scaled - static_cast<double>(digits);
  // Near a half the rounding depends on the exact value, which is unknown here.
  if (std::fabs(fraction - 0.5) <= scaled * kDoubt) return nullptr;
  if (fraction > 0.5) ++digits;
  if (std::signbit(value)) *out++ = '-';
  if (decimals == 0) return put_whole(out, digits);

  // Decimals in blocks of eight. The usual eight are split off by a division by a constant.
  const int last = decimals > kBlock ? decimals - kBlock : decimals;  // of the last block
  const std::uint64_t rest = last == kBlock ? digits / kTens[kBlock] : digits / kTens[last];
  const std::uint64_t tail = digits - rest * kTens[last];
  out = put_whole(out, decimals > kBlock ? rest / kTens[kBlock] : rest);
  *out++ = '.';
  if (decimals > kBlock) {
    put_eight(out, rest % kTens[kBlock]);
    out += kBlock;
  }
  put_eight(out, tail * kTens[kBlock - last]);  // zeros beyond the last decimal are overwritten
  return out + last;
}

void append_fixed(std::string& out, double value, int decimals, MinusZero zero) {
  const std::size_t start = out.size();
  char fast[kFixedRoom];
  if (const char* end = write_fixed(fast, value, decimals))
    out.append(fast, static_cast<std::size_t>(end - fast));
  else
    fmt::format_to(std::back_inserter(out), "{:.{}f}", value, decimals);
  if (zero == MinusZero::drop && out[start] == '-' && is_zero_text(std::string_view(out).substr(start)))
    out.erase(start, 1);
}

void append_number(std::string& out, double value, int decimals) {
  const std::size_t start = out.size();
  append_fixed(out, value, decimals);
  if (out.find('.', start) == std::string::npos) return;
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
}

std::string number_text(double value, int decimals) {
  std::string text;
  append_number(text, value, decimals);
  return text;
}

std::string fixed_text(double value, int decimals) {
  std::string text;
  append_fixed(text, value, decimals);
  return text;
}

std::string exact_text(double value) { return fmt::format("{}", value == 0.0 ? 0.0 : value); }

std::optional<double> parse_number(std::string_view text) {
  constexpr std::size_t kMaxDigits = 512;  // further digits do not change the double
  if (text.empty() || text.size() > kMaxDigits) return std::nullopt;
  if (const auto value = parse_short(text)) return value;
  if (text.find_first_not_of("0123456789+-.eE") != std::string_view::npos) return std::nullopt;
  const std::string copy(text);  // strtod requires a terminator; Kerf never changes the C locale
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  if (end != copy.c_str() + copy.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> mm_per_unit(std::string_view name) {
  const std::string folded = fold_name(name);
  if (folded == "mm") return 1.0;
  if (folded == "in" || folded == "inch" || folded == "inches" || folded == "\"") return kMmPerInch;
  return std::nullopt;
}

std::optional<double> parse_fraction(std::string_view text) {
  text = trim(text);
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return parse_number(text);
  std::string_view upper = trim(text.substr(0, slash));
  const std::size_t dash = upper.find_last_of("- ");
  double whole = 0.0, sign = 1.0;
  if (dash != std::string_view::npos && dash > 0) {  // "1-1/2", "1 1/2"
    const std::string_view before = trim(upper.substr(0, dash));
    const auto number = parse_number(before);
    if (!number || *number != std::floor(*number)) return std::nullopt;
    if (before.front() == '-') sign = -1.0;
    whole = std::abs(*number);
    upper = trim(upper.substr(dash + 1));
  }
  const auto over = parse_number(upper), under = parse_number(trim(text.substr(slash + 1)));
  if (!over || !under || *under == 0.0) return std::nullopt;
  const double value = sign * (whole + *over / *under);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> parse_length(std::string_view text, double scale) {
  text = trim(text);
  if (text.size() > 64) return std::nullopt;
  const std::size_t end = text.find_last_of("0123456789.");
  if (end == std::string_view::npos) return std::nullopt;
  if (end + 1 < text.size()) {
    const auto unit = mm_per_unit(trim(text.substr(end + 1)));
    if (!unit) return std::nullopt;
    scale = *unit;
    text = text.substr(0, end + 1);
  }
  const auto number = parse_fraction(text);
  if (!number) return std::nullopt;
  const double value = *number * scale;
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<std::string> did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  if (word.size() > 64) return std::nullopt;
  const std::string* best = nullptr;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t slips = slips_between(word, candidate);
    if (slips < fewest) {
      fewest = slips;
      best = &candidate;
    }
  }
  return best == nullptr ? std::nullopt : std::optional(*best);
}

}  // namespace kerf
