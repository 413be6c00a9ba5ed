// Tool comments of Fusion 360, HSM and CamBam, whose forms are fixed: one function per form.
#include "front/gcode/comments/cam_tool_comments.h"

#include <cctype>
#include <string>
#include <utility>

#include "base/names.h"
#include "base/number.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxDiameter = 500.0;        // mm
constexpr double kDefaultPointAngle = 118.0;  // degrees, of a drill
constexpr double kCountersinkAngle = 90.0;    // degrees, without TAPER
constexpr std::size_t kMaxDigits = 8;
constexpr std::size_t kMaxStart = 20;  // of a comment, for its form

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The number at the start of `text`, after blanks.
std::optional<double> leading_number(std::string_view text) {
  text = trim(text);
  std::size_t end = 0;
  while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
  return parse_number(text.substr(0, end));
}

/// The number after `key`, as in "D=3.175".
std::optional<double> number_after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  return leading_number(text.substr(at + key.size()));
}

/// Takes a tool number such as "T12" or "TOOL #5", and the blanks after it, from the start of `text`.
std::optional<int> take_number(std::string_view& text, std::string_view sign) {
  if (text.substr(0, sign.size()) != sign) return std::nullopt;
  std::string_view rest = text.substr(sign.size());
  std::size_t end = 0;
  while (end < rest.size() && is_digit(rest[end])) ++end;
  if (end == 0 || end > kMaxDigits) return std::nullopt;
  const int number = std::stoi(std::string(rest.substr(0, end)));
  text = trim(rest.substr(end));
  return number;
}

bool is_plausible(double diameter) { return diameter > 0.0 && diameter <= kMaxDiameter; }

/// Types of tools whose profile their dimensions do not give.
bool has_unknown_profile(std::string_view text) {
  for (const std::string_view type : {"LOLLIPOP", "THREAD MILL", "SLOT MILL", "RADIUS MILL", "DOVETAIL",
                                      "PROBE", "FORM MILL", "TURNING", "CIRCLE SEGMENT"})
    if (text.find(type) != std::string_view::npos) return true;
  return false;
}

/// "T4  D=3.175 CR=0 TAPER=45DEG - ZMIN=-5.3 - FLAT END MILL".
std::optional<CamTool> from_fusion(std::string_view text, double scale) {
  const std::optional<int> number = take_number(text, "T");
  const std::optional<double> value = number_after(text, "D=");
  if (!number || text.substr(0, 2) != "D=" || !value || !is_plausible(*value * scale)) return std::nullopt;
  const Length diameter = mm(*value * scale), corner = mm(number_after(text, "CR=").value_or(0.0) * scale);
  const double taper = number_after(text, "TAPER=").value_or(0.0);
  if (has_unknown_profile(text)) return std::nullopt;
  if (text.find("DRILL") != std::string_view::npos)
    return CamTool{number, shape::Drill{diameter, {}, degrees(taper > 0.0 ? taper : kDefaultPointAngle)}};
  if (taper > 0.0 && taper < 90.0 && corner.mm() == 0.0)
    return CamTool{number, shape::Vee{diameter, {}, degrees(2.0 * taper), {}, {}}};
  if (taper > 0.0) return std::nullopt;
  if (text.find("COUNTER SINK") != std::string_view::npos ||
      text.find("COUNTERSINK") != std::string_view::npos)
    return CamTool{number, shape::Vee{diameter, {}, degrees(kCountersinkAngle), {}, {}}, kAssumedCountersink};
  if (2.0 * corner.mm() >= diameter.mm()) return CamTool{number, shape::Ball{diameter, {}}};
  if (corner.mm() > 0.0) return CamTool{number, shape::BullNose{diameter, {}, corner}};
  return CamTool{number, shape::Square{diameter, {}}, assumed_profile(text)};
}

/// "T3 : 0.125" in the program's units.
std::optional<CamTool> from_cambam(std::string_view text, double scale) {
  const std::optional<int> number = take_number(text, "T");
  if (!number || text.empty() || text.front() != ':') return std::nullopt;
  const std::optional<double> value = parse_number(trim(text.substr(1)));
  if (!value || !is_plausible(*value * scale)) return std::nullopt;
  return CamTool{number, shape::Square{mm(*value * scale), {}}};
}

}  // namespace

std::string_view assumed_profile(std::string_view capitals) {
  constexpr std::pair<std::string_view, std::string_view> kTools[] = {
      {"TAP", "a tap, simulated as a cylinder without its thread"},
      {"REAMER", "a reamer, simulated as a cylinder"},
      {"BORING BAR", "a boring bar, simulated as a cylinder of its diameter"},
      {"BORING HEAD", "a boring head, simulated as a cylinder of its diameter"}};
  for (const auto& [name, text] : kTools) {
    const std::size_t at = capitals.find(name);
    if (at == std::string_view::npos) continue;
    const auto letter = [&](std::size_t i) {
      return i < capitals.size() && capitals[i] >= 'A' && capitals[i] <= 'Z';
    };
    if ((at == 0 || !letter(at - 1)) && !letter(at + name.size())) return text;
  }
  return {};
}

std::optional<CamTool> read_cam_tool(std::string_view text, double scale) {
  std::string capitals(trim(text));
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const auto reader : {from_fusion, from_cambam})
    if (const auto tool = reader(capitals, scale)) return tool;
  return std::nullopt;
}

bool is_other_tool_form(std::string_view text) {
  text = trim(text);
  std::string capitals(text.substr(0, kMaxStart));
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string_view rest = capitals;
  return take_number(rest, "T") && rest.substr(0, 2) == "D=";
}

}  // namespace kerf::gcode
