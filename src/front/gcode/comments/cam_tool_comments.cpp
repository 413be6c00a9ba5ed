// Remarks of Fusion 360 and HSM, CamBam, CopperCAM and Estlcam; each form by its own small reader.
#include "front/gcode/comments/cam_tool_comments.h"

#include <cctype>
#include <string>

#include "kerf/names.h"
#include "kerf/number.h"

namespace kerf::gcode {
namespace {

constexpr double kLargest = 500.0;     // mm of diameter
constexpr double kUsualPoint = 118.0;  // degrees, of a drill
constexpr std::size_t kMostDigits = 8;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The number that `text` begins with, blanks before it passed over.
std::optional<double> leading_number(std::string_view text) {
  text = trim(text);
  std::size_t end = 0;
  while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
  return parse_number(text.substr(0, end));
}

/// The number behind `key`, as in "D=3.175".
std::optional<double> behind(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  return leading_number(text.substr(at + key.size()));
}

/// "T12" or "#5": the tool's number, and what follows it.
std::optional<int> take_number(std::string_view& text, std::string_view sign) {
  if (text.substr(0, sign.size()) != sign) return std::nullopt;
  std::string_view rest = text.substr(sign.size());
  std::size_t end = 0;
  while (end < rest.size() && is_digit(rest[end])) ++end;
  if (end == 0 || end > kMostDigits) return std::nullopt;
  const int number = std::stoi(std::string(rest.substr(0, end)));
  text = trim(rest.substr(end));
  return number;
}

bool sensible(double diameter) { return diameter > 0.0 && diameter <= kLargest; }

/// "T4  D=3.175 CR=0 TAPER=45DEG - ZMIN=-5.3 - FLAT END MILL".
std::optional<ToolRemark> from_fusion(std::string_view text, double scale) {
  const std::optional<int> number = take_number(text, "T");
  const std::optional<double> told = behind(text, "D=");
  if (!number || text.substr(0, 2) != "D=" || !told || !sensible(*told * scale)) return std::nullopt;
  const Length diameter = mm(*told * scale), corner = mm(behind(text, "CR=").value_or(0.0) * scale);
  const double taper = behind(text, "TAPER=").value_or(0.0);
  if (text.find("DRILL") != std::string_view::npos)
    return ToolRemark{number, shape::Drill{diameter, {}, degrees(taper > 0.0 ? taper : kUsualPoint)}};
  if (taper > 0.0 && taper < 90.0 && corner.mm() == 0.0)
    return ToolRemark{number, shape::Vee{diameter, {}, degrees(2.0 * taper), {}, {}}};
  if (taper > 0.0) return std::nullopt;
  if (2.0 * corner.mm() >= diameter.mm()) return ToolRemark{number, shape::Ball{diameter, {}}};
  if (corner.mm() > 0.0) return ToolRemark{number, shape::BullNose{diameter, {}, corner}};
  return ToolRemark{number, shape::Square{diameter, {}}};
}

/// "T3 : 0.125" in the program's units.
std::optional<ToolRemark> from_cambam(std::string_view text, double scale) {
  const std::optional<int> number = take_number(text, "T");
  if (!number || text.empty() || text.front() != ':') return std::nullopt;
  const std::optional<double> told = parse_number(trim(text.substr(1)));
  if (!told || !sensible(*told * scale)) return std::nullopt;
  return ToolRemark{number, shape::Square{mm(*told * scale), {}}};
}

/// "TOOL #5 "0.8MM CORN" / DIAMETER 3.175 MM".
std::optional<ToolRemark> from_coppercam(std::string_view text, double) {
  const std::optional<int> number = take_number(text, "TOOL #");
  const std::optional<double> told = behind(text, "DIAMETER ");
  const bool millimetres = text.size() > 2 && text.substr(text.size() - 2) == "MM";
  if (!number || !told || !millimetres || !sensible(*told)) return std::nullopt;
  return ToolRemark{number, shape::Square{mm(*told), {}}};
}

/// "HSS, 2-FLUTE ENDMILL, 2MM".
std::optional<ToolRemark> from_estlcam(std::string_view text, double) {
  const std::size_t comma = text.rfind(',');
  const bool mill =
      text.find("ENDMILL") != std::string_view::npos || text.find("END MILL") != std::string_view::npos;
  if (!mill || comma == std::string_view::npos || text.size() < 3) return std::nullopt;
  const std::string_view size = trim(text.substr(comma + 1));
  if (size.size() < 3 || size.substr(size.size() - 2) != "MM") return std::nullopt;
  const std::optional<double> told = parse_number(trim(size.substr(0, size.size() - 2)));
  if (!told || !sensible(*told)) return std::nullopt;
  return ToolRemark{std::nullopt, shape::Square{mm(*told), {}}};
}

}  // namespace

std::optional<ToolRemark> read_remark(std::string_view text, double scale) {
  std::string capitals(trim(text));
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const auto reader : {from_fusion, from_cambam, from_coppercam, from_estlcam})
    if (const auto remark = reader(capitals, scale)) return remark;
  return std::nullopt;
}

}  // namespace kerf::gcode
