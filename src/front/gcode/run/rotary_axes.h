// The axes A, B and C.
#pragma once

#include <array>

#include "front/gcode/run/part.h"

namespace kerf::gcode {

/// Angles of the rotary axes before and after the present line. Bits 1, 2, 4 of masks: A, B, C.
class RotaryAxes : Part {
 public:
  explicit RotaryAxes(Context& context) : Part(context) {}

  /// Takes A, B and C; returns which of them the line has, as bits.
  unsigned take_words();
  /// The square of the angle by which the line turns, in degrees.
  double square_of_turn() const;
  /// Whether the line moves an axis from an unknown angle to a known one.
  bool from_unknown() const { return (unknown_from_ & ~unknown_) != 0; }
  void lose(unsigned axes) { unknown_ |= axes; }
  /// The next motion moves these axes to its reference, where their angles are unknown.
  void go_to_reference(unsigned axes) {
    unknown_ |= axes;
    reference_ = axes;
  }
  /// What the program's last motion says of these axes.
  void set_extra(MotionExtra& extra) const {
    if (used_) extra.abc = angles_, extra.unknown_abc = unknown_, extra.reference_abc = reference_;
  }
  void arrive() { reference_ = 0; }

  bool used() const { return used_; }
  unsigned present() const { return present_; }
  unsigned unknown() const { return unknown_; }
  unsigned reference() const { return reference_; }
  double angle(std::size_t axis) const { return angles_[axis]; }

 private:
  std::array<double, 3> angles_{};  // degrees
  std::array<double, 3> from_{};    // before the line's words
  unsigned unknown_ = kAllAxes;
  unsigned unknown_from_ = kAllAxes;
  unsigned reference_ = 0;  // axes that the next motion moves to its reference
  unsigned present_ = 0;    // those that the program has
  bool used_ = false;
};

}  // namespace kerf::gcode
