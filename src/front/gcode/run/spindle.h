// The spindle, or the beam of a laser.
#pragma once

#include <optional>
#include <utility>

#include "front/gcode/run/part.h"

namespace kerf::gcode {

class Spindle : Part {
 public:
  explicit Spindle(Context& context) : Part(context) {}

  void set_speed();
  /// M3 to M5.
  void switch_by_code();
  /// M106 and M107 of lasers, whose beam is the output for a fan. False for other lines.
  bool switch_by_fan();
  /// G96, G97.
  void set_mode();
  void turn(SpindleTurn turn);
  void stop() {
    if (modes_.spindle != SpindleTurn::off) turn(SpindleTurn::off);
  }
  /// At the end of the program.
  void report_missing_speed();

 private:
  void set_beam();
  void take_percentage();
  double surface_unit() const;
  step::Spindle wanted() const;
  void restate();
  void report_surface_speed(std::uint32_t column);

  step::Spindle stated_;  // by the last step
  LaserMode beam_mode_ = LaserMode::off;
  double beam_power_ = 0.0;
  std::optional<std::pair<Tenths, TextLocation>> without_speed_;  // first M3 or M4 before any S word
};

}  // namespace kerf::gcode
