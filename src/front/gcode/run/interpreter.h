// The interpreter: executes lines in the modal state of a controller, by its parts.
//
// Words take effect in the order of LinuxCNC's interpreter and as it defines them. A line that LinuxCNC
// refuses but other controllers read is read as by those, with a diagnostic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "front/gcode/program/flow.h"
#include "front/gcode/program/parameters.h"
#include "front/gcode/run/calls.h"
#include "front/gcode/run/compensation.h"
#include "front/gcode/run/coordinates.h"
#include "front/gcode/run/corner_words.h"
#include "front/gcode/run/dwells.h"
#include "front/gcode/run/extruders.h"
#include "front/gcode/run/feeds.h"
#include "front/gcode/run/lathe_words.h"
#include "front/gcode/run/motion_words.h"
#include "front/gcode/run/mover.h"
#include "front/gcode/run/part.h"
#include "front/gcode/run/printer.h"
#include "front/gcode/run/program_comments.h"
#include "front/gcode/run/program_end.h"
#include "front/gcode/run/references.h"
#include "front/gcode/run/rotary_axes.h"
#include "front/gcode/run/settings.h"
#include "front/gcode/run/simple_lines.h"
#include "front/gcode/run/spindle.h"
#include "front/gcode/run/system_parameters.h"
#include "front/gcode/run/tool_diameters.h"
#include "front/gcode/run/tools.h"

namespace kerf::gcode {

class Interpreter {
 public:
  Interpreter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options,
              LineReporter& reporter);

  Parameters& parameters() { return parameters_; }
  /// Must be set before the first run().
  void set_flow(Flow& flow) { context_.flow = &flow; }

  /// Executes one line.
  void run(const Block& block);
  /// Fast path, see SimpleLines.
  std::size_t run_simple_lines(BlockReader& reader, std::size_t limit) {
    return simple_lines_.run(reader, limit);
  }
  /// Must be called after the last line.
  void finish();
  /// True after the end of the program, or at the limit of steps.
  bool done() const { return context_.steps.full() || end_.stopped(); }

 private:
  void execute();
  void execute_codes();
  void stop_by_variable(const Block& block);
  void end_or_pause();
  void pause(PauseKind kind);
  void run_large_m_code();
  void report_corner(const CornerWord& word);
  void end_program();

  SystemParameters system_;
  Parameters parameters_;
  Context context_;
  RotaryAxes rotary_;
  ToolDiameters diameters_;
  Coordinates coordinates_;
  CommentedBead beads_;
  ProgramComments comments_;
  Feeds feeds_;
  Mover mover_;
  Spindle spindle_;
  Dwells dwells_;
  Tools tools_;
  Compensation compensation_;
  CornerWords corners_;
  Extruders extruders_;
  Printer printer_;
  References references_;
  MotionWords motion_;
  Settings settings_;
  Calls calls_;
  ProgramEnd end_;
  LatheWords lathe_;
  SimpleLines simple_lines_;
};

}  // namespace kerf::gcode
