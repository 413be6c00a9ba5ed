// ",R5" and ",C5" of Fanuc and Haas: an arc or a chamfer between two straight cuts.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "front/gcode/run/compensation.h"
#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"

namespace kerf::gcode {

/// A cut with such a word is held back until the next cut is known, because the corner shortens both.
/// Meanwhile the position is the programmed end point.
class CornerWords : Part {
 public:
  CornerWords(Context& context, const Coordinates& coordinates, Mover& mover, Compensation& compensation)
      : Part(context), coordinates_(coordinates), mover_(mover), compensation_(compensation) {}

  bool is_holding() const { return held_.has_value(); }
  /// Holds the line's cut back if the line has such a word.
  bool hold(const ToolPosition& to, double feed);
  /// Adds the cut that is held back, and the corner, before a cut to `to`.
  void turn_to(const ToolPosition& to);
  /// Before a line that cannot continue the corner: adds the cut that is held back, with an error.
  void finish_before_line();
  void finish();

 private:
  struct Held {
    ToolPosition from, to;
    double size = 0.0;  // mm
    bool is_round = false;
    double feed = 0.0;
    unsigned named = 0;
    std::uint32_t line = 0, column = 0;
  };
  /// The corner between two lines: its ends, and the centre of the arc.
  struct Shape {
    Point2 start, end, centre;
    bool to_left = false;
  };

  std::optional<Shape> shape(const Held& held, const ToolPosition& next);
  std::string_view why_not(const Held& held, const ToolPosition& next) const;
  void add_corner(const Held& held, const Shape& corner);
  void add_cut(const ToolPosition& to, double feed);
  void report(const Held& held, std::string_view why);
  void release(const ToolPosition* next);

  const Coordinates& coordinates_;
  Mover& mover_;
  Compensation& compensation_;
  std::optional<Held> held_;
};

}  // namespace kerf::gcode
