// Steps other than motions: spindle, laser, coolant, dwell, tool changes, verbatim lines.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "back/gcode/lint.h"
#include "back/gcode/poster.h"
#include "base/codes/gcode.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {
namespace {

std::int64_t counts_of(double value, int decimals) { return std::llround(value * std::pow(10.0, decimals)); }

}  // namespace

void Poster::m_line(std::size_t i, int tenths) {
  start_line();
  code('M', tenths);
  end_line(i);
}

/// True if the controller has the M code; else an error about `what`.
bool Poster::can_m(std::size_t i, int tenths, std::string_view what) {
  if (profile_.has_m(tenths)) return true;
  report_unsupported(i, fmt::format("the controller has no M{}, which {} needs", tenths / 10, what));
  return false;
}

void Poster::spindle(std::size_t i) {
  wanted_spindle_ = path_[i].spindle();
  if (wanted_spindle_.turn == SpindleTurn::off) return stop_spindle();
  start_spindle(i);
}

void Poster::stop_spindle() {
  if (spindle_.turn == SpindleTurn::off && laser_ == LaserMode::off && moved_) return;
  spindle_ = {};
  laser_ = LaserMode::off;
  pending_power_.reset();
  if (profile_.has_m(50)) m_line(path_.size(), 50);
}

void Poster::start_spindle(std::size_t i) {
  const int tenths = wanted_spindle_.turn == SpindleTurn::cw ? 30 : 40;
  if (!can_m(i, tenths, "starting the spindle")) return;
  const bool starts = spindle_.turn == SpindleTurn::off;
  start_line();
  code('M', tenths);
  if (wanted_spindle_.speed > SpindleSpeed{})  // else it is set by hand, or in force in the controller
    word('S', counts_of(wanted_spindle_.speed.rpm(), profile_.decimals_speed), profile_.decimals_speed);
  end_line(i);
  spindle_ = wanted_spindle_;
  const bool waits = i + 1 < path_.size() && path_[i + 1].kind() == StepKind::dwell;
  if (starts && !waits && profile_.spindle_dwell > Duration{}) dwell(i, profile_.spindle_dwell);
}

void Poster::laser(std::size_t i) {
  const step::LaserPower wanted = path_[i].laser_power();
  if (wanted.mode == LaserMode::off) return stop_spindle();
  if (wanted.mode == laser_) {  // a changed power does not stop the motion
    pending_power_ = wanted.power;
    return;
  }
  const int tenths = wanted.mode == LaserMode::constant ? 30 : 40;
  if (!can_m(i, tenths, "a laser")) return;
  laser_ = wanted.mode;
  pending_power_.reset();  // written with the mode
  start_line();
  code('M', tenths);
  word('S', counts_of(wanted.power, profile_.decimals_speed), profile_.decimals_speed);
  end_line(i);
}

void Poster::coolant(std::size_t i, const step::Coolant& wanted) {
  const bool less = (coolant_.mist && !wanted.mist) || (coolant_.flood && !wanted.flood);
  if ((less || (!wanted.mist && !wanted.flood && !moved_)) && profile_.has_m(90)) {
    m_line(i, 90);
    coolant_ = {};
  }
  if (wanted.mist && !coolant_.mist) {
    coolant_.mist = true;
    if (profile_.has_m(70))
      m_line(i, 70);
    else
      report_skipped(i, "the controller has no M7; mist");
  }
  if (wanted.flood && !coolant_.flood) {
    coolant_.flood = true;
    if (profile_.has_m(80))
      m_line(i, 80);
    else
      report_skipped(i, "the controller has no M8; flood");
  }
}

void Poster::dwell(std::size_t i, Duration time) {
  constexpr int kDecimals = 3;
  const bool seconds = profile_.dwell_unit == DwellUnit::seconds;
  start_line();
  code('G', 40);
  word('P', counts_of(seconds ? time.seconds() : 1000.0 * time.seconds(), seconds ? kDecimals : 0),
       seconds ? kDecimals : 0);
  end_line(i);
}

void Poster::path_mode(std::size_t i, const step::PathMode& mode) {
  const int tenths = mode.kind == PathModeKind::blend        ? 640
                     : mode.kind == PathModeKind::exact_stop ? 611
                                                             : 610;
  if (!profile_.has_g(tenths)) {
    if (mode.kind != PathModeKind::exact_path) report_skipped(i, "the controller has no such path mode; it");
    return;
  }
  start_line();
  code('G', tenths);
  if (mode.kind == PathModeKind::blend && mode.tolerance > Length{} && profile_.has_letter('P'))
    word('P', grid_.count(mode.tolerance.mm()), decimals_);
  end_line(i);
}

/// Restarts what a tool change has stopped, before the next motion.
void Poster::restore(std::size_t i) {
  restore_ = false;
  if (wanted_spindle_.turn != spindle_.turn || wanted_spindle_.speed != spindle_.speed) {
    if (wanted_spindle_.turn == SpindleTurn::off)
      stop_spindle();
    else
      start_spindle(i);
  }
  if (wanted_coolant_.mist != coolant_.mist || wanted_coolant_.flood != coolant_.flood)
    coolant(i, wanted_coolant_);
}

void Poster::tool_change(std::size_t i) {
  const bool only_number = path_[i].tool_change().kind == ToolChangeKind::number_only;
  if (tool_policy_ == ToolChangePolicy::files && !only_number) return change_file(i);
  const int number = path_[i].tool_change().tool;
  if (only_number) return set_tool_number(i);
  const bool first = !tool_.has_value();
  const bool same = tool_ == number;
  tool_ = number;
  if (tool_policy_ == ToolChangePolicy::ignore) return;
  if (same && tool_policy_ != ToolChangePolicy::command) return;
  if (spindle_.turn != SpindleTurn::off) stop_spindle();
  restore_ = true;
  if (tool_policy_ == ToolChangePolicy::command) {
    if (number > profile_.highest_tool)
      report_unsupported(i, fmt::format("the maximum tool number of the controller is {}; this one is {}",
                                        profile_.highest_tool, number));
    templates(profile_.change_lines);
    if (options_.tool_lengths == ToolLengths::by_post) templates(profile_.length_lines);
  } else if (!first || moved_) {
    templates(profile_.pause_lines);
  }
  templates(profile_.section);
}

/// The tool is in the spindle already: only a controller with a tool changer needs it (M61).
void Poster::set_tool_number(std::size_t i) {
  constexpr int kSetTool = 610;
  tool_ = path_[i].tool_change().tool;
  if (tool_policy_ != ToolChangePolicy::command) return;
  if (!profile_.has_m(kSetTool))
    return report_skipped(i, fmt::format("the controller has no M61; setting the tool number {}", *tool_));
  start_line();
  code('M', kSetTool);
  word('Q', *tool_, 0);
  end_line(i);
}

/// A pause; by the profile's pause lines if the controller has no such M code.
void Poster::pause(std::size_t i) {
  paused_axes_ = kAllAxes;
  const PauseKind kind = path_[i].pause().kind;
  const int m = kind == PauseKind::always ? 0 : kind == PauseKind::optional ? 10 : 600;
  if (profile_.has_m(m)) return m_line(i, m);
  if (kind == PauseKind::optional) return report_skipped(i, "the controller has no M1; the optional pause");
  std::vector<std::string> lines = profile_.pause_lines;
  lines.erase(std::remove_if(lines.begin(), lines.end(), is_comment), lines.end());
  if (lines.empty()) return report_unsupported(i, "the controller has no way to pause");
  templates(lines);
}

/// A file ends at the change to another tool. Changes before its first motion only select its tool, which
/// open_file() has found already.
void Poster::change_file(std::size_t i) {
  if (!moved_ || file_tool_ == path_[i].tool_change().tool) return;
  const auto last_motion = path_.motion_before(path_.size());
  if (!last_motion || *last_motion < i) return;  // T0 M6 at the end puts the last tool away
  if (files_.size() + 1 == limits::kMaxPostedFiles)
    report_unsupported(i, fmt::format("there are more than {} tool changes, each of which starts a file",
                                      limits::kMaxPostedFiles));
  if (files_.size() + 1 >= limits::kMaxPostedFiles) return;
  close_file();
  open_file(i);
  restore_modes(i);
  restore_ = true;
}

/// What the files before have set and this one does not set itself: each file is a program of its own.
void Poster::restore_modes(std::size_t i) {
  states_.to(i);
  const PathState& state = states_.state();
  const StateParts own = set_before_cut(path_, i, file_end_);
  const auto has = [&](StatePart part) { return (own & bit_of(part)) == 0; };
  if (state.path_mode && has(StatePart::path_mode)) path_mode(i, *state.path_mode);
  if (state.length && has(StatePart::tool_length)) tool_length(i, *state.length);
}

/// Whether a motion after step `i` leads to the home before another position is stored there.
bool Poster::is_visited_after(std::size_t i, Reference home) const {
  for (++i; i < path_.size(); ++i) {
    if (path_[i].is_motion() && path_[i].reference() == home) return true;
    if (path_[i].kind() == StepKind::store_home && path_[i].store_home().home == home) return false;
  }
  return false;
}

void Poster::store_home(std::size_t i) {
  const Reference home = path_[i].store_home().home;
  const int tenths = home == Reference::home ? 281 : 301;
  if (tenths == profile_.homing && is_visited_after(i, home))
    return report_unsupported(i,
                              fmt::format("G{}.1 runs the axes to their switches on this controller, which "
                                          "cannot store the position to which G{} returns later",
                                          tenths / 10, tenths / 10));
  if (!profile_.has_g(tenths) || tenths == profile_.homing)
    return report_skipped(
        i, fmt::format("the controller has no G{}.1 that stores the position; storing it", tenths / 10));
  start_line();
  code('G', tenths);
  end_line(i);
}

void Poster::select_system(std::size_t i) {
  start_line();
  code('G', work_offset_code(system_));
  end_line(i);
}

/// Whether the controller has the code for a zero; otherwise reports what that means.
bool Poster::can_set_zero(std::size_t i, const step::WorkZero& zero) {
  constexpr int kFirst[] = {0, 100, 100, 920, 921, 922, 923};
  const int system_code = work_offset_code(zero.system);
  const bool selects = zero.kind == ZeroKind::select;
  const int code = selects ? system_code : kFirst[static_cast<std::size_t>(zero.kind)];
  const bool letters = code != 100 || (profile_.has_letter('L') && profile_.has_letter('P'));
  if (profile_.has_g(code) && letters) return true;
  const std::string name =
      code % 10 == 0 ? fmt::format("G{}", code / 10) : fmt::format("G{}.{}", code / 10, code % 10);
  const bool first = selects && !system_selected_ && !moved_;
  if (first && zero.system == 1) return false;
  if (first)
    report_skipped(i,
                   fmt::format("the controller has no {}; its selection, and so another work zero,", name));
  else if (zero.unknown != 0 || zero.known != 0 || zero.kind == ZeroKind::offset)
    report_unsupported(i,
                       fmt::format("the controller has no {}, on which the positions after it depend", name));
  return false;  // positions stay in the coordinates so far
}

/// The selection of a work offset, or what sets one: the same words for the controller as in the program.
void Poster::work_zero(std::size_t i) {
  const step::WorkZero zero = path_[i].work_zero();
  const bool can = can_set_zero(i, zero);
  position_.pass(path_[i]);
  if (can && zero.kind == ZeroKind::select) {
    system_ = zero.system;
    system_selected_ = true;
    select_system(i);
    zero_ = zero.zero;
  } else if (can) {
    start_line();
    switch (zero.kind) {
      case ZeroKind::select: break;
      case ZeroKind::offset:
      case ZeroKind::here:
        code('G', 100);
        word('L', zero.kind == ZeroKind::offset ? 2 : 20, 0);
        word('P', zero.system, 0);
        break;
      case ZeroKind::shift: code('G', 920); break;
      case ZeroKind::shift_off: code('G', 921); break;
      case ZeroKind::shift_paused: code('G', 922); break;
      case ZeroKind::shift_on: code('G', 923); break;
    }
    const bool by_position = zero.kind == ZeroKind::here || zero.kind == ZeroKind::shift;
    put_axes(grid_.counts(by_position ? zero.at - zero.zero : zero.zero), zero.axes);
    end_line(i);
    if (zero.system == system_) zero_ = zero.zero;
  }
  at_ = grid_counts(position_.at);
  known_axes_ = 0;
  motion_ = -1;
}

void Poster::tool_length(std::size_t i, const step::ToolLength& length) {
  known_axes_ &= ~4u;
  const int tenths = length.kind == ToolLengthKind::none    ? 490
                     : length.kind == ToolLengthKind::table ? 430
                                                            : 431;
  if (!profile_.has_g(tenths)) {
    if (length.kind == ToolLengthKind::table)
      report_skipped(i,
                     "the controller has no tool lengths (G43): set the work zero in Z for each tool; G43");
    if (length.kind == ToolLengthKind::given)
      report_unsupported(i, "the controller has no G43.1, which states the length of the tool");
    return;
  }
  start_line();
  code('G', tenths);
  if (length.kind == ToolLengthKind::table && length.number >= 0) word('H', length.number, 0);
  if (length.kind == ToolLengthKind::given) put_axes(grid_.counts(length.offset), length.axes);
  end_line(i);
}

/// A code that the reader has left out and reported. It may have moved the tool, or changed the tool or the
/// zero. The procedures of a printer end where its next motions start.
void Poster::left_out(std::size_t i) {
  known_axes_ = 0;
  if (options_.left_out == LeftOutCodes::skipped || profile_.syntax == LineSyntax::commands) return;
  Diagnostic& d = diagnostics_.error(
      codes::post_code_left_out, path_.origin_of(i),
      fmt::format("{} was left out; it may move the tool, or change the tool or the work zero",
                  path_.text(i)));
  d.hint = "write the program without it with --allow-left-out";
}

/// What the program does from here on is known to its controller only.
void Poster::unresolved(std::size_t i) {
  position_.pass(path_[i]);
  if (path_[i].unresolved() == UnresolvedKind::code) return left_out(i);
  report_unsupported(i,
                     fmt::format("{} depends on a value known only at run time, such as a probed position; "
                                 "it cannot be written for another one",
                                 path_.text(i)));
}

void Poster::verbatim(std::size_t i) {
  const std::string_view text = path_.text(i);
  if (is_comment(text) && acts(text.substr(1)) && !profile_.parameters)
    return report_skipped(i, fmt::format("the controller does not carry out comments; {}", text));
  if (text.find_first_of("\r\n") != std::string_view::npos || text.size() > profile_.longest_line)
    return report_unsupported(i, "a verbatim text does not fit on one line of the controller");
  const std::string line(text);
  Diagnostics found;
  if (!lint(line, profile_, "", LintStart::foreign_line, found)) {
    Diagnostic& d = diagnostics_.error(codes::post_cannot, path_.origin_of(i),
                                       fmt::format("the controller does not accept \"{}\"", line));
    for (const Diagnostic& f : found.list()) d.notes.push_back({{}, f.message});
    return;
  }
  raw_line(line);
}

}  // namespace kerf::gcode
