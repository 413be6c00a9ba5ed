// Codes that use the axis words themselves: homes, and those of printer.h and coordinates.h.
#pragma once

#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/printer.h"
#include "front/gcode/run/rotary_axes.h"

namespace kerf::gcode {

class References : Part {
 public:
  References(Context& context, Coordinates& coordinates, RotaryAxes& rotary, Mover& mover, Printer& printer)
      : Part(context), coordinates_(coordinates), rotary_(rotary), mover_(mover), printer_(printer) {}

  void use();

 private:
  bool is_torch_on_mach3() const;
  void reference_axes();
  void go_home(Reference reference);
  void take_assigned_home(int first, unsigned axes, unsigned rotary, ToolPosition& to) const;

  Coordinates& coordinates_;
  RotaryAxes& rotary_;
  Mover& mover_;
  Printer& printer_;
};

}  // namespace kerf::gcode
