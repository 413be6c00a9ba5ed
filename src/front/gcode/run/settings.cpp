// What words set: units, feed, speed, tool, spindle, coolant, planes and modes, and the program's stops.
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

constexpr double kMostRepeats = 9999;
constexpr double kMillisecondsPerSecond = 1000.0;
constexpr double kLongDwell = 60.0;  // seconds; spindles and coolant take less

}  // namespace

void Interpreter::set_feed_mode() {
  const Tenths code = line_.code(Group::feed_mode);
  const FeedMode mode = code == 930   ? FeedMode::inverse_time
                        : code == 950 ? FeedMode::per_turn
                                      : FeedMode::per_minute;
  if (mode == modes_.feed_mode) return;
  modes_.feed_mode = mode;
  modes_.feed = 0.0;  // a feed of one mode means nothing in another
  no_feed_said_ = false;
}

void Interpreter::set_units() {
  const double scale = line_.code(Group::units) == 200 ? kMmPerInch : 1.0;
  if (scale != modes_.scale && line_.has('F'))
    talker_.note(
        Code::feed_with_units, line_.column('F'),
        "the feed is taken in the units that its own line sets, as GRBL does; LinuxCNC takes the old ones");
  modes_.scale = scale;
  units_told_ = true;
  use_waiting_remarks();
}

void Interpreter::set_feed() {
  const double feed = *line_.take('F');
  if (feed < 0.0) {
    talker_.error(Code::word_out_of_range, line_.column('F'), "a feed cannot be negative; it is left out");
    return;
  }
  modes_.feed = modes_.feed_mode == FeedMode::inverse_time ? feed : feed * modes_.scale;
}

void Interpreter::set_speed() {
  const double speed = *line_.take('S');
  if (speed < 0.0) {
    talker_.error(Code::word_out_of_range, line_.column('S'),
                  "a spindle speed cannot be negative; it is left out");
    return;
  }
  const bool is_news = speed != modes_.speed && modes_.spindle != SpindleTurn::off;
  if (modes_.surface_speed > 0.0)
    modes_.surface_speed = speed;  // the spindle's own follows the work, which nobody knows
  else
    modes_.speed = speed;
  modes_.speed_told = true;
  if (program_.dialect == GcodeDialect::laser) return beam();
  if (is_news && !line_.has(Group::spindle) && !line_.has(Group::tool_change)) spin(modes_.spindle);
}

void Interpreter::select_tool() {
  const double number = *line_.take('T');
  if (!(number >= 0.0 && number <= std::numeric_limits<int>::max()) || number != std::floor(number)) {
    talker_.error(Code::word_out_of_range, line_.column('T'), "a tool's number is a whole number from 0");
    return;
  }
  modes_.selected_tool = static_cast<int>(number);
}

void Interpreter::change_tool() {
  if (line_.code(Group::tool_change) == 610) {  // M61: the tool that is in the spindle gets a number
    const std::optional<double> told = line_.take('Q');
    if (!told || *told < 0.0 || *told > std::numeric_limits<int>::max() || *told != std::floor(*told)) {
      talker_.error(Code::word_missing, line_.column(Group::tool_change), "M61 needs Q and a tool's number");
      return;
    }
    modes_.tool = static_cast<int>(*told);
    add(step::ToolChange{*modes_.tool});
    return;
  }
  if (!modes_.selected_tool)
    talker_.unusual(Code::word_missing, line_.column(Group::tool_change),
                    "M6 without a T word before; read as tool 0");
  if (modes_.spindle != SpindleTurn::off) spin(SpindleTurn::off);
  const int number = modes_.selected_tool.value_or(0);
  add(step::ToolChange{number});
  modes_.tool = number;
  tool_comments_.tool_change(number, talker_.diagnostics());
}

void Interpreter::turn_spindle() {
  const Tenths code = line_.code(Group::spindle);
  if (code != 50 && !modes_.speed_told && !silent_spindle_)
    silent_spindle_ = {code, talker_.spot(line_.column(Group::spindle))};
  switch (code) {
    case 30: return spin(SpindleTurn::cw);
    case 40: return spin(SpindleTurn::ccw);
    default: return spin(SpindleTurn::off);
  }
}

/// A spindle that turns at a speed of 0 stands still, where the program says so; 0 of no S word at all is
/// a speed that is set by hand.
void Interpreter::spin(SpindleTurn turn) {
  modes_.spindle = turn;
  if (program_.dialect == GcodeDialect::laser) return beam();
  const bool stands = turn == SpindleTurn::off ||
                      (modes_.speed_told && !(modes_.speed > 0.0) && !(modes_.surface_speed > 0.0));
  add(step::Spindle{stands ? rpm(0) : rpm(modes_.speed), stands ? SpindleTurn::off : turn});
}

/// What a laser's beam does: M3 holds its power, M4 lets it follow the feed.
void Interpreter::beam() {
  const LaserMode mode = modes_.spindle == SpindleTurn::off  ? LaserMode::off
                         : modes_.spindle == SpindleTurn::cw ? LaserMode::constant
                                                             : LaserMode::dynamic;
  const double power = mode == LaserMode::off ? 0.0 : modes_.speed;
  if (mode == beam_mode_ && power == beam_power_) return;
  beam_mode_ = mode;
  beam_power_ = power;
  add(step::LaserPower{mode, power});
}

/// G96 keeps the cutting speed of a lathe; which speed of the spindle that makes is not followed.
void Interpreter::set_spindle_mode() {
  const double limit = line_.take('D').value_or(0.0);
  const bool surface = line_.code(Group::spindle_mode) == 960;
  modes_.surface_speed = surface ? line_.value('S') : 0.0;
  if (surface && !line_.has('S'))
    talker_.error(Code::word_missing, line_.column(Group::spindle_mode), "G96 needs S, the cutting speed");
  if (surface) modes_.speed = limit;
}

/// M98 P100 L2 calls subroutine 100 twice; Fanuc's M98 P20100 does the same.
void Interpreter::subroutine() {
  if (line_.code(Group::subroutine) == 990) {
    if (flow_->return_from_call() || program_.ended) return;
    talker_.unusual(Code::o_word_unmatched, line_.column(Group::subroutine),
                    "M99 in the main program begins it anew without end; read as its end");
    return end_program();
  }
  const double number = line_.take('P').value_or(-1.0);
  double repeats = line_.take('L').value_or(1.0);
  double label = number;
  if (!line_.has('L') && number > kMostRepeats) {
    repeats = std::floor(number / (kMostRepeats + 1.0));
    label = number - repeats * (kMostRepeats + 1.0);
  }
  const bool whole = number == std::floor(number) && repeats == std::floor(repeats);
  if (!whole || number < 0.0 || number > 1e8 || repeats < 0.0 || repeats > kMostRepeats) {
    talker_.error(Code::word_out_of_range, line_.column(Group::subroutine),
                  "M98 needs P, a subroutine's number, and a whole L up to 9999");
    return;
  }
  if (repeats >= 1.0)
    flow_->call_number(static_cast<int>(label), static_cast<int>(repeats), line_.column(Group::subroutine));
}

void Interpreter::keep_modes() {
  std::optional<KeptModes>& kept = kept_modes_.back();
  switch (line_.code(Group::saved_modes)) {
    case 700: kept = KeptModes{modes_, false}; return;
    case 710: kept.reset(); return;
    case 730: kept = KeptModes{modes_, true}; return;
    default: break;
  }
  if (kept) return restore_modes(kept->modes);
  talker_.error(Code::word_missing, line_.column(Group::saved_modes),
                "M72 puts back what M70 has kept, and nothing is kept here");
}

/// Motion, tool and position stay as they are.
void Interpreter::restore_modes(const Modes& kept) {
  const Modes now = modes_;
  leave_system();
  modes_ = kept;
  modes_.motion = now.motion;
  modes_.tool = now.tool;
  modes_.selected_tool = now.selected_tool;
  if (kept.spindle != now.spindle || kept.speed != now.speed) spin(kept.spindle);
  if (kept.mist != now.mist || kept.flood != now.flood) add(step::Coolant{kept.mist, kept.flood});
  if (kept.system != now.system) refresh_placement();
}

void Interpreter::read_large_m_code() {
  constexpr int kLastOfUsers = 199;
  const int code = line_.large_m_code();
  const bool users = program_.dialect == GcodeDialect::rs274 && code <= kLastOfUsers;
  talker_.unusual(
      Code::unknown_m_code, line_.column(Group::other),
      users ? fmt::format("M{} runs a program of the user's own, which is not known; it is left out", code)
            : fmt::format("unknown code M{}; it is left out", code),
      users ? "" : "is this a program for another kind of machine?");
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

void Interpreter::dwell() {
  const std::optional<double> time = line_.take('P');
  if (!time) {
    talker_.error(Code::word_missing, line_.column(Group::dwell), "G4 needs its time: P and seconds");
    return;
  }
  if (*time < 0.0) {
    talker_.error(Code::word_out_of_range, line_.column('P'), "a time cannot be negative");
    return;
  }
  const double time_s = is_printer() ? *time / kMillisecondsPerSecond : *time;
  tell_long_dwell(time_s, 'P');
  add(step::Dwell{seconds(time_s)});
}

/// P is in seconds or in milliseconds, as the controller has it; what takes minutes may be meant otherwise.
void Interpreter::tell_long_dwell(double time, char letter) {
  if (time <= kLongDwell || long_dwell_said_) return;
  long_dwell_said_ = true;
  const std::string_view unit = is_printer() ? "milliseconds" : "seconds";
  talker_.unusual(Code::dwell_long, line_.column(letter),
                  fmt::format("a wait of {:.3g} minutes: P is read in {}, as {} has it", time / 60.0, unit,
                              to_string(program_.dialect)),
                  is_printer() ? "" : "if it is meant in milliseconds, divide it by 1000");
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
      talker_.error(Code::word_out_of_range, line_.column('P'), "a tolerance cannot be negative");
    if (tolerance > 0.0) mode.tolerance = mm(tolerance * modes_.scale);
    line_.use(
        Line::bit('Q'));  // how far straight pieces are joined: nothing for a path that is kept as it is
  }
  add(mode);
}

void Interpreter::set_distance() {
  if (line_.has(Group::distance)) modes_.absolute = line_.code(Group::distance) == 900;
  if (line_.has(Group::arc_distance)) modes_.absolute_centres = line_.code(Group::arc_distance) == 901;
  if (line_.has(Group::retract)) modes_.retract_to_start = line_.code(Group::retract) == 980;
}

/// Words of codes that are left out are not left over.
void Interpreter::use_words_of_other_codes() {
  using L = Line;
  if (line_.has(Group::tool_length)) line_.use(L::bit('H'));
  if (line_.has(Group::tool_length) && line_.code(Group::tool_length) == 431)
    line_.use(kAxisLetters | kRotaryLetters);
  if (line_.has(Group::other) || line_.has(Group::tool_change))
    line_.use(L::bit('P') | L::bit('Q') | L::bit('R') | L::bit('L') | L::bit('E'));
  if (line_.has(Group::spindle_mode)) line_.use(L::bit('D'));
}

void Interpreter::end_or_pause() {
  const Tenths code = line_.code(Group::stop);
  if (code == 20 || code == 300) {
    end_program();
    add(step::End{code == 300});
  } else {
    add(step::Pause{code == 0    ? PauseKind::always
                    : code == 10 ? PauseKind::optional
                                 : PauseKind::pallet_change});
  }
}

/// M2 and M30 set the modes back (LinuxCNC's page "M2, M30"; GRBL does the same). Units, position and tool
/// stay.
void Interpreter::end_program() {
  program_.ended = true;
  if (modes_.spindle != SpindleTurn::off) spin(SpindleTurn::off);
  if (modes_.mist || modes_.flood) {
    modes_.mist = modes_.flood = false;
    add(step::Coolant{});
  }
  end_compensation();
  compensation_.leaving = false;
  modes_.motion = 10;
  leave_system();
  modes_.system = 1;
  refresh_placement();
  modes_.plane = Plane::xy;
  modes_.absolute = true;
  if (modes_.feed_mode != FeedMode::per_minute) modes_.feed = 0.0;
  modes_.feed_mode = FeedMode::per_minute;
  cycle_ = {};
}

}  // namespace kerf::gcode
