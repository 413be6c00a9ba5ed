// Words that set a mode: units, coolant, overrides, plane, path control, distances.
#include "front/gcode/run/settings.h"

#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {

void Settings::set_units() {
  const double scale = line_.code(Group::units) == 200 ? kMmPerInch : 1.0;
  if (scale != modes_.scale && line_.has('F'))
    reporter_.note(codes::feed_with_units, line_.column('F'),
                   "the feed is read in the units that its own line sets, as GRBL does; LinuxCNC uses the "
                   "previous ones");
  modes_.scale = scale;
  comments_.note_units();
}

void Settings::switch_coolant() {
  const bool any = line_.has(Group::mist) || line_.has(Group::flood) || line_.has(Group::no_coolant);
  if (!any) return;
  const bool off = line_.has(Group::no_coolant);
  modes_.mist = !off && (modes_.mist || line_.has(Group::mist));
  modes_.flood = !off && (modes_.flood || line_.has(Group::flood));
  add(step::Coolant{modes_.mist, modes_.flood});
}

/// M48 and M49 switch both overrides; M50 to M53 one of the switches, by P: off where it is 0.
void Settings::switch_overrides() {
  const int code = line_.code(Group::override_switch) / 10;
  const bool is_on = code <= 49 ? code == 48 : !line_.has('P') || line_.value('P') != 0.0;
  if (code <= 50) modes_.feed_override = is_on;
  if (code <= 49 || code == 51) modes_.speed_override = is_on;
  if (code == 52) modes_.adaptive_feed = is_on;
  if (code == 53) modes_.feed_hold = is_on;
}

void Settings::set_plane() {
  const Tenths code = line_.code(Group::plane);
  const Plane plane = code == 180 ? Plane::xz : code == 190 ? Plane::yz : Plane::xy;
  if (plane != modes_.plane && compensation_.is_on())
    compensation_.refuse(code_text('G', code), line_.column(Group::plane));
  modes_.plane = plane;
}

/// The centre is the work zero, on Mach3 the position.
void Settings::set_polar_mode() {
  modes_.polar_centre.reset();
  if (line_.code(Group::polar) == 150) return;
  modes_.polar_centre.emplace();
  if (program_.dialect != GcodeDialect::mach3) return;
  constexpr unsigned kPlaneAxes = 3;
  if ((position_.unknown & kPlaneAxes) != 0)
    report_unresolved("the centre of G16", line_.column(Group::polar));
  modes_.polar_centre = coordinates_.frame().to_program(position_.at).xy();
}

void Settings::set_path_mode() {
  step::PathMode mode;
  const Tenths code = line_.code(Group::path_control);
  if (code == 611) mode.kind = PathModeKind::exact_stop;
  if (code == 640) {
    mode.kind = PathModeKind::blend;
    const double tolerance = line_.take('P').value_or(0.0);
    if (tolerance < 0.0)
      reporter_.error(codes::word_out_of_range, line_.column('P'), "a tolerance cannot be negative");
    if (tolerance > 0.0) mode.tolerance = mm(tolerance * modes_.scale);
    line_.use(LineWords::bit('Q'));  // tolerance for joining collinear lines; not used
  }
  add(mode);
}

void Settings::set_distance() {
  if (line_.has(Group::distance)) modes_.absolute = line_.code(Group::distance) == 900;
  if (line_.has(Group::arc_distance)) {
    modes_.absolute_centres = line_.code(Group::arc_distance) == 901;
    modes_.centres_stated = true;
  }
  if (line_.has(Group::lathe)) modes_.diameters = line_.code(Group::lathe) == 70;
  if (line_.has(Group::retract)) modes_.retract_to_start = line_.code(Group::retract) == 980;
}

/// Words of skipped codes are not reported as unused.
void Settings::use_words_of_other_codes() {
  using L = LineWords;
  if (line_.has(Group::tool_length)) line_.use(L::bit('H'));
  if (line_.has(Group::other) || line_.has(Group::tool_change))
    line_.use(L::bit('P') | L::bit('Q') | L::bit('R') | L::bit('L') | L::bit('E'));
  if (line_.has(Group::override_switch)) line_.use(L::bit('P'));
  if (line_.has(Group::spindle_mode)) line_.use(L::bit('D'));
}

void Settings::read_large_m_code() {
  constexpr int kLastUserCode = 199;
  const int code = line_.large_m_code();
  const bool user_code = program_.dialect == GcodeDialect::rs274 && code <= kLastUserCode;
  reporter_.unusual(codes::unknown_m_code, line_.column(Group::other),
                    user_code
                        ? fmt::format("M{} runs a user-defined program, which is unknown; skipped", code)
                        : fmt::format("unknown code M{}; skipped", code),
                    user_code ? "" : "is this program for another kind of machine?");
  line_.leave_out_m_code(fmt::format("M{}", code));
  line_.use(kAllLetters & ~(kAxisLetters | kRotaryLetters));
}

/// A line for GRBL itself, such as "$110=5000". "$H" homes and "$J=" jogs: the position is unknown after
/// them.
void Settings::skip_setting(const Block& block) {
  reporter_.note(codes::sender_line, 0, "a command for the controller; skipped");
  const std::string_view start = block.command.substr(0, 2);
  if (start != "$H" && start != "$J" && start != "$h" && start != "$j") return;
  add(step::Unresolved{std::string(start), UnresolvedKind::code});
  coordinates_.lose(kAllAxes);
}

void Settings::stop_coolant() {
  if (!modes_.mist && !modes_.flood) return;
  modes_.mist = modes_.flood = false;
  add(step::Coolant{});
}

}  // namespace kerf::gcode
