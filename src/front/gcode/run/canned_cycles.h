// G73, G74 and G81 to G89.
#pragma once

#include <optional>

#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/dwells.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/spindle.h"

#include "kerf/op/holes.h"

namespace kerf::gcode {

/// Words of a canned cycle, in force until its end. R and Z as in the program, in mm; the rest in mm and
/// seconds.
struct CycleWords {
  Tenths motion = kNoMotion;  // the cycle of these words
  std::optional<double> r, bottom, dwell, peck, peck_less, peck_least;
  bool is_plane_measured = false;                      // R depends on a value known only at run time
  std::optional<double> aside_u, aside_v, back_level;  // I J K of a back boring cycle
  std::optional<double> start_level;                   // before the first of consecutive cycles
};

class CannedCycles : Part {
 public:
  CannedCycles(Context& context, const Coordinates& coordinates, Mover& mover, Feeds& feeds, Dwells& dwells,
               Spindle& spindle)
      : Part(context),
        coordinates_(coordinates),
        mover_(mover),
        feeds_(feeds),
        dwells_(dwells),
        spindle_(spindle) {}

  void cycle(Tenths motion);
  /// G70 and G71 of Haas: the holes of the cycle `motion` on a circle or an arc.
  void pattern(Tenths code, Tenths motion);
  /// The words of a cycle are no longer in force.
  void end() { cycle_ = {}; }

 private:
  class CycleSink;
  bool start(Tenths motion);
  bool take_words(Tenths motion);
  void report_wrong_turn(Tenths motion);
  void repeat_on_circle(DrillCycle cycle, const ToolPosition& to);
  std::optional<DrillCycle> plan(Tenths motion, ToolPosition& target_position);
  void plan_back_bore(DrillCycle& cycle) const;
  bool refuse_pecks(Tenths motion);
  double unit_of_peck();
  int repeats();
  int reachable_holes(const DrillCycle& cycle, int holes);

  const Coordinates& coordinates_;
  Mover& mover_;
  Feeds& feeds_;
  Dwells& dwells_;
  Spindle& spindle_;
  CycleWords cycle_;
};

}  // namespace kerf::gcode
