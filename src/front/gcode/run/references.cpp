// Homes, and which part executes a code that uses the axis words itself.
#include "front/gcode/run/references.h"

namespace kerf::gcode {

void References::use() {
  const bool printer = is_printer();
  if (printer) return printer_.use_reference();
  switch (line_.code(Group::reference)) {
    case 100: return coordinates_.set_data();
    case 120:
    case 130:
    case 700:
    case 710: return;  // by MotionWords
    case 280: return go_home(Reference::home);
    case 300: return go_home(Reference::second_home);
    case 281:
      if (program_.dialect == GcodeDialect::mach3 || is_torch_on_mach3()) return reference_axes();
      return coordinates_.set_home(Reference::home);
    case 301: return coordinates_.set_home(Reference::second_home);
    case 520: return coordinates_.shift_locally();
    case 920: return coordinates_.shift_zero();
    case 921:
    case 922:
    case 923: return coordinates_.end_shift(line_.code(Group::reference));
    default: line_.use(kAllLetters); return;
  }
}

/// G28.1 with axis words in a program for a torch, which is Mach3's.
bool References::is_torch_on_mach3() const {
  return program_.dialect == GcodeDialect::laser && line_.has_any(kAxisLetters);
}

/// Mach3's G28.1 runs the named axes to their switches; where these are in work coordinates is unknown.
void References::reference_axes() {
  const bool all = !line_.has_any(kAxisLetters | kRotaryLetters);
  unsigned lost = all ? rotary_.present() : 0;
  for (int axis = 0; axis < 3 && !all; ++axis)
    if (line_.has(static_cast<char>('A' + axis))) lost |= 1u << axis;
  rotary_.lose(lost);
  if (all || line_.has_any(kAxisLetters)) printer_.run_to_end_switches();
  line_.use(kAxisLetters | kRotaryLetters);
}

/// Through the intermediate point to the home; the named axes, or all. Homes of rotary axes are unknown.
void References::go_home(Reference reference) {
  const ToolPosition& home = coordinates_.home(reference);
  unsigned axes = 0, rotary = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (line_.unused(static_cast<char>('X' + axis))) axes |= 1u << axis;
    if (line_.unused(static_cast<char>('A' + axis))) rotary |= 1u << axis;
  }
  if (axes == 0 && rotary == 0) {
    axes = kAllAxes;
    rotary = rotary_.present();
  }
  std::optional<ToolPosition> to = mover_.target();
  if (!to) return;
  mover_.rapid(*to);
  Point3 end = coordinates_.frame().to_program(to->at);  // axes are those of the program
  const Point3 home_in_program = coordinates_.frame().to_program(home.at);
  for (int axis = 0; axis < 3; ++axis) {
    const unsigned bit = 1u << axis;
    if ((axes & bit) == 0) continue;
    end[axis] = home_in_program[axis];
    if (coordinates_.frame().only_shifted) to->at[axis] = home.at[axis];
    to->unknown = (to->unknown & ~bit) | (home.unknown & bit);
  }
  if (!coordinates_.frame().only_shifted) to->at = coordinates_.frame().to_path(end);
  to->reference = reference;
  to->reference_axes = axes & to->unknown;
  take_assigned_home(reference == Reference::home ? kHome28 : kHome30, axes, rotary, *to);
  rotary_.go_to_reference(rotary);
  mover_.rapid(*to);
}

/// Homes that the program has assigned to parameters are machine coordinates, as after G53. A home of which
/// only some axes were assigned, or from probed values, is known to the controller alone.
void References::take_assigned_home(int first, unsigned axes, unsigned rotary, ToolPosition& to) const {
  const unsigned moved = axes | rotary << 3;
  unsigned assigned = 0, measured = 0;
  for (int axis = 0; axis < 6; ++axis) {
    const unsigned bit = 1u << axis & moved;
    if (bit == 0 || !parameters_.is_assigned(first + axis)) continue;
    assigned |= bit;
    if (parameters_.number(first + axis)->unknown) measured |= bit;
    if (axis < 3) to.at[axis] = parameters_.slot(first + axis);
  }
  if (assigned == 0) return;
  to.unknown |= axes;
  to.reference_axes = axes;
  to.reference = assigned == moved && rotary == 0 && measured == 0 ? Reference::machine : Reference::measured;
}

}  // namespace kerf::gcode
