// Spindle, laser, coolant and dwells.
#include "back/gcode/spindle_lines.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

std::int64_t counts_of(double value, int decimals) { return std::llround(value * std::pow(10.0, decimals)); }

}  // namespace

void SpindleLines::spindle(std::size_t i) {
  wanted_spindle_ = path_[i].spindle();
  if (wanted_spindle_.turn == SpindleTurn::off) return stop();
  start(i);
}

/// The post is for another kind of machine than the program.
void SpindleLines::report_drive(std::size_t i, std::string_view what) {
  if (!std::exchange(drive_reported_, true))
    diagnostics_.warning(codes::post_left_out, path_.origin_of(i), fmt::format("the post is for {}", what))
        .hint = "the post laser is for lasers; in a post file: drives = \"beam\" or \"spindle\" in [words]";
}

void SpindleLines::stop() {
  if (spindle_.turn == SpindleTurn::off && laser_ == LaserMode::off && moved_) return;
  spindle_ = {};
  laser_ = LaserMode::off;
  words_.set_power(std::nullopt);
  if (profile_.has_m(50)) lines_.code_line(path_.size(), 'M', 50);
}

void SpindleLines::start(std::size_t i) {
  if (profile_.drive.kind == Drive::beam)
    report_drive(i, "lasers; a spindle is written as a beam with its speed as the power");
  const int tenths = wanted_spindle_.turn == SpindleTurn::cw ? 30 : 40;
  if (!can_m(i, tenths, "starting the spindle") || !can_mode(i)) return;
  const bool by_hand = !(wanted_spindle_.surface_speed > Feed{}) && !(wanted_spindle_.speed > SpindleSpeed{});
  if (by_hand && speed_in_force_ && !holds_surface_)
    report_skipped(i, "the controller keeps the speed of the last S word; a speed set by hand");
  const bool starts = spindle_.turn == SpindleTurn::off;
  lines_.start_line();
  put_mode();
  lines_.code('M', tenths);
  put_speed(i);
  lines_.end_line(i);
  spindle_ = wanted_spindle_;
  const bool waits = i + 1 < path_.size() && path_[i + 1].kind() == StepKind::dwell;
  if (starts && !waits && profile_.spindle_dwell > Duration{}) dwell(i, profile_.spindle_dwell);
}

/// Whether the controller can hold the surface speed, if that is what is wanted.
bool SpindleLines::can_mode(std::size_t i) {
  if (!(wanted_spindle_.surface_speed > Feed{})) return true;
  if (!profile_.has_g(960)) {
    report_unsupported(i, "the controller has no G96, which holds the cutting speed constant");
    return false;
  }
  if (wanted_spindle_.speed > SpindleSpeed{} && !profile_.drive.surface_limit) {
    report_unsupported(i, "the post has no word for the highest speed under G96 (key surface_limit)");
    return false;
  }
  return true;
}

/// G96 with its limit, which is not modal, or G97 after it.
void SpindleLines::put_mode() {
  const bool holds = wanted_spindle_.surface_speed > Feed{};
  if (holds) {
    lines_.code('G', 960);
    if (wanted_spindle_.speed > SpindleSpeed{}) put_count('D', wanted_spindle_.speed.rpm());
  } else if (holds_surface_) {
    lines_.code('G', 970);
    speed_in_force_ = false;  // unknown until the next S word
  }
  holds_surface_ = holds;
}

/// In rpm or percent, or in metres or feet per minute.
void SpindleLines::put_speed(std::size_t i) {
  if (wanted_spindle_.surface_speed > Feed{}) {
    constexpr int kDecimals = 3;
    const double unit = units_.unit == LengthUnit::inch ? 12.0 * kMmPerInch : 1000.0;
    lines_.word('S', counts_of(wanted_spindle_.surface_speed.mm_per_min() / unit, kDecimals), kDecimals);
  } else if (wanted_spindle_.speed > SpindleSpeed{}) {  // else set by hand, or in force in the controller
    put_turning_speed(i);
    speed_in_force_ = true;
  }
}

/// S in rpm, or P as a whole percentage of the highest speed.
void SpindleLines::put_turning_speed(std::size_t i) {
  const double speed = wanted_spindle_.speed.rpm(), full = profile_.drive.full_speed.rpm();
  if (!(full > 0.0)) return put_count('S', speed);
  if (speed > full)
    diagnostics_.warning(
        codes::post_left_out, path_.origin_of(i),
        fmt::format("the spindle turns at {:g} rpm at most; the program wants {:g} rpm", full, speed));
  lines_.word('P', std::clamp<std::int64_t>(std::llround(speed / full * 100.0), 1, 100), 0);
}

void SpindleLines::put_count(char letter, double value) {
  lines_.word(letter, counts_of(value, profile_.decimals.speed), profile_.decimals.speed);
}

void SpindleLines::laser(std::size_t i) {
  const step::LaserPower wanted = path_[i].laser_power();
  if (wanted.mode == LaserMode::off) return stop();
  if (profile_.drive.kind != Drive::beam)
    report_drive(i, "spindles; a beam is written as a spindle with its power as the speed");
  if (wanted.mode == laser_) {  // a changed power does not stop the motion
    words_.set_power(wanted.power);
    return;
  }
  const int tenths = wanted.mode == LaserMode::constant ? 30 : 40;
  if (!can_m(i, tenths, "a laser")) return;
  laser_ = wanted.mode;
  words_.set_power(std::nullopt);  // written with the mode
  lines_.start_line();
  lines_.code('M', tenths);
  put_count('S', wanted.power);
  lines_.end_line(i);
}

void SpindleLines::set_coolant(std::size_t i, const step::Coolant& wanted) {
  const bool less = (coolant_.mist && !wanted.mist) || (coolant_.flood && !wanted.flood);
  if ((less || (!wanted.mist && !wanted.flood && !moved_)) && profile_.has_m(90)) {
    lines_.code_line(i, 'M', 90);
    coolant_ = {};
  }
  if (wanted.mist && !coolant_.mist) {
    coolant_.mist = true;
    if (profile_.has_m(70))
      lines_.code_line(i, 'M', 70);
    else
      report_skipped(i, "the controller has no M7; mist");
  }
  if (wanted.flood && !coolant_.flood) {
    coolant_.flood = true;
    if (profile_.has_m(80))
      lines_.code_line(i, 'M', 80);
    else
      report_skipped(i, "the controller has no M8; flood");
  }
}

void SpindleLines::dwell(std::size_t i, Duration time) {
  lines_.start_line();
  lines_.code('G', 40);
  lines_.time_word(time);
  lines_.end_line(i);
}

void SpindleLines::restart(std::size_t i) {
  restore_ = false;
  if (wanted_spindle_ != spindle_) {
    if (wanted_spindle_.turn == SpindleTurn::off)
      stop();
    else
      start(i);
  }
  if (wanted_coolant_.mist != coolant_.mist || wanted_coolant_.flood != coolant_.flood)
    set_coolant(i, wanted_coolant_);
}

void SpindleLines::coolant(std::size_t i) {
  wanted_coolant_ = path_[i].coolant();
  set_coolant(i, wanted_coolant_);
}

void SpindleLines::start_file() {
  spindle_ = {};
  coolant_ = {};
  laser_ = LaserMode::off;
  holds_surface_ = speed_in_force_ = false;
}

void SpindleLines::end_file() {
  if (spindle_.turn != SpindleTurn::off || laser_ != LaserMode::off) stop();
  if ((coolant_.mist || coolant_.flood) && profile_.has_m(90)) lines_.code_line(path_.size(), 'M', 90);
  if (holds_surface_) lines_.code_line(path_.size(), 'G', 970);
}

}  // namespace kerf::gcode
