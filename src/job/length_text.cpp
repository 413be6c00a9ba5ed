// Lengths as text.
#include "job/length_text.h"

#include <cctype>
#include <fmt/format.h>

#include "base/number.h"

#include "kerf/base/units.h"

namespace kerf {

std::string LengthText::of(double mm, int decimals) const {
  return inch_ ? number_text(mm / kMmPerInch, decimals + 1) : number_text(mm, decimals);
}

std::string LengthText::with_unit(double mm, int decimals) const {
  return fmt::format("{} {}", of(mm, decimals), unit());
}

std::string LengthText::volume(double mm3, int decimals) const {
  constexpr double kCube = kMmPerInch * kMmPerInch * kMmPerInch;
  return inch_ ? number_text(mm3 / kCube, decimals + 3) + " in3" : number_text(mm3, decimals) + " mm3";
}

std::string LengthText::size(Point3 mm) const {
  return fmt::format("{} x {} x {} {}", of(mm.x, 3), of(mm.y, 3), of(mm.z, 3), unit());
}

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The end of the number at `at`, or `at` if there is none.
std::size_t number_end(std::string_view text, std::size_t at) {
  std::size_t end = at + (at < text.size() && text[at] == '-' ? 1u : 0u);
  if (end >= text.size() || !is_digit(text[end])) return at;
  while (end < text.size() &&
         (is_digit(text[end]) || (text[end] == '.' && end + 1 < text.size() && is_digit(text[end + 1]))))
    ++end;
  return end;
}

bool is_word_end(std::string_view text, std::size_t at) {
  return at >= text.size() || (std::isalnum(static_cast<unsigned char>(text[at])) == 0 && text[at] != '/');
}

/// Whether the number at `at` follows an axis: "Z -5", "X12 to 60".
bool follows_axis(std::string_view text, std::size_t at) {
  if (at > 0 && text[at - 1] == ' ') --at;
  const bool axis = at > 0 && text[at - 1] >= 'X' && text[at - 1] <= 'Z';
  return axis && (at < 2 || std::isalnum(static_cast<unsigned char>(text[at - 2])) == 0);
}

}  // namespace

std::string LengthText::message(std::string_view text) const {
  if (!inch_) return std::string(text);
  std::string out;
  bool range = false;  // after the first number of "Z -5 to 3"
  for (std::size_t at = 0; at < text.size();) {
    const bool starts =
        at == 0 || std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0 || follows_axis(text, at);
    const std::size_t end = starts ? number_end(text, at) : at;
    if (end == at) {
      out += text[at++];
      continue;
    }
    const std::string_view rest = text.substr(end);
    const double value = parse_number(text.substr(at, end - at)).value_or(0.0);
    const bool feed = rest.substr(0, 7) == " mm/min" && is_word_end(rest, 7);
    const bool unit = feed || (rest.substr(0, 3) == " mm" && is_word_end(rest, 3));
    const bool coordinate = follows_axis(text, at) || range;
    out += unit || coordinate ? of(value, 4) : std::string(text.substr(at, end - at));
    range = coordinate && rest.substr(0, 4) == " to ";
    if (range) out += " to ";
    if (unit) out += feed ? " in/min" : " in";
    at = end + (range ? 4u : feed ? 7u : unit ? 3u : 0u);
  }
  return out;
}

std::string LengthText::tool(const Tool& tool) const {
  return fmt::format("{} {}", name_of(tool.shape), with_unit(tool.diameter.mm(), 3));
}

}  // namespace kerf
