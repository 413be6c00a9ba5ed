// The words of printers.
#pragma once

#include <string_view>

#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/extruders.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/program_comments.h"
#include "front/gcode/run/tools.h"

namespace kerf::gcode {

class Printer : Part {
 public:
  Printer(Context& context, Coordinates& coordinates, Mover& mover, Tools& tools, Extruders& extruders,
          const CommentedBead& beads, const ProgramComments& comments)
      : Part(context),
        coordinates_(coordinates),
        mover_(mover),
        tools_(tools),
        extruders_(extruders),
        beads_(beads),
        comments_(comments) {}

  /// At the start of a printer's program.
  void set_filament(std::string_view program);
  bool has_code();
  void run_code();
  void command(std::string_view text);
  /// G10, G28, G92.
  void use_reference();
  void run_to_end_switches();
  void extrude(const ToolPosition& to, double feed);
  void extrude_arc(const ArcWalk& walk, const ToolPosition& to, Feed feed);

 private:
  bool tool_offset_command(std::string_view text);
  bool zero_command(std::string_view text);
  void lose_by_offset(std::string_view code);
  void lose_by_free_motors(std::string_view text);
  void lose_by_macro(const std::string& name);
  void set_volumetric();
  bool filament_is_relative() const;

  Coordinates& coordinates_;
  Mover& mover_;
  Tools& tools_;
  Extruders& extruders_;
  const CommentedBead& beads_;
  const ProgramComments& comments_;
  double filament_diameter_ = 0.0;  // mm
  bool filament_relative_ = false;
  bool volumetric_ = false;  // M200: E is a volume
  bool laid_bead_ = false;
  bool extrudes_ = false;  // T words of such a program select extruders
};

}  // namespace kerf::gcode
