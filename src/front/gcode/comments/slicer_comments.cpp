// Remarks of slicers.
#include "front/gcode/comments/slicer_comments.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "kerf/names.h"
#include "kerf/number.h"

namespace kerf::gcode {
namespace {

constexpr double kLargestBead = 20.0;                      // mm
constexpr double kThinnest = 0.5, kThickest = 10.0;        // mm, of filaments
constexpr std::size_t kSettings = std::size_t{64} * 1024;  // bytes at the begin and at the end
constexpr std::size_t kLongest = 200;                      // bytes of a line that tells a diameter

std::string capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

/// The number that `text` begins with, after blanks.
std::optional<double> leading_number(std::string_view text) {
  text = trim(text);
  const std::size_t end = text.find_first_not_of("0123456789.");
  return parse_number(text.substr(0, end));
}

/// The diameter that a line tells, if any.
std::optional<double> diameter_in(std::string_view line) {
  if (line.size() > kLongest || line.empty() || line.front() != ';') return std::nullopt;
  const std::string text = capitals(line);
  const std::size_t filament = text.find("FILAMENT");
  if (filament == std::string::npos) return std::nullopt;
  const std::size_t diameter = text.find("DIAMETER", filament);
  if (diameter == std::string::npos) return std::nullopt;
  const std::size_t sign = text.find_first_of("=:,", diameter);
  if (sign == std::string::npos) return std::nullopt;
  const auto told = leading_number(std::string_view(text).substr(sign + 1));
  return told && *told >= kThinnest && *told <= kThickest ? told : std::nullopt;
}

std::optional<double> diameter_in_lines(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (const auto told = diameter_in(trim(text.substr(0, end)))) return told;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::nullopt;
}

}  // namespace

std::optional<BeadRemark> read_bead_remark(std::string_view text) {
  struct Name {
    std::string_view name;
    BeadMeasure measure;
  };
  constexpr Name kNames[] = {{"HEIGHT:", BeadMeasure::height},
                             {"LAYER_HEIGHT:", BeadMeasure::height},
                             {"WIDTH:", BeadMeasure::width},
                             {"LINE_WIDTH:", BeadMeasure::width}};
  for (const Name& n : kNames) {
    if (text.substr(0, n.name.size()) != n.name) continue;
    const auto told = leading_number(text.substr(n.name.size()));
    if (told && *told > 0.0 && *told <= kLargestBead) return BeadRemark{n.measure, *told};
  }
  return std::nullopt;
}

std::optional<double> told_filament_diameter(std::string_view text) {
  if (const auto told = diameter_in_lines(text.substr(0, kSettings))) return told;
  if (text.size() <= kSettings) return std::nullopt;
  return diameter_in_lines(text.substr(text.size() - std::min(kSettings, text.size() - kSettings)));
}

}  // namespace kerf::gcode
