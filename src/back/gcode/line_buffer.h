// A line of G-code in a fixed buffer. Numbers are integers in units of the last decimal, so that writing
// needs no floating point.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace kerf::gcode {

/// "12.5" and "12", "12.500" and "12.000", "12.5" and "12.".
enum class Fraction : std::uint8_t { shortest, full, point };

/// Writes `units` * 10^-decimals at `p`, which has room for 24 characters; returns the end. "12.5", "-0.25"
/// (with Fraction::full "12.500"), never "-0". Without decimals there is no point.
inline char* write_units(char* p, std::int64_t units, int decimals, Fraction fraction) {
  char digits[24];
  char* d = digits + sizeof digits;
  const bool negative = units < 0;
  auto rest = negative ? 0 - static_cast<std::uint64_t>(units) : static_cast<std::uint64_t>(units);
  if (negative) *p++ = '-';
  int count = decimals;
  while (count > 0 && fraction != Fraction::full && rest % 10 == 0) rest /= 10, --count;
  if (count > 0 || (decimals > 0 && fraction == Fraction::point)) {
    for (int i = 0; i < count; ++i) *--d = static_cast<char>('0' + rest % 10), rest /= 10;
    *--d = '.';
  }
  do *--d = static_cast<char>('0' + rest % 10), rest /= 10;
  while (rest != 0);
  while (d != digits + sizeof digits) *p++ = *d++;
  return p;
}

inline constexpr std::size_t kMaxFormula = 250;

/// The words of a line. It cannot overflow: a line has at most 20 words of 25 characters, and one formula
/// of kMaxFormula characters.
class LineBuffer {
 public:
  void clear() { end_ = text_.data(); }
  bool empty() const { return end_ == text_.data(); }
  void put(char c) { *end_++ = c; }
  void put(std::string_view text) {
    for (const char c : text) *end_++ = c;
  }
  void units(std::int64_t value, int decimals, Fraction fraction) {
    end_ = write_units(end_, value, decimals, fraction);
  }
  std::string_view text() const { return {text_.data(), static_cast<std::size_t>(end_ - text_.data())}; }

 private:
  std::array<char, 800> text_{};
  char* end_ = text_.data();
};

}  // namespace kerf::gcode
