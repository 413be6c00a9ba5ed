// G2 and G3.
#pragma once

#include <optional>

#include "front/gcode/run/compensation.h"
#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/printer.h"

namespace kerf::gcode {

class Arcs : Part {
 public:
  Arcs(Context& context, const Coordinates& coordinates, Mover& mover, Feeds& feeds,
       Compensation& compensation, Printer& printer)
      : Part(context),
        coordinates_(coordinates),
        mover_(mover),
        feeds_(feeds),
        compensation_(compensation),
        printer_(printer) {}

  void arc(Turn turn);

 private:
  void use_idle_offset();
  void as_chords(Turn turn);
  std::optional<Point2> centre_of(const ProgramFrame& frame, const ToolPosition& to, Turn turn);
  std::optional<Point2> centre_from_offsets(const ProgramFrame& frame, const ToolPosition& to);
  std::optional<Point2> centre_from_radius(const ProgramFrame& frame, const ToolPosition& to, Turn turn);
  bool radii_agree(const ToolPosition& to, Point2 centre);
  bool refuse_after_compensation();
  int extra_turns();
  void note_evidence(const ToolPosition& to, Point2 words);

  const Coordinates& coordinates_;
  Mover& mover_;
  Feeds& feeds_;
  Compensation& compensation_;
  Printer& printer_;
};

}  // namespace kerf::gcode
