// The spindle, or the beam of a laser.
#include "front/gcode/run/spindle.h"

#include <fmt/format.h>

#include "base/codes/gcode.h"

namespace kerf::gcode {

void Spindle::set_speed() {
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
  if (changes && !line_.has(Group::spindle) && !line_.has(Group::tool_change)) turn(modes_.spindle);
}

void Spindle::switch_by_code() {
  const Tenths code = line_.code(Group::spindle);
  if (code != 50 && !modes_.speed_given && !without_speed_)
    without_speed_ = {code, reporter_.location(line_.column(Group::spindle))};
  if (code != 50 && modes_.surface_speed > 0.0) report_surface_speed(line_.column(Group::spindle));
  switch (code) {
    case 30: return turn(SpindleTurn::cw);
    case 40: return turn(SpindleTurn::ccw);
    default: return turn(SpindleTurn::off);
  }
}

/// S0 stops the spindle. Without any S word the speed is unknown (set by hand), stored as 0, and the spindle
/// turns.
void Spindle::turn(SpindleTurn turn) {
  modes_.spindle = turn;
  if (program_.dialect == GcodeDialect::laser) return set_beam();
  const bool stopped = turn == SpindleTurn::off ||
                       (modes_.speed_given && !(modes_.speed > 0.0) && !(modes_.surface_speed > 0.0));
  add(step::Spindle{stopped ? rpm(0) : rpm(modes_.speed), stopped ? SpindleTurn::off : turn});
}

/// Laser: M3 is constant power, M4 power in proportion to the feed.
void Spindle::set_beam() {
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
void Spindle::set_mode() {
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
void Spindle::report_surface_speed(std::uint32_t column) {
  reporter_.unusual(codes::value_unknown, column,
                    "G96 holds the cutting speed constant; the speed of the spindle is unknown",
                    "mills need G97 and S in rpm");
  add(step::Unresolved{"the speed of the spindle after G96"});
}

void Spindle::report_missing_speed() {
  if (!without_speed_ || modes_.speed_given) return;
  const auto& [code, where] = *without_speed_;
  reporter_.unusual_at(where, codes::word_missing,
                       fmt::format("{} starts the spindle without an S word; assuming a speed set by hand",
                                   code_text('M', code)),
                       "put an S word before it or on its line");
}

}  // namespace kerf::gcode
