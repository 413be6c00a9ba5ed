// The axes of the controller.
#include "back/gcode/axis_words.h"

#include <cmath>
#include <fmt/format.h>

namespace kerf::gcode {

/// The formula of the height at the end of a motion; empty: it has none.
std::string_view AxisWords::correction_of(std::size_t i) const {
  const MotionExtra* extra = path_.extra(i);
  return extra != nullptr ? std::string_view(extra->z_correction) : std::string_view();
}

/// The formula behind a Z word, as kerf adjustz reads it.
void AxisWords::put_correction(std::size_t i) {
  if (const std::string_view formula = correction_of(i); !formula.empty())
    lines_.put("(="), lines_.put(formula), lines_.put(")");
}

/// The axes whose words the line needs: those that move, and those of the program's line (all, where it is
/// not known) that have not been written since the controller's position was last unknown, or since a pause.
unsigned AxisWords::to_write(std::size_t i, const Counts& to) const {
  const Step& s = path_[i];
  unsigned axes = profile_.axes == Repeat::always ? kAllAxes : kAllAxes & ~known_;
  if (s.named_axes() != 0) axes = (axes & (known_ | s.named_axes())) | (paused_ & s.named_axes());
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (to[axis] != at_[axis]) axes |= 1u << axis;
  if (!correction_of(i).empty()) axes |= 4u;  // Z
  const unsigned target_known = s.kind() == StepKind::probe ? s.reference_axes() : 0u;
  return axes & (~s.unknown_axes() | target_known);
}

/// The axes that move by a distance: their positions before and after are unknown.
unsigned AxisWords::by_distance(std::size_t i, const Counts& to) const {
  const Step& s = path_[i];
  unsigned axes = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (to[axis] != at_[axis]) axes |= 1u << axis;
  return axes & s.unknown_axes() & ~s.reference_axes();
}

void AxisWords::arrive(std::size_t i, const Counts& to, unsigned written) {
  at_ = to;
  known_ = (known_ | written) & ~path_[i].unknown_axes();
  paused_ &= ~written;
}

void AxisWords::approach(const Counts& to, unsigned axes) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if ((axes >> axis & 1u) != 0) at_[axis] = to[axis];
  known_ |= axes;
}

/// Adds the rotary words that change, at a fraction of the motion; false if there are none.
bool RotaryWords::add(std::size_t i, double fraction) {
  const MotionExtra* extra = path_.extra(i);
  if (extra == nullptr || !extra->abc) return false;
  bool any = false;
  const double scale = std::pow(10.0, profile_.decimals.degrees);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double degrees = from_[axis] + fraction * ((*extra->abc)[axis] - from_[axis]);
    const auto counts = static_cast<std::int64_t>(std::llround(degrees * scale));
    const char letter = static_cast<char>('A' + axis);
    const unsigned bit = 1u << axis;
    if ((extra->unknown_abc & bit) != 0) {
      if (counts != counts_[axis])
        report_unsupported(i, fmt::format("{} turns by an angle from an unknown position", letter));
      counts_[axis] = counts;
      known_ &= ~bit;
      continue;
    }
    if ((unknown_ & bit) != 0 || (*extra->abc)[axis] != from_[axis]) turned_by_ = i;
    const bool known = (known_ & bit) != 0 || (counts == 0 && !profile_.has_letter(letter));
    if (counts == counts_[axis] && known) continue;
    counts_[axis] = counts;
    known_ |= bit;
    if (!profile_.has_letter(letter)) {
      report_unsupported(i, fmt::format("the controller has no rotary axis {}", letter));
      continue;
    }
    lines_.word(letter, counts, profile_.decimals.degrees);
    any = true;
  }
  if (fraction == 1.0) from_ = *extra->abc, unknown_ = extra->unknown_abc;
  return any;
}

/// Whether only rotary axes move, by the words of the motion. The feed is in degrees per minute then.
bool RotaryWords::only_turns(std::size_t i) const {
  const Step& s = path_[i];
  return turned_by_ == i && s.kind() != StepKind::arc && s.to() == position_.at &&
         s.unknown_axes() == position_.unknown;
}

bool RotaryWords::in_inverse_time(std::size_t i) const {
  const Step& s = path_[i];
  return profile_.form.turning_feed == TurningFeed::inverse_time && turns(i) && s.kind() == StepKind::cut &&
         s.feed() > Feed{} && (s.unknown_axes() | position_.unknown) == 0 && !(s.to() == position_.at);
}

bool RotaryWords::turns(std::size_t i) const {
  const MotionExtra* extra = path_.extra(i);
  return extra != nullptr && extra->abc && *extra->abc != from_;
}

}  // namespace kerf::gcode
