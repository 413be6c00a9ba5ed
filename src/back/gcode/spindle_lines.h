// Spindle, laser, coolant and dwells.
#pragma once

#include <cstddef>

#include "back/gcode/modal_words.h"
#include "back/gcode/post_part.h"

namespace kerf::gcode {

class SpindleLines : PostPart {
 public:
  SpindleLines(PostContext& context, ModalWords& words) : PostPart(context), words_(words) {}

  void spindle(std::size_t i);
  void laser(std::size_t i);
  void coolant(std::size_t i);
  void dwell(std::size_t i, Duration time);
  void stop();
  /// A tool change may stop spindle and coolant.
  void note_change() { restore_ = true; }
  /// Restarts what a tool change has stopped, before the next motion.
  void restore(std::size_t i) {
    if (restore_) restart(i);
  }
  void start_file();
  void end_file();
  SpindleTurn turn() const { return spindle_.turn; }

 private:
  void start(std::size_t i);
  bool can_mode(std::size_t i);
  void report_drive(std::size_t i, std::string_view what);
  void put_mode();
  void put_speed(std::size_t i);
  void put_turning_speed(std::size_t i);
  void put_count(char letter, double value);
  void set_coolant(std::size_t i, const step::Coolant& wanted);
  void restart(std::size_t i);

  ModalWords& words_;
  step::Spindle wanted_spindle_;  // of the toolpath
  step::Coolant wanted_coolant_;
  step::Spindle spindle_;  // of the controller
  step::Coolant coolant_;
  bool holds_surface_ = false;  // G96 is in force
  bool drive_reported_ = false;
  bool speed_in_force_ = false;  // an S word in rpm
  LaserMode laser_ = LaserMode::off;
  bool restore_ = false;  // spindle or coolant may have been stopped by a tool change
};

}  // namespace kerf::gcode
