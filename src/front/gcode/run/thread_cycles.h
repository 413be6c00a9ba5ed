// G33, G33.1 and the threading cycle G76.
#pragma once

#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/spindle.h"

namespace kerf::gcode {

class ThreadCycles : Part {
 public:
  ThreadCycles(Context& context, Mover& mover, Spindle& spindle)
      : Part(context), mover_(mover), spindle_(spindle) {}

  void spindle_motion(Tenths motion);
  void cycle();

 private:
  struct Thread;
  Thread take_words();
  void pass(const Thread& thread, const ToolPosition& start, double end_z, double depth);

  Mover& mover_;
  Spindle& spindle_;
};

}  // namespace kerf::gcode
