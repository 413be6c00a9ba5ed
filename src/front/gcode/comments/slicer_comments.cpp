// Comments of slicers.
#include "front/gcode/comments/slicer_comments.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "base/names.h"
#include "base/number.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxBeadSize = 20.0;  // mm
/// A setting of the filament, and the values that it can have.
struct FilamentSetting {
  std::string_view name;
  double low, high;
};
constexpr FilamentSetting kDiameter{"DIAMETER", 0.5, 10.0};  // mm
constexpr FilamentSetting kDensity{"DENSITY", 0.1, 25.0};    // g/cm3; slicers write 0 where it is not set
constexpr std::size_t kSettings = std::size_t{64} * 1024;    // bytes examined at the start and at the end
constexpr std::size_t kMaxLineBytes = 200;                   // of a line with a setting

std::string capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

/// The number at the start of `text`, after blanks.
std::optional<double> leading_number(std::string_view text) {
  text = trim(text);
  const std::size_t end = text.find_first_not_of("0123456789.");
  return parse_number(text.substr(0, end));
}

/// The value of a line such as "; filament_diameter = 1.75", "; filamentDiameters,1.75" or "; Filament
/// Diameter #1: 1.75". Prose about a filament is no setting.
std::optional<double> value_in(std::string_view line, const FilamentSetting& setting) {
  if (line.size() > kMaxLineBytes || line.empty() || line.front() != ';') return std::nullopt;
  const std::string text = capitals(trim(line.substr(1)));
  const std::size_t sign = text.find_first_of("=:,");
  if (sign == std::string::npos) return std::nullopt;
  const std::string_view name = trim(std::string_view(text).substr(0, sign));
  std::string folded = fold_name(name.substr(0, name.find('#')));
  if (!folded.empty() && folded.back() == 's') folded.pop_back();
  if (folded != fold_name("FILAMENT" + std::string(setting.name))) return std::nullopt;
  const auto value = leading_number(std::string_view(text).substr(sign + 1));
  return value && *value >= setting.low && *value <= setting.high ? value : std::nullopt;
}

std::optional<double> value_in_lines(std::string_view text, const FilamentSetting& setting) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (const auto value = value_in(trim(text.substr(0, end)), setting)) return value;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::nullopt;
}

std::optional<double> find_setting(std::string_view text, const FilamentSetting& setting) {
  if (const auto value = value_in_lines(text.substr(0, kSettings), setting)) return value;
  if (text.size() <= kSettings) return std::nullopt;
  return value_in_lines(text.substr(text.size() - std::min(kSettings, text.size() - kSettings)), setting);
}

}  // namespace

std::optional<BeadSize> read_bead_size(std::string_view text) {
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
    const auto value = leading_number(text.substr(n.name.size()));
    if (value && *value >= 0.0 && *value <= kMaxBeadSize) return BeadSize{n.measure, *value};
  }
  return std::nullopt;
}

std::optional<BeadKind> read_bead_kind(std::string_view text) {
  struct Name {
    std::string_view name;
    BeadKind kind;
  };
  static constexpr Name kNames[] = {
      {"EXTERNAL PERIMETER", BeadKind::outer_wall},
      {"OUTER WALL", BeadKind::outer_wall},
      {"WALL-OUTER", BeadKind::outer_wall},
      {"PERIMETER", BeadKind::wall},
      {"INNER WALL", BeadKind::wall},
      {"WALL-INNER", BeadKind::wall},
      {"OVERHANG PERIMETER", BeadKind::overhang},
      {"OVERHANG WALL", BeadKind::overhang},
      {"INTERNAL INFILL", BeadKind::infill},
      {"SPARSE INFILL", BeadKind::infill},
      {"FILL", BeadKind::infill},
      {"SOLID INFILL", BeadKind::solid_infill},
      {"INTERNAL SOLID INFILL", BeadKind::solid_infill},
      {"BOTTOM SURFACE", BeadKind::solid_infill},
      {"SKIN", BeadKind::solid_infill},
      {"TOP SOLID INFILL", BeadKind::top},
      {"TOP SURFACE", BeadKind::top},
      {"BRIDGE INFILL", BeadKind::bridge},
      {"INTERNAL BRIDGE INFILL", BeadKind::bridge},
      {"BRIDGE", BeadKind::bridge},
      {"INTERNAL BRIDGE", BeadKind::bridge},
      {"GAP FILL", BeadKind::gap_fill},
      {"GAP INFILL", BeadKind::gap_fill},
      {"IRONING", BeadKind::ironing},
      {"SKIRT", BeadKind::skirt},
      {"SKIRT/BRIM", BeadKind::skirt},
      {"BRIM", BeadKind::skirt},
      {"SUPPORT MATERIAL", BeadKind::support},
      {"SUPPORT", BeadKind::support},
      {"SUPPORT MATERIAL INTERFACE", BeadKind::support_interface},
      {"SUPPORT INTERFACE", BeadKind::support_interface},
      {"SUPPORT-INTERFACE", BeadKind::support_interface},
      {"WIPE TOWER", BeadKind::purge},
      {"PRIME TOWER", BeadKind::purge},
      {"PRIME-TOWER", BeadKind::purge},
  };
  constexpr std::string_view kType = "TYPE:", kFeature = "FEATURE:";
  const bool is_type = text.substr(0, kType.size()) == kType;
  if (!is_type && text.substr(0, kFeature.size()) != kFeature) return std::nullopt;
  const std::string name = capitals(trim(text.substr(is_type ? kType.size() : kFeature.size())));
  for (const Name& n : kNames)
    if (n.name == name) return n.kind;
  return BeadKind::custom;
}

std::optional<double> find_filament_diameter(std::string_view text) { return find_setting(text, kDiameter); }

bool find_volumetric(std::string_view text) {
  const auto says = [](std::string_view part) {
    while (!part.empty()) {
      const std::size_t end = std::min(part.find('\n'), part.size());
      const std::string_view line = trim(part.substr(0, end));
      part.remove_prefix(std::min(end + 1, part.size()));
      if (line.empty() || line.front() != ';') continue;
      const std::string_view setting = trim(line.substr(1));
      const std::size_t equals = setting.find('=');
      if (equals != std::string_view::npos && trim(setting.substr(0, equals)) == "use_volumetric_e")
        return trim(setting.substr(equals + 1)) == "1";
    }
    return false;
  };
  return says(text.substr(0, kSettings)) ||
         (text.size() > kSettings &&
          says(text.substr(text.size() - std::min(kSettings, text.size() - kSettings))));
}

std::optional<double> find_filament_density(std::string_view text) { return find_setting(text, kDensity); }

}  // namespace kerf::gcode
