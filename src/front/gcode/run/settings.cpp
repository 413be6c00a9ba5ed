// Words that set a state: units, feed, speed, tool, spindle, coolant, plane and modes; pauses and the end.
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/gcode.h"
#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxRepeats = 9999;
constexpr double kMillisecondsPerSecond = 1000.0;
constexpr double kLongDwell = 60.0;  // seconds; starting a spindle or coolant takes less

}  // namespace

void Interpreter::set_feed_mode() {
  const Tenths code = line_.code(Group::feed_mode);
  const FeedMode mode = code == 930   ? FeedMode::inverse_time
                        : code == 950 ? FeedMode::per_turn
                                      : FeedMode::per_minute;
  feed_mode_repeated_ = mode == modes_.feed_mode && modes_.feed > 0.0 && !line_.has('F');
  if (mode == modes_.feed_mode) return;
  modes_.feed_mode = mode;
  modes_.feed = 0.0;  // the number of one mode has no meaning in another
  no_feed_reported_ = false;
}

void Interpreter::set_units() {
  const double scale = line_.code(Group::units) == 200 ? kMmPerInch : 1.0;
  if (scale != modes_.scale && line_.has('F'))
    reporter_.note(codes::feed_with_units, line_.column('F'),
                   "the feed is read in the units that its own line sets, as GRBL does; LinuxCNC uses the "
                   "previous ones");
  modes_.scale = scale;
  units_given_ = true;
  use_pending_comments();
}

void Interpreter::set_feed() {
  const double feed = *line_.take('F');
  feed_mode_repeated_ = false;
  if (feed < 0.0) {
    reporter_.error(codes::word_out_of_range, line_.column('F'), "a feed cannot be negative; skipped");
    return;
  }
  modes_.feed = modes_.feed_mode == FeedMode::inverse_time ? feed : feed * modes_.scale;
  modes_.feed_scale = modes_.scale;
}

void Interpreter::set_speed() {
  const double speed = *line_.take('S');
  if (speed < 0.0) {
    reporter_.error(codes::word_out_of_range, line_.column('S'),
                    "a spindle speed cannot be negative; skipped");
    return;
  }
  const bool changes = speed != modes_.speed && modes_.spindle != SpindleTurn::off;
  if (modes_.surface_speed > 0.0)
    modes_.surface_speed = speed;  // the rpm depend on the diameter of the work and are unknown
  else
    modes_.speed = speed;
  modes_.speed_given = true;
  if (program_.dialect == GcodeDialect::laser) return set_beam();
  if (changes && !line_.has(Group::spindle) && !line_.has(Group::tool_change)) set_spindle(modes_.spindle);
}

void Interpreter::select_tool() {
  const double number = *line_.take('T');
  if (!(number >= 0.0 && number <= std::numeric_limits<int>::max()) || number != std::floor(number)) {
    reporter_.error(codes::word_out_of_range, line_.column('T'), "a tool number is an integer from 0");
    return;
  }
  modes_.selected_tool = static_cast<int>(number);
}

void Interpreter::change_tool() {
  if (line_.code(Group::tool_change) == 610) {  // M61: sets the number of the tool in the spindle
    const std::optional<double> number = line_.take('Q');
    if (!number || *number < 0.0 || *number > std::numeric_limits<int>::max() ||
        *number != std::floor(*number)) {
      reporter_.error(codes::word_missing, line_.column(Group::tool_change), "M61 needs Q, a tool number");
      return;
    }
    modes_.tool = static_cast<int>(*number);
    add(step::ToolChange{*modes_.tool, ToolChangeKind::number_only});
    return;
  }
  if (!modes_.selected_tool)
    reporter_.unusual(codes::word_missing, line_.column(Group::tool_change),
                      "M6 before any T word; assuming tool 0");
  if (modes_.spindle != SpindleTurn::off) set_spindle(SpindleTurn::off);
  put_tool(modes_.selected_tool.value_or(0));
}

void Interpreter::put_tool(int number) {
  add(step::ToolChange{number});
  modes_.tool = number;
  change_at_pause_.reset();
  tool_comments_.tool_change(number, reporter_.diagnostics());
  use_pending_comments();
  changed_without_motion_ = !described_;
  if (described_) assign_description(number);
}

void Interpreter::switch_spindle() {
  const Tenths code = line_.code(Group::spindle);
  if (code != 50 && !modes_.speed_given && !spindle_without_speed_)
    spindle_without_speed_ = {code, reporter_.location(line_.column(Group::spindle))};
  if (code != 50 && modes_.surface_speed > 0.0) report_surface_speed(line_.column(Group::spindle));
  switch (code) {
    case 30: return set_spindle(SpindleTurn::cw);
    case 40: return set_spindle(SpindleTurn::ccw);
    default: return set_spindle(SpindleTurn::off);
  }
}

/// S0 stops the spindle. Without any S word the speed is unknown (set by hand), stored as 0, and the spindle
/// turns.
void Interpreter::set_spindle(SpindleTurn turn) {
  modes_.spindle = turn;
  if (program_.dialect == GcodeDialect::laser) return set_beam();
  const bool stopped = turn == SpindleTurn::off ||
                       (modes_.speed_given && !(modes_.speed > 0.0) && !(modes_.surface_speed > 0.0));
  add(step::Spindle{stopped ? rpm(0) : rpm(modes_.speed), stopped ? SpindleTurn::off : turn});
}

/// Laser: M3 is constant power, M4 power in proportion to the feed.
void Interpreter::set_beam() {
  const LaserMode mode = modes_.spindle == SpindleTurn::off  ? LaserMode::off
                         : modes_.spindle == SpindleTurn::cw ? LaserMode::constant
                                                             : LaserMode::dynamic;
  const double power = mode == LaserMode::off ? 0.0 : modes_.speed;
  if (mode == beam_mode_ && power == beam_power_) return;
  beam_mode_ = mode;
  beam_power_ = power;
  add(step::LaserPower{mode, power});
}

/// G96 holds the cutting speed of a lathe constant; the resulting rpm are not computed.
void Interpreter::set_spindle_mode() {
  const double limit = line_.take('D').value_or(0.0);
  const bool surface = line_.code(Group::spindle_mode) == 960;
  modes_.surface_speed = surface ? line_.value('S') : 0.0;
  if (surface && !line_.has('S'))
    reporter_.error(codes::word_missing, line_.column(Group::spindle_mode), "G96 needs S, the cutting speed");
  if (!surface) return;
  modes_.speed = limit;
  if (modes_.spindle != SpindleTurn::off) report_surface_speed(line_.column(Group::spindle_mode));
}

/// The spindle turns at a speed that follows the diameter of the work.
void Interpreter::report_surface_speed(std::uint32_t column) {
  reporter_.unusual(codes::value_unknown, column,
                    "G96 holds the cutting speed constant; the speed of the spindle is unknown",
                    "mills need G97 and S in rpm");
  add(step::Unresolved{"the speed of the spindle after G96"});
}

/// M98 P100 L2 calls subroutine 100 twice; so does Fanuc's M98 P20100.
void Interpreter::subroutine() {
  if (line_.code(Group::subroutine) == 650) return;  // macro_call()
  if (line_.code(Group::subroutine) == 990) {
    if (flow_->return_from_call() || program_.ended) return;
    reporter_.unusual(codes::o_word_unmatched, line_.column(Group::subroutine),
                      "M99 in the main program repeats it endlessly; read as its end");
    return end_program();
  }
  const double number = line_.take('P').value_or(-1.0);
  double repeats = line_.take('L').value_or(1.0);
  double label = number;
  if (!line_.has('L') && number > kMaxRepeats) {
    repeats = std::floor(number / (kMaxRepeats + 1.0));
    label = number - repeats * (kMaxRepeats + 1.0);
  }
  const bool whole = number == std::floor(number) && repeats == std::floor(repeats);
  if (!whole || number < 0.0 || number > 1e8 || repeats < 0.0 || repeats > kMaxRepeats) {
    reporter_.error(codes::word_out_of_range, line_.column(Group::subroutine),
                    "M98 needs P, a subroutine number, and a whole L up to 9999");
    return;
  }
  if (repeats >= 1.0)
    flow_->call_number(static_cast<int>(label), static_cast<int>(repeats), line_.column(Group::subroutine));
}

/// G65 P100 A1 B2: calls subroutine 100 with its letters as parameters, as on Fanuc's controls. A macro that
/// is not in the program belongs to the machine.
void Interpreter::macro_call() {
  constexpr std::string_view kLetters = "ABCIJKDEF#H#M###QRSTUVWXYZ";  // of #1, #2 ...; '#': none
  const double number = line_.take('P').value_or(-1.0);
  const bool whole = number == std::floor(number) && number >= 0.0 && number <= 1e8;
  const std::uint32_t column = line_.column(Group::subroutine);
  if (!whole || !flow_->has_sub(static_cast<int>(number))) {
    reporter_.unusual(codes::unknown_g_code, column,
                      fmt::format("G65 calls the macro {:g}, which is not in the program; skipped", number));
    return line_.leave_out("G65", column);
  }
  std::array<ParameterValue, Parameters::kArguments> arguments;
  for (std::size_t i = 0; i < kLetters.size(); ++i)
    if (kLetters[i] != '#')
      if (const auto value = line_.take(kLetters[i]))
        arguments[i] = {*value, (line_.unknown_letters() & LineWords::bit(kLetters[i])) != 0};
  flow_->call_macro(static_cast<int>(number), arguments, column);
}

void Interpreter::save_modes() {
  std::optional<SavedModes>& kept = saved_modes_.back();
  switch (line_.code(Group::saved_modes)) {
    case 700: kept = SavedModes{modes_, false}; return;
    case 710: kept.reset(); return;
    case 730: kept = SavedModes{modes_, true}; return;
    default: break;
  }
  if (kept) return restore_modes(kept->modes);
  reporter_.error(codes::word_missing, line_.column(Group::saved_modes),
                  "M72 restores the modes that M70 stores; none are stored here");
}

/// Motion, tool and position are not restored.
void Interpreter::restore_modes(const Modes& kept) {
  const Modes now = modes_;
  note_zeros();
  modes_ = kept;
  modes_.system = now.system;
  modes_.motion = now.motion;
  modes_.tool = now.tool;
  modes_.selected_tool = now.selected_tool;
  if (kept.spindle != now.spindle || kept.speed != now.speed) set_spindle(kept.spindle);
  if (kept.mist != now.mist || kept.flood != now.flood) add(step::Coolant{kept.mist, kept.flood});
  if (kept.system == now.system) return;
  zero_location_ = reporter_.location(line_.column());
  select_system(kept.system);
}

void Interpreter::read_large_m_code() {
  constexpr int kLastUserCode = 199;
  const int code = line_.large_m_code();
  const bool user_code = program_.dialect == GcodeDialect::rs274 && code <= kLastUserCode;
  reporter_.unusual(codes::unknown_m_code, line_.column(Group::other),
                    user_code
                        ? fmt::format("M{} runs a user-defined program, which is unknown; skipped", code)
                        : fmt::format("unknown code M{}; skipped", code),
                    user_code ? "" : "is this program for another kind of machine?");
  line_.use(kAllLetters & ~(kAxisLetters | kRotaryLetters));
}

void Interpreter::switch_coolant() {
  const bool any = line_.has(Group::mist) || line_.has(Group::flood) || line_.has(Group::no_coolant);
  if (!any) return;
  const bool off = line_.has(Group::no_coolant);
  modes_.mist = !off && (modes_.mist || line_.has(Group::mist));
  modes_.flood = !off && (modes_.flood || line_.has(Group::flood));
  add(step::Coolant{modes_.mist, modes_.flood});
}

/// M48 and M49 switch both overrides; M50 to M53 one of the switches, by P: off where it is 0.
void Interpreter::switch_overrides() {
  const int code = line_.code(Group::override_switch) / 10;
  const bool is_on = code <= 49 ? code == 48 : !line_.has('P') || line_.value('P') != 0.0;
  if (code <= 50) modes_.feed_override = is_on;
  if (code <= 49 || code == 51) modes_.speed_override = is_on;
  if (code == 52) modes_.adaptive_feed = is_on;
  if (code == 53) modes_.feed_hold = is_on;
}

void Interpreter::dwell() {
  const bool fanuc = program_.dialect == GcodeDialect::fanuc;
  char letter = 'P';
  if (is_printer() && line_.unused('S')) letter = 'S';  // seconds
  for (const char other : {'X', 'U'})
    if (fanuc && line_.unused(other)) letter = other;  // seconds
  const std::optional<double> time = line_.take(letter);
  if (!time) {
    if (is_printer()) return;  // waits for the motions before it
    reporter_.error(codes::word_missing, line_.column(Group::dwell), "G4 needs a time: P in seconds");
    return;
  }
  if (*time < 0.0) {
    reporter_.error(codes::word_out_of_range, line_.column(letter), "a time cannot be negative");
    return;
  }
  const double time_s = letter == 'P' ? seconds_of_p(*time) : *time;
  report_long_dwell(time_s, letter);
  add(step::Dwell{seconds(time_s)});
}

/// P of a dwell or cycle in seconds. Printers give milliseconds; so do Fanuc's and Haas' controls, unless the
/// number has a decimal point.
double Interpreter::seconds_of_p(double p) const {
  const bool fanuc = program_.dialect == GcodeDialect::fanuc && line_.is_integer_text('P');
  return is_printer() || fanuc ? p / kMillisecondsPerSecond : p;
}

/// P is in seconds or milliseconds, depending on the controller; a dwell of minutes suggests the wrong unit.
void Interpreter::report_long_dwell(double time, char letter) {
  if (time <= kLongDwell || long_dwell_reported_) return;
  long_dwell_reported_ = true;
  const bool milliseconds = letter == 'P' && seconds_of_p(1.0) != 1.0;
  reporter_.unusual(
      codes::dwell_long, line_.column(letter),
      fmt::format("a dwell of {:.3g} minutes: {} is read in {}, as {} does", time / 60.0, letter,
                  milliseconds ? "milliseconds" : "seconds", to_string(program_.dialect)),
      milliseconds ? "" : "if P is in milliseconds, divide it by 1000");
}

void Interpreter::set_plane() {
  const Tenths code = line_.code(Group::plane);
  const Plane plane = code == 180 ? Plane::xz : code == 190 ? Plane::yz : Plane::xy;
  if (plane != modes_.plane && compensation_.cutter)
    refuse_compensated(code_text('G', code), line_.column(Group::plane));
  modes_.plane = plane;
}

void Interpreter::set_path_mode() {
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

void Interpreter::set_distance() {
  if (line_.has(Group::distance)) modes_.absolute = line_.code(Group::distance) == 900;
  if (line_.has(Group::arc_distance)) modes_.absolute_centres = line_.code(Group::arc_distance) == 901;
  if (line_.has(Group::retract)) modes_.retract_to_start = line_.code(Group::retract) == 980;
}

/// Words of skipped codes are not reported as unused.
void Interpreter::use_words_of_other_codes() {
  using L = LineWords;
  if (line_.has(Group::tool_length)) line_.use(L::bit('H'));
  if (line_.has(Group::other) || line_.has(Group::tool_change))
    line_.use(L::bit('P') | L::bit('Q') | L::bit('R') | L::bit('L') | L::bit('E'));
  if (line_.has(Group::override_switch)) line_.use(L::bit('P'));
  if (line_.has(Group::spindle_mode)) line_.use(L::bit('D'));
}

/// G43, G43.1, G43.2, G49. The toolpath is that of the tip, but after a change of the length compensation the
/// present height of the tip in work coordinates is unknown, and so are those of the homes.
void Interpreter::set_tool_length() {
  const Tenths code = line_.code(Group::tool_length);
  step::ToolLength length;
  if (code == 431) {
    length.kind = ToolLengthKind::given;
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
      if (!word) continue;
      length.offset[axis] = *word * modes_.scale;
      length.axes |= 1u << axis;
    }
    line_.use(kRotaryLetters);
  } else if (code != 490) {
    length.kind = ToolLengthKind::table;
    const std::optional<double> number = line_.take('H');
    const bool valid = number && *number == std::floor(*number) && *number >= 0.0 && *number <= 1e6;
    if (number && !valid)
      reporter_.error(codes::word_out_of_range, line_.column('H'), "H is a whole number from 0");
    if (valid) length.number = static_cast<int>(*number);
    if (valid && modes_.tool && length.number != *modes_.tool)
      reporter_.unusual(codes::tool_length_other, line_.column('H'),
                        fmt::format("H{} is the length of another tool than T{}, which is in the spindle",
                                    length.number, *modes_.tool),
                        fmt::format("should it be H{}?", *modes_.tool));
    if (code == 432) report_unresolved("a sum of tool lengths (G43.2)", line_.column(Group::tool_length));
  }
  const auto same = [&](const step::ToolLength& old) {
    return old.kind == length.kind && old.number == length.number && old.offset == length.offset &&
           old.axes == length.axes && (length.kind != ToolLengthKind::table || length_tool_ == modes_.tool);
  };
  if (tool_length_ && same(*tool_length_)) return;
  tool_length_ = length;
  length_tool_ = modes_.tool;
  constexpr unsigned kZ = 4;
  if (add(length)) lose(kZ);
}

void Interpreter::end_or_pause() {
  const Tenths code = line_.code(Group::stop);
  if (code == 20 || code == 300) {
    end_program();
    add(step::End{code == 300});
  } else if (change_at_pause_ && code == 0) {
    change_tool_at_pause();
  } else {
    add(step::Pause{code == 0    ? PauseKind::always
                    : code == 10 ? PauseKind::optional
                                 : PauseKind::pallet_change});
  }
}

/// The pause after a comment "change to tool 2" of Kerf's posts is that change.
void Interpreter::change_tool_at_pause() {
  if (modes_.spindle != SpindleTurn::off) set_spindle(SpindleTurn::off);
  put_tool(*change_at_pause_);
}

/// M2 and M30 reset the modes (LinuxCNC's page "M2, M30"; GRBL does the same), but not units, position and
/// tool.
void Interpreter::end_program() {
  note_program_end();
  if (modes_.spindle != SpindleTurn::off) set_spindle(SpindleTurn::off);
  if (modes_.mist || modes_.flood) {
    modes_.mist = modes_.flood = false;
    add(step::Coolant{});
  }
  end_compensation();
  compensation_.leaving = false;
  modes_.motion = 10;
  note_zeros();
  if (after_end_ == AfterEnd::read_on && offsets_.selected > 1) {
    zero_location_ = reporter_.location(line_.column());
    select_system(1);
  }
  modes_.system = 1;
  load_offsets();
  modes_.plane = Plane::xy;
  modes_.absolute = true;
  if (modes_.feed_mode != FeedMode::per_minute) modes_.feed = 0.0;
  modes_.feed_mode = FeedMode::per_minute;
  cycle_ = {};
}

}  // namespace kerf::gcode
