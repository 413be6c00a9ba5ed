// The spindle, or the beam of a laser.
#include "front/gcode/run/spindle.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr double kFullFan = 255.0;  // of an M106 without S

}  // namespace

void Spindle::set_speed() {
  const double speed = *line_.take('S');
  if (speed < 0.0) {
    reporter_.error(codes::word_out_of_range, line_.column('S'),
                    "a spindle speed cannot be negative; skipped");
    return;
  }
  if (modes_.surface_speed > 0.0)
    modes_.surface_speed = speed * surface_unit();
  else
    modes_.speed = speed;
  modes_.speed_given = true;
  if (program_.dialect == GcodeDialect::laser) return set_beam();
  restate();
}

/// In mm per minute: metres, or feet.
double Spindle::surface_unit() const { return modes_.scale == 1.0 ? 1000.0 : 12.0 * modes_.scale; }

void Spindle::switch_by_code() {
  const Tenths code = line_.code(Group::spindle);
  if (code != 50) take_percentage();
  if (code != 50 && !modes_.speed_given && !without_speed_)
    without_speed_ = {code, reporter_.location(line_.column(Group::spindle))};
  if (code != 50 && modes_.surface_speed > 0.0) report_surface_speed(line_.column(Group::spindle));
  switch (code) {
    case 30: return turn(SpindleTurn::cw);
    case 40: return turn(SpindleTurn::ccw);
    default: return turn(SpindleTurn::off);
  }
}

/// P of M3 is Snapmaker's percentage of 12000 rpm (its "gcode_reference.md"); other Marlins have no P there.
void Spindle::take_percentage() {
  constexpr double kFullSpeed = 12'000.0, kPercent = 100.0;
  if (program_.dialect != GcodeDialect::marlin || !line_.unused('P')) return;
  modes_.speed = std::clamp(*line_.take('P'), 0.0, kPercent) / kPercent * kFullSpeed;
  modes_.speed_given = true;
}

/// S0 stops the spindle. Without any S word the speed is unknown (set by hand), stored as 0, and the spindle
/// turns.
step::Spindle Spindle::wanted() const {
  const bool surface = modes_.surface_speed > 0.0;
  const bool stopped =
      modes_.spindle == SpindleTurn::off || (modes_.speed_given && !(modes_.speed > 0.0) && !surface);
  if (stopped) return {};
  return {rpm(modes_.speed), modes_.spindle, mm_per_min(modes_.surface_speed)};
}

void Spindle::turn(SpindleTurn turn) {
  modes_.spindle = turn;
  if (program_.dialect == GcodeDialect::laser) return set_beam();
  stated_ = wanted();
  add(stated_);
}

/// A turning spindle takes its new speed at once, unless a code of the line does so.
void Spindle::restate() {
  if (modes_.spindle == SpindleTurn::off || line_.has(Group::spindle) || line_.has(Group::tool_change))
    return;
  if (wanted() != stated_) turn(modes_.spindle);
}

/// Laser: M3 is constant power, M4 power in proportion to the feed.
void Spindle::set_beam() {
  const LaserMode mode = modes_.spindle == SpindleTurn::off  ? LaserMode::off
                         : modes_.spindle == SpindleTurn::cw ? LaserMode::constant
                                                             : LaserMode::dynamic;
  const double power = mode == LaserMode::off || program_.torch ? 0.0 : modes_.speed;
  if (mode == beam_mode_ && power == beam_power_) return;
  beam_mode_ = mode;
  beam_power_ = power;
  add(step::LaserPower{mode, power});
}

/// G96 holds the cutting speed constant: the rpm follow X. After a G97 without S they are unknown.
void Spindle::set_mode() {
  const double limit = line_.take('D').value_or(0.0);
  const bool surface = line_.code(Group::spindle_mode) == 960;
  const bool was_surface = std::exchange(modes_.surface_speed, surface ? line_.value('S') : 0.0) > 0.0;
  if (surface && !line_.has('S'))
    reporter_.error(codes::word_missing, line_.column(Group::spindle_mode), "G96 needs S, the cutting speed");
  if (!surface && was_surface) {
    modes_.speed = 0.0, modes_.speed_given = false;
    if (!line_.has('S')) restate();
  }
  if (!surface) return;
  modes_.speed = limit;
  if (modes_.spindle != SpindleTurn::off) report_surface_speed(line_.column(Group::spindle_mode));
}

/// The spindle turns at a speed that follows the diameter of the work.
void Spindle::report_surface_speed(std::uint32_t column) {
  reporter_.unusual(codes::value_unknown, column,
                    "G96 holds the cutting speed constant; the speed of the spindle is unknown",
                    "mills need G97 and S in rpm");
}

bool Spindle::switch_by_fan() {
  const int code = line_.large_m_code();
  if (program_.dialect != GcodeDialect::laser || (code != 106 && code != 107)) return false;
  if (code == 106) modes_.speed = line_.has('S') ? line_.value('S') : kFullFan;
  modes_.speed_given = true;
  modes_.spindle = code == 106 && modes_.speed > 0.0 ? SpindleTurn::cw : SpindleTurn::off;
  line_.use(LineWords::bit('P') | LineWords::bit('S'));
  set_beam();
  return true;
}

void Spindle::report_missing_speed() {
  if (!without_speed_ || modes_.speed_given) return;
  const auto& [code, where] = *without_speed_;
  if (program_.dialect == GcodeDialect::laser)
    return reporter_.unusual_at(
        where, codes::word_missing,
        fmt::format("{} without an S word: the power of the beam is unknown", code_text('M', code)),
        "a torch has none; put an S word before it for a laser");
  reporter_.unusual_at(where, codes::word_missing,
                       fmt::format("{} starts the spindle without an S word; assuming a speed set by hand",
                                   code_text('M', code)),
                       "put an S word before it or on its line");
}

}  // namespace kerf::gcode
