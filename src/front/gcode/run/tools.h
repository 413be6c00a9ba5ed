// Tool changes and tool lengths.
#pragma once

#include <optional>

#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/program_comments.h"
#include "front/gcode/run/spindle.h"

namespace kerf::gcode {

class Tools : Part {
 public:
  Tools(Context& context, Coordinates& coordinates, Spindle& spindle, ProgramComments& comments)
      : Part(context), coordinates_(coordinates), spindle_(spindle), comments_(comments) {}

  /// T.
  void select();
  /// M6, M61.
  void change();
  void change_at_pause();
  void set_length();
  /// Whether the length in force is one of the controller's table.
  bool length_is_of_table() const { return length_ && length_->kind == ToolLengthKind::table; }

 private:
  Coordinates& coordinates_;
  Spindle& spindle_;
  ProgramComments& comments_;
  std::optional<step::ToolLength> length_;
  std::optional<int> length_tool_;  // in the spindle when it was set
};

}  // namespace kerf::gcode
