// Parameters that hold the controller's state: #5220, #5420, #<_x>, #<_feed> and so on.
//
// Source: LinuxCNC's pages "Predefined named parameters" and "Numbered parameters".
#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

double truth(bool value) { return value ? 1.0 : 0.0; }

}  // namespace

Point3 Interpreter::program_position() const {
  const Point3 p = frame_.to_program(position_.at);
  return {p.x / modes_.scale, p.y / modes_.scale, p.z / modes_.scale};
}

std::optional<double> Interpreter::system_number(int number) const {
  if (number < 5070) return std::nullopt;
  if (number >= 5211 && number <= 5213) return local_shift_[number - 5211] / modes_.scale;
  if (number >= 5420 && number <= 5422) return program_position()[number - 5420];
  if (number >= 5423 && number <= 5425) return rotary_[static_cast<std::size_t>(number - 5423)];
  switch (number) {
    case 5210: return truth(shift_is_on_);
    case 5220: return modes_.system;
    case 5400: return modes_.tool.value_or(0);
    case 5410: return diameter_of(modes_.tool.value_or(0)).value_or(0.0) / modes_.scale;
    default: return std::nullopt;
  }
}

/// Stored values and positions of the machine.
bool Interpreter::is_unknown_number(int number) const {
  const auto has = [](unsigned axes, int axis) { return (axes >> static_cast<unsigned>(axis) & 1u) != 0; };
  if (number < Parameters::kFirstStored) return false;
  const bool home = (number >= 5161 && number <= 5163) || (number >= 5181 && number <= 5183);
  if (home && parameters_.is_assigned(number)) return false;
  if (number <= 5163) return has(home_28_.unknown, number - 5161);
  if (number >= 5181 && number <= 5183) return has(home_30_.unknown, number - 5181);
  if (number >= 5211 && number <= 5213) return has(offsets_.unknown_shift(), number - 5211);
  if (number >= 5420 && number <= 5422) return has(position_.unknown, number - 5420);
  if (number >= 5423 && number <= 5425) return has(rotary_unknown_, number - 5423);
  if (number == 5410) return !diameter_of(modes_.tool.value_or(0));
  const int system = (number - 5221) / 20 + 1, axis = (number - 5221) % 20;
  if (number < 5221 || system > WorkOffsets::kSystems || axis > 2) return false;
  const auto n = static_cast<std::size_t>(system);
  const bool assigned = parameters_.slot(number) != offsets_.written[n][axis];
  return !assigned && offsets_.base[n][static_cast<std::size_t>(axis)] != 0;
}

bool Interpreter::is_unknown_name(std::string_view name) const {
  const std::string_view axes = "xyzabc";
  const bool absolute = name.substr(0, 5) == "_abs_";
  const std::string_view rest = name.substr(absolute ? 5 : 1);
  if (rest.size() == 1 && axes.find(rest) != std::string_view::npos) {
    const auto axis = axes.find(rest);
    if (axis > 2) return (rotary_unknown_ >> (axis - 3) & 1u) != 0;
    const bool in_machine = offsets_.base[static_cast<std::size_t>(modes_.system)][axis] == 0;
    return (position_.unknown >> axis & 1u) != 0 || (absolute && !in_machine);
  }
  return name == "_tool_offset" && tool_length_ && tool_length_->kind == ToolLengthKind::table;
}

/// Homes and offsets are stored in mm.
double Interpreter::unit_of(int number) const {
  const bool home = (number >= 5161 && number <= 5163) || (number >= 5181 && number <= 5183);
  const int axis = (number - 5221) % 20;
  const bool offset = number >= 5221 && number <= 5390 && axis < 3;
  return home || offset ? modes_.scale : 1.0;
}

std::optional<double> Interpreter::system_name(std::string_view name) const {
  using Read = double (*)(const Interpreter&);
  using I = Interpreter;
  static const std::map<std::string_view, Read> kNames{
      {"_vmajor", [](const I&) { return 2.9; }},
      {"_vminor", [](const I&) { return 0.0; }},
      {"_line", [](const I& i) { return static_cast<double>(i.reporter_.line()); }},
      {"_motion_mode", [](const I& i) { return static_cast<double>(i.modes_.motion); }},
      {"_plane",
       [](const I& i) {
         return i.modes_.plane == Plane::xy ? 170.0 : i.modes_.plane == Plane::xz ? 180.0 : 190.0;
       }},
      {"_ccomp",
       [](const I& i) {
         const std::optional<CutterCompensation>& cutter = i.compensation_.cutter;
         return !cutter ? 400.0 : cutter->is_left() ? 410.0 : 420.0;
       }},
      {"_metric", [](const I& i) { return truth(i.modes_.scale == 1.0); }},
      {"_imperial", [](const I& i) { return truth(i.modes_.scale != 1.0); }},
      {"_absolute", [](const I& i) { return truth(i.modes_.absolute); }},
      {"_incremental", [](const I& i) { return truth(!i.modes_.absolute); }},
      {"_inverse_time", [](const I& i) { return truth(i.modes_.feed_mode == FeedMode::inverse_time); }},
      {"_units_per_minute", [](const I& i) { return truth(i.modes_.feed_mode == FeedMode::per_minute); }},
      {"_units_per_rev", [](const I& i) { return truth(i.modes_.feed_mode == FeedMode::per_turn); }},
      {"_coord_system",
       [](const I& i) {
         return i.modes_.system <= 6 ? 530.0 + 10.0 * i.modes_.system : 584.0 + i.modes_.system;
       }},
      {"_tool_offset", [](const I&) { return 0.0; }},
      {"_retract_r_plane", [](const I& i) { return truth(!i.modes_.retract_to_start); }},
      {"_retract_old_z", [](const I& i) { return truth(i.modes_.retract_to_start); }},
      {"_spindle_rpm_mode", [](const I& i) { return truth(!(i.modes_.surface_speed > 0.0)); }},
      {"_spindle_css_mode", [](const I& i) { return truth(i.modes_.surface_speed > 0.0); }},
      {"_ijk_absolute_mode", [](const I& i) { return truth(i.modes_.absolute_centres); }},
      {"_lathe_diameter_mode", [](const I& i) { return truth(i.modes_.diameters); }},
      {"_lathe_radius_mode", [](const I& i) { return truth(!i.modes_.diameters); }},
      {"_spindle_on", [](const I& i) { return truth(i.modes_.spindle != SpindleTurn::off); }},
      {"_spindle_cw", [](const I& i) { return truth(i.modes_.spindle == SpindleTurn::cw); }},
      {"_mist", [](const I& i) { return truth(i.modes_.mist); }},
      {"_flood", [](const I& i) { return truth(i.modes_.flood); }},
      {"_speed_override", [](const I& i) { return truth(i.modes_.speed_override); }},
      {"_feed_override", [](const I& i) { return truth(i.modes_.feed_override); }},
      {"_adaptive_feed", [](const I& i) { return truth(i.modes_.adaptive_feed); }},
      {"_feed_hold", [](const I& i) { return truth(i.modes_.feed_hold); }},
  };
  const auto found = kNames.find(name);
  return found == kNames.end() ? position_parameter(name) : found->second(*this);
}

/// Position, feed, speed and tool.
std::optional<double> Interpreter::position_parameter(std::string_view name) const {
  using Read = double (*)(const Interpreter&);
  using I = Interpreter;
  static const std::map<std::string_view, Read> kNames{
      {"_feed",
       [](const I& i) {
         if (i.feed_mode_repeated_) return 0.0;  // G94 or G95 without F
         return i.modes_.feed_mode == FeedMode::inverse_time ? i.modes_.feed
                                                             : i.modes_.feed / i.modes_.feed_scale;
       }},
      {"_rpm", [](const I& i) { return i.modes_.speed; }},
      {"_x", [](const I& i) { return i.program_position().x; }},
      {"_y", [](const I& i) { return i.program_position().y; }},
      {"_z", [](const I& i) { return i.program_position().z; }},
      {"_a", [](const I& i) { return i.rotary_[0]; }},
      {"_b", [](const I& i) { return i.rotary_[1]; }},
      {"_c", [](const I& i) { return i.rotary_[2]; }},
      {"_u", [](const I&) { return 0.0; }},
      {"_v", [](const I&) { return 0.0; }},
      {"_w", [](const I&) { return 0.0; }},
      {"_abs_x", [](const I& i) { return i.position_.at.x / i.modes_.scale; }},
      {"_abs_y", [](const I& i) { return i.position_.at.y / i.modes_.scale; }},
      {"_abs_z", [](const I& i) { return i.position_.at.z / i.modes_.scale; }},
      {"_abs_a", [](const I& i) { return i.rotary_[0]; }},
      {"_abs_b", [](const I& i) { return i.rotary_[1]; }},
      {"_abs_c", [](const I& i) { return i.rotary_[2]; }},
      {"_current_tool", [](const I& i) { return static_cast<double>(i.modes_.tool.value_or(0)); }},
      {"_current_pocket", [](const I& i) { return static_cast<double>(i.modes_.tool.value_or(0)); }},
      {"_selected_tool", [](const I& i) { return static_cast<double>(i.modes_.selected_tool.value_or(-1)); }},
      {"_selected_pocket",
       [](const I& i) { return static_cast<double>(i.modes_.selected_tool.value_or(-1)); }},
      {"_value", [](const I&) { return 0.0; }},
      {"_value_returned", [](const I&) { return 0.0; }},
      {"_call_level", [](const I& i) { return static_cast<double>(i.current_depth_); }},
      {"_remap_level", [](const I&) { return 0.0; }},
      {"_task", [](const I&) { return 0.0; }},
  };
  const auto found = kNames.find(name);
  if (found == kNames.end()) return std::nullopt;
  return found->second(*this);
}

}  // namespace kerf::gcode
