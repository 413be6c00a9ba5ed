// Which motion the words of a line are.
#pragma once

#include "front/gcode/run/arcs.h"
#include "front/gcode/run/canned_cycles.h"
#include "front/gcode/run/circular_pockets.h"
#include "front/gcode/run/compensation.h"
#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/corner_words.h"
#include "front/gcode/run/dwells.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/printer.h"
#include "front/gcode/run/rotary_axes.h"
#include "front/gcode/run/spindle.h"
#include "front/gcode/run/splines.h"
#include "front/gcode/run/thread_cycles.h"

namespace kerf::gcode {

class MotionWords : Part {
 public:
  MotionWords(Context& context, Coordinates& coordinates, RotaryAxes& rotary, Mover& mover, Feeds& feeds,
              Dwells& dwells, Spindle& spindle, Compensation& compensation, CornerWords& corners,
              Printer& printer)
      : Part(context),
        coordinates_(coordinates),
        rotary_(rotary),
        mover_(mover),
        feeds_(feeds),
        compensation_(compensation),
        corners_(corners),
        printer_(printer),
        arcs_(context, coordinates, mover, feeds, compensation, printer),
        splines_(context, coordinates, mover, feeds),
        pockets_(context, mover, feeds, compensation),
        cycles_(context, coordinates, mover, feeds, dwells, spindle),
        threads_(context, mover, spindle) {}

  void run_line();
  void note_unknown_words();
  /// The line of a G code that is not known.
  void leave_out_motion();
  /// A code that is not known, after which the position is unknown.
  void leave_out(const std::string& code);
  void end_cycle() { cycles_.end(); }

 private:
  void run_motion(Tenths motion);
  void straight(Tenths motion);
  bool may_move_after_cancel();
  void probe(ProbeKind kind);

  Coordinates& coordinates_;
  RotaryAxes& rotary_;
  Mover& mover_;
  Feeds& feeds_;
  Compensation& compensation_;
  CornerWords& corners_;
  Printer& printer_;
  Arcs arcs_;
  Splines splines_;
  CircularPockets pockets_;
  CannedCycles cycles_;
  ThreadCycles threads_;
  Tenths motion_before_cycle_ = kMotionNotGiven;
};

}  // namespace kerf::gcode
