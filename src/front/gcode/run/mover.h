// The tool's position: the targets of axis words, and the motions to them.
#pragma once

#include <optional>
#include <utility>

#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/program_comments.h"
#include "front/gcode/run/rotary_axes.h"

namespace kerf::gcode {

class Mover : Part {
 public:
  Mover(Context& context, Coordinates& coordinates, RotaryAxes& rotary, ProgramComments& comments)
      : Part(context), coordinates_(coordinates), rotary_(rotary), comments_(comments) {}

  /// The target of the line's axis words, which are marked as used. Nothing with an error if it is too far
  /// away.
  std::optional<ToolPosition> target();
  /// As target(), in machine coordinates; the position in work coordinates is unknown after it.
  std::optional<ToolPosition> machine_target();
  void use_polar_words();
  /// The X and Y words of a line after G16 are a radius and an angle.
  void use_polar_mode();
  /// Radius in mm and angle in degrees of the line's polar words.
  std::pair<double, double> polar_step() const { return polar_step_; }

  void rapid(const ToolPosition& to);
  void cut(const ToolPosition& to, double feed);
  /// A cut that depends on the spindle's angle, by mm per revolution.
  void locked_cut(const ToolPosition& to, double per_turn, SpindleLock lock);
  void tapping_cut(const ToolPosition& to, double feed, SpindleLock lock);
  /// The path's last step is a motion to this position.
  void arrive(const ToolPosition& to);

  /// Sets the axes that the line names, for Step::named_axes; 0: its motions are computed.
  void set_named(unsigned axes) { named_ = axes; }
  unsigned named() const { return named_; }
  void note_stop();
  bool starts_at_rest() const { return starts_at_rest_; }

 private:
  ToolPosition target_in_frame();
  void mark_measured(ToolPosition& to) const;
  void set_extra();

  Coordinates& coordinates_;
  RotaryAxes& rotary_;
  ProgramComments& comments_;
  SpindleLock lock_ = SpindleLock::none;  // of the motion that is added
  double per_turn_ = 0.0;                 // of it
  std::pair<double, double> polar_step_{};
  unsigned named_ = 0;
  Tenths work_offset_ = 540;
  bool starts_at_rest_ = false;  // the next motion starts at rest: a zero was shifted
};

}  // namespace kerf::gcode
