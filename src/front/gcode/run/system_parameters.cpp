// Parameters that hold the controller's state: #5220, #5420, #<_x>, #<_feed> and so on.
//
// Source: LinuxCNC's pages "Predefined named parameters" and "Numbered parameters".
#include "front/gcode/run/system_parameters.h"

namespace kerf::gcode {
namespace {

double truth(bool value) { return value ? 1.0 : 0.0; }

}  // namespace

Point3 SystemParameters::program_position() const {
  const Point3 p = coordinates_.frame().to_program(context_.position.at);
  return {p.x / context_.modes.scale, p.y / context_.modes.scale, p.z / context_.modes.scale};
}

std::optional<double> SystemParameters::system_number(int number) const {
  if (number < 5070) return std::nullopt;
  if (number >= 5211 && number <= 5213)
    return coordinates_.local_shift()[number - 5211] / context_.modes.scale;
  if (number >= 5420 && number <= 5422) return program_position()[number - 5420];
  if (number >= 5423 && number <= 5425) return rotary_.angle(static_cast<std::size_t>(number - 5423));
  switch (number) {
    case 5210: return truth(coordinates_.shift_is_on());
    case 5220: return context_.modes.system;
    case 5400: return context_.modes.tool.value_or(0);
    case 5410: return diameters_.of(context_.modes.tool.value_or(0)).value_or(0.0) / context_.modes.scale;
    default: return std::nullopt;
  }
}

/// Stored values and positions of the machine.
bool SystemParameters::is_unknown_number(int number) const {
  const auto has = [](unsigned axes, int axis) { return (axes >> static_cast<unsigned>(axis) & 1u) != 0; };
  if (number < Parameters::kFirstStored) return false;
  const bool home = (number >= 5161 && number <= 5163) || (number >= 5181 && number <= 5183);
  if (home && context_.parameters.is_assigned(number)) return false;
  if (number <= 5163) return has(coordinates_.home(Reference::home).unknown, number - 5161);
  if (number >= 5181 && number <= 5183)
    return has(coordinates_.home(Reference::second_home).unknown, number - 5181);
  if (number >= 5211 && number <= 5213) return has(coordinates_.offsets().unknown_shift(), number - 5211);
  if (number >= 5420 && number <= 5422) return has(context_.position.unknown, number - 5420);
  if (number >= 5423 && number <= 5425) return has(rotary_.unknown(), number - 5423);
  if (number == 5410) return !diameters_.of(context_.modes.tool.value_or(0));
  const int system = (number - 5221) / 20 + 1, axis = (number - 5221) % 20;
  if (number < 5221 || system > WorkOffsets::kSystems || axis > 2) return false;
  const auto n = static_cast<std::size_t>(system);
  const bool assigned = context_.parameters.slot(number) != coordinates_.offsets().written[n][axis];
  return !assigned && coordinates_.offsets().base[n][static_cast<std::size_t>(axis)] != 0;
}

bool SystemParameters::is_unknown_name(std::string_view name) const {
  const std::string_view axes = "xyzabc";
  const bool absolute = name.substr(0, 5) == "_abs_";
  const std::string_view rest = name.substr(absolute ? 5 : 1);
  if (rest.size() == 1 && axes.find(rest) != std::string_view::npos) {
    const auto axis = axes.find(rest);
    if (axis > 2) return (rotary_.unknown() >> (axis - 3) & 1u) != 0;
    const bool in_machine =
        coordinates_.offsets().base[static_cast<std::size_t>(context_.modes.system)][axis] == 0;
    return (context_.position.unknown >> axis & 1u) != 0 || (absolute && !in_machine);
  }
  return name == "_tool_offset" && tools_.length_is_of_table();
}

/// Homes and offsets are stored in mm.
double SystemParameters::unit_of(int number) const {
  const bool home = (number >= 5161 && number <= 5163) || (number >= 5181 && number <= 5183);
  const int axis = (number - 5221) % 20;
  const bool offset = number >= 5221 && number <= 5390 && axis < 3;
  return home || offset ? context_.modes.scale : 1.0;
}

std::optional<double> SystemParameters::system_name(std::string_view name) const {
  using Read = double (*)(const SystemParameters&);
  using I = SystemParameters;
  static const std::map<std::string_view, Read> kNames{
      {"_vmajor", [](const I&) { return 2.9; }},
      {"_vminor", [](const I&) { return 0.0; }},
      {"_line", [](const I& i) { return static_cast<double>(i.context_.reporter.line()); }},
      {"_motion_mode", [](const I& i) { return static_cast<double>(i.context_.modes.motion); }},
      {"_plane",
       [](const I& i) {
         return i.context_.modes.plane == Plane::xy   ? 170.0
                : i.context_.modes.plane == Plane::xz ? 180.0
                                                      : 190.0;
       }},
      {"_ccomp",
       [](const I& i) {
         if (!i.compensation_.is_on()) return 400.0;
         return i.compensation_.is_left() ? 410.0 : 420.0;
       }},
      {"_metric", [](const I& i) { return truth(i.context_.modes.scale == 1.0); }},
      {"_imperial", [](const I& i) { return truth(i.context_.modes.scale != 1.0); }},
      {"_absolute", [](const I& i) { return truth(i.context_.modes.absolute); }},
      {"_incremental", [](const I& i) { return truth(!i.context_.modes.absolute); }},
      {"_inverse_time",
       [](const I& i) { return truth(i.context_.modes.feed_mode == FeedMode::inverse_time); }},
      {"_units_per_minute",
       [](const I& i) { return truth(i.context_.modes.feed_mode == FeedMode::per_minute); }},
      {"_units_per_rev", [](const I& i) { return truth(i.context_.modes.feed_mode == FeedMode::per_turn); }},
      {"_coord_system",
       [](const I& i) {
         return i.context_.modes.system <= 6 ? 530.0 + 10.0 * i.context_.modes.system
                                             : 584.0 + i.context_.modes.system;
       }},
      {"_tool_offset", [](const I&) { return 0.0; }},
      {"_retract_r_plane", [](const I& i) { return truth(!i.context_.modes.retract_to_start); }},
      {"_retract_old_z", [](const I& i) { return truth(i.context_.modes.retract_to_start); }},
      {"_spindle_rpm_mode", [](const I& i) { return truth(!(i.context_.modes.surface_speed > 0.0)); }},
      {"_spindle_css_mode", [](const I& i) { return truth(i.context_.modes.surface_speed > 0.0); }},
      {"_ijk_absolute_mode", [](const I& i) { return truth(i.context_.modes.absolute_centres); }},
      {"_lathe_diameter_mode", [](const I& i) { return truth(i.context_.modes.diameters); }},
      {"_lathe_radius_mode", [](const I& i) { return truth(!i.context_.modes.diameters); }},
      {"_spindle_on", [](const I& i) { return truth(i.context_.modes.spindle != SpindleTurn::off); }},
      {"_spindle_cw", [](const I& i) { return truth(i.context_.modes.spindle == SpindleTurn::cw); }},
      {"_mist", [](const I& i) { return truth(i.context_.modes.mist); }},
      {"_flood", [](const I& i) { return truth(i.context_.modes.flood); }},
      {"_speed_override", [](const I& i) { return truth(i.context_.modes.speed_override); }},
      {"_feed_override", [](const I& i) { return truth(i.context_.modes.feed_override); }},
      {"_adaptive_feed", [](const I& i) { return truth(i.context_.modes.adaptive_feed); }},
      {"_feed_hold", [](const I& i) { return truth(i.context_.modes.feed_hold); }},
  };
  const auto found = kNames.find(name);
  return found == kNames.end() ? position_parameter(name) : found->second(*this);
}

/// Position, feed, speed and tool.
std::optional<double> SystemParameters::position_parameter(std::string_view name) const {
  using Read = double (*)(const SystemParameters&);
  using I = SystemParameters;
  static const std::map<std::string_view, Read> kNames{
      {"_feed",
       [](const I& i) {
         if (i.feeds_.mode_repeated()) return 0.0;  // G94 or G95 without F
         return i.context_.modes.feed_mode == FeedMode::inverse_time
                    ? i.context_.modes.feed
                    : i.context_.modes.feed / i.context_.modes.feed_scale;
       }},
      {"_rpm", [](const I& i) { return i.context_.modes.speed; }},
      {"_x", [](const I& i) { return i.program_position().x; }},
      {"_y", [](const I& i) { return i.program_position().y; }},
      {"_z", [](const I& i) { return i.program_position().z; }},
      {"_a", [](const I& i) { return i.rotary_.angle(0); }},
      {"_b", [](const I& i) { return i.rotary_.angle(1); }},
      {"_c", [](const I& i) { return i.rotary_.angle(2); }},
      {"_u", [](const I&) { return 0.0; }},
      {"_v", [](const I&) { return 0.0; }},
      {"_w", [](const I&) { return 0.0; }},
      {"_abs_x", [](const I& i) { return i.context_.position.at.x / i.context_.modes.scale; }},
      {"_abs_y", [](const I& i) { return i.context_.position.at.y / i.context_.modes.scale; }},
      {"_abs_z", [](const I& i) { return i.context_.position.at.z / i.context_.modes.scale; }},
      {"_abs_a", [](const I& i) { return i.rotary_.angle(0); }},
      {"_abs_b", [](const I& i) { return i.rotary_.angle(1); }},
      {"_abs_c", [](const I& i) { return i.rotary_.angle(2); }},
      {"_current_tool", [](const I& i) { return static_cast<double>(i.context_.modes.tool.value_or(0)); }},
      {"_current_pocket", [](const I& i) { return static_cast<double>(i.context_.modes.tool.value_or(0)); }},
      {"_selected_tool",
       [](const I& i) { return static_cast<double>(i.context_.modes.selected_tool.value_or(-1)); }},
      {"_selected_pocket",
       [](const I& i) { return static_cast<double>(i.context_.modes.selected_tool.value_or(-1)); }},
      {"_value", [](const I&) { return 0.0; }},
      {"_value_returned", [](const I&) { return 0.0; }},
      {"_call_level", [](const I& i) { return static_cast<double>(i.calls_.depth()); }},
      {"_remap_level", [](const I&) { return 0.0; }},
      {"_task", [](const I&) { return 0.0; }},
  };
  const auto found = kNames.find(name);
  if (found == kNames.end()) return std::nullopt;
  return found->second(*this);
}

}  // namespace kerf::gcode
