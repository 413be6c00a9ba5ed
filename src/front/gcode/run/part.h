// What the parts of the interpreter have in common: the line that is executed, the modal state, the steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "front/gcode/program/flow.h"
#include "front/gcode/program/line_words.h"
#include "front/gcode/program/parameters.h"
#include "front/gcode/run/modes.h"

#include "kerf/program/gcode.h"

namespace kerf::gcode {

/// Adds steps to the program's path, up to a limit, each with the line that it is from.
class StepWriter {
 public:
  StepWriter(GcodeProgram& program, std::string_view text, const GcodeReadOptions& options,
             const LineWords& line, LineReporter& reporter);

  /// False at the limit of steps.
  template <class S>
  bool add(const S& step) {
    if (path_.size() >= max_steps_ && !room_for(1.0)) return false;
    path_.add(step, origin());
    return true;
  }
  /// Whether `steps` more are within the limit; otherwise the program ends here, with an error.
  bool room_for(double steps);
  bool has_room() const { return path_.size() < max_steps_; }
  bool full() const { return full_; }
  /// The origin of the steps of the present line.
  void start_origin(std::uint32_t column);
  /// The same, outside of subroutines.
  OriginId start_line(std::uint32_t line, std::uint32_t column) {
    origin_line_ = line;
    origin_ = path_.origins().text(file_, line, column);
    return origin_;
  }
  /// The last line has called a subroutine, or returned from one.
  void note_depth(std::size_t depth);
  void in_file(const std::string& name) { file_ = path_.origins().file(name); }

 private:
  OriginId origin();

  Toolpath& path_;
  const LineWords& line_;
  LineReporter& reporter_;
  std::size_t max_steps_;
  std::uint32_t file_;
  std::uint32_t origin_line_ = 0;  // the line of origin_
  OriginId origin_ = OriginId::none;
  std::vector<OriginId> callers_;  // the lines of the calls that are being executed
  bool full_ = false;
};

struct Context {
  Context(GcodeProgram& to, std::string_view text, const GcodeReadOptions& given, LineReporter& reports,
          Parameters& numbers)
      : program(to),
        options(given),
        reporter(reports),
        parameters(numbers),
        steps(to, text, given, line, reports) {}

  GcodeProgram& program;
  const GcodeReadOptions& options;
  LineReporter& reporter;
  Parameters& parameters;
  Flow* flow = nullptr;
  LineWords line;
  Modes modes;
  ToolPosition position;
  bool moved = false;  // the program has had a motion
  StepWriter steps;
};

/// A part of the interpreter: it executes words of one kind and owns the state that they alone change.
class Part {
 protected:
  explicit Part(Context& c)
      : program_(c.program),
        path_(c.program.path),
        options_(c.options),
        reporter_(c.reporter),
        parameters_(c.parameters),
        flow_(c.flow),
        line_(c.line),
        modes_(c.modes),
        position_(c.position),
        moved_(c.moved),
        steps_(c.steps) {}

  bool is_printer() const { return kerf::is_printer(program_.dialect); }
  template <class S>
  bool add(const S& step) {
    return steps_.add(step);
  }
  bool room_for(double steps) { return steps_.room_for(steps); }
  /// False with an error for a position that is too far away; the line is skipped then.
  bool reachable(Point3 p);
  void report_unresolved(std::string_view what, std::uint32_t column);
  /// The coordinates of a point in the plane in force, and the point moved to others of them.
  Point2 in_plane(Point3 p) const;
  Point3 with_plane_position(Point3 p, Point2 to) const;

  GcodeProgram& program_;
  Toolpath& path_;
  const GcodeReadOptions& options_;
  LineReporter& reporter_;
  Parameters& parameters_;
  Flow*& flow_;
  LineWords& line_;
  Modes& modes_;
  ToolPosition& position_;
  bool& moved_;
  StepWriter& steps_;
};

}  // namespace kerf::gcode
