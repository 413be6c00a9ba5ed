// Settings of slicers and of Klipper. Sources: PrusaSlicer's "Machine limits"; Klipper's page "G-Codes",
// SET_VELOCITY_LIMIT.
#include "path/planner_texts.h"

#include <array>
#include <utility>

#include "base/names.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr std::string_view kPrefix = "machine_max_", kUsage = "machine_limits_usage";
constexpr double kMaxValue = 1e9;
constexpr std::size_t kMaxLineBytes = 200;

struct Setting {
  std::string_view name;  // after the prefix
  LimitKind kind;
  unsigned given;  // which values
};
constexpr Setting kSettings[] = {
    {"acceleration_x", LimitKind::axis_acceleration, 1},
    {"acceleration_y", LimitKind::axis_acceleration, 2},
    {"acceleration_z", LimitKind::axis_acceleration, 4},
    {"acceleration_e", LimitKind::axis_acceleration, 8},
    {"feedrate_x", LimitKind::axis_speed, 1},
    {"feedrate_y", LimitKind::axis_speed, 2},
    {"feedrate_z", LimitKind::axis_speed, 4},
    {"feedrate_e", LimitKind::axis_speed, 8},
    {"speed_x", LimitKind::axis_speed, 1},
    {"speed_y", LimitKind::axis_speed, 2},
    {"speed_z", LimitKind::axis_speed, 4},
    {"speed_e", LimitKind::axis_speed, 8},
    {"jerk_x", LimitKind::jerk, 1},
    {"jerk_y", LimitKind::jerk, 2},
    {"jerk_z", LimitKind::jerk, 4},
    {"jerk_e", LimitKind::jerk, 8},
    {"acceleration_extruding", LimitKind::acceleration, 1},
    {"acceleration_retracting", LimitKind::acceleration, 2},
    {"acceleration_travel", LimitKind::acceleration, 4},
    {"junction_deviation", LimitKind::junction_deviation, 1},
};

/// "name = value", without blanks around them.
std::optional<std::pair<std::string_view, std::string_view>> setting_in(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || text.size() > kMaxLineBytes) return std::nullopt;
  return std::pair(trim(text.substr(0, equals)), trim(text.substr(equals + 1)));
}

/// The settings in comments whose names start so, in the order of the program.
template <class Take>
void for_each_setting(std::string_view program, std::string_view name, Take take) {
  for (std::size_t at = program.find(name); at != std::string_view::npos; at = program.find(name, at + 1)) {
    const std::size_t start = program.find_last_of("\r\n;", at) + 1;  // npos + 1 is 0
    const bool in_comment =
        start > 0 && program[start - 1] == ';' && trim(program.substr(start, at - start)).empty();
    if (in_comment) take(trim(program.substr(at, program.find_first_of("\r\n", at) - at)));
  }
}

}  // namespace

std::optional<step::MotionLimits> read_limit_note(std::string_view text) {
  const auto setting = setting_in(text);
  if (!setting || setting->first.substr(0, kPrefix.size()) != kPrefix) return std::nullopt;
  const std::string_view first = trim(setting->second.substr(0, setting->second.find(',')));
  const auto value = parse_number(first);
  if (!value || !(*value > 0.0 && *value <= kMaxValue)) return std::nullopt;
  for (const Setting& row : kSettings) {
    if (setting->first.substr(kPrefix.size()) != row.name) continue;
    step::MotionLimits limits{row.kind};
    limits.given = row.given;
    for (std::size_t i = 0; i < limits.values.size(); ++i)
      if ((row.given >> i & 1u) != 0) limits.values[i] = *value;
    return limits;
  }
  return std::nullopt;
}

std::vector<std::string_view> limit_notes(std::string_view program) {
  std::vector<std::string_view> notes;
  bool ignored = false;
  for_each_setting(program, kUsage, [&](std::string_view text) {
    const auto setting = setting_in(text);
    if (setting && setting->first == kUsage) ignored = setting->second == "ignore";
  });
  if (ignored) return notes;
  for_each_setting(program, kPrefix, [&](std::string_view text) {
    if (notes.size() < 2 * std::size(kSettings) && read_limit_note(text)) notes.push_back(text);
  });
  return notes;
}

bool is_planner_note(std::string_view text) {
  return text == kKlipperNote || read_limit_note(text).has_value();
}

CruiseLimit read_cruise_limit(std::string_view line) {
  CruiseLimit limit;
  const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
  if (fold_name(line.substr(0, end)) != "setvelocitylimit") return limit;
  for (std::string_view rest = trim(line.substr(end)); !rest.empty(); rest = trim(rest)) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest.remove_prefix(word.size());
    const auto setting = setting_in(word);
    const auto value = setting ? parse_number(setting->second) : std::nullopt;
    if (!value || !(*value >= 0.0 && *value <= kMaxValue)) continue;
    const std::string name = fold_name(setting->first);
    if (name == "minimumcruiseratio" && *value < 1.0) limit.ratio = *value;
    if (name == "acceltodecel") limit.to_decel = *value;
  }
  return limit;
}

}  // namespace kerf
