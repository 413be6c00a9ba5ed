// Fast path for lines of G0 or G1, axis words and F.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "front/gcode/run/calls.h"
#include "front/gcode/run/compensation.h"
#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/corner_words.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/program_end.h"
#include "front/gcode/run/rotary_axes.h"

namespace kerf::gcode {

class SimpleLines : Part {
 public:
  SimpleLines(Context& context, const Coordinates& coordinates, const RotaryAxes& rotary, Mover& mover,
              Feeds& feeds, const Compensation& compensation, const CornerWords& corners, const Calls& calls,
              ProgramEnd& end)
      : Part(context),
        coordinates_(coordinates),
        rotary_(rotary),
        mover_(mover),
        feeds_(feeds),
        compensation_(compensation),
        corners_(corners),
        calls_(calls),
        end_(end) {}

  /// Executes lines of nothing but G0 or G1, axis words and F, at most `limit` of them, with the same result
  /// as the interpreter. Stops before any other line. Returns the number of lines.
  std::size_t run(BlockReader& reader, std::size_t limit);

 private:
  bool accepts() const;
  bool run_line(std::string_view text, std::uint32_t number);

  const Coordinates& coordinates_;
  const RotaryAxes& rotary_;
  Mover& mover_;
  Feeds& feeds_;
  const Compensation& compensation_;
  const CornerWords& corners_;
  const Calls& calls_;
  ProgramEnd& end_;
};

}  // namespace kerf::gcode
