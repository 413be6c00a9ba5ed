// The axes A, B and C.
#include "front/gcode/run/rotary_axes.h"

namespace kerf::gcode {

unsigned RotaryAxes::take_words() {
  from_ = angles_;
  unknown_from_ = unknown_;
  if (!line_.has_unused(kRotaryLetters)) return 0;
  used_ = true;
  unsigned named = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto word = line_.take(static_cast<char>('A' + axis));
    if (!word) continue;
    named |= 1u << axis;
    present_ |= 1u << axis;
    angles_[axis] = modes_.absolute ? *word : angles_[axis] + *word;
    if (modes_.absolute) unknown_ &= ~(1u << axis);
  }
  return named;
}

double RotaryAxes::square_of_turn() const {
  double square = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    square += (angles_[axis] - from_[axis]) * (angles_[axis] - from_[axis]);
  return square;
}

}  // namespace kerf::gcode
