// Words that set a mode and have no state of their own.
#pragma once

#include "front/gcode/run/compensation.h"
#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/program_comments.h"

namespace kerf::gcode {

class Settings : Part {
 public:
  Settings(Context& context, Coordinates& coordinates, Compensation& compensation, ProgramComments& comments)
      : Part(context), coordinates_(coordinates), compensation_(compensation), comments_(comments) {}

  void set_units();
  void switch_coolant();
  void stop_coolant();
  void switch_overrides();
  void set_plane();
  void set_path_mode();
  /// G15 and G16.
  void set_polar_mode();
  void set_distance();
  void use_words_of_other_codes();
  void read_large_m_code();
  void skip_setting(const Block& block);

 private:
  Coordinates& coordinates_;
  Compensation& compensation_;
  ProgramComments& comments_;
};

}  // namespace kerf::gcode
