// Programs from files: every front end returns a Program.
//
//   Diagnostics diagnostics;
//   std::optional<Program> program = load_program("part.gcmc", {.defines = {"depth=5mm"}}, diagnostics);
//
// The front end is selected by the ending of the file name, or by the text if that is unknown. A new front
// end is one file in src/job that defines a FrontEnd, and a line in program.cpp.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/files.h"
#include "kerf/base/progress.h"
#include "kerf/drawing/outline_files.h"
#include "kerf/formats/measured.h"
#include "kerf/job/program_file.h"
#include "kerf/path/machine.h"
#include "kerf/program/gcode.h"
#include "kerf/program/path_drawing.h"

namespace kerf {

/// Measured heights for programs whose heights depend on them.
struct MeasuredSettings {
  std::string file;               // kerf/formats/measured.h; empty: heights keep their formulas
  Length max_correction = mm(1);  // larger deviations from the expected heights are errors
  MeasuredOptions reading = {};
};

/// Cutter compensation with a tool of unknown diameter: an error, or a warning and an assumed diameter.
enum class UnknownDiameter { error, assume };

/// How a program is read. An option that a front end does not read is an error (FrontEnd::reads).
struct ProgramOptions {
  std::optional<Machine> machine = {};           // that will run the program, if known
  std::optional<GcodeDialect> dialect = {};      // of G-code; nothing: determined from the text
  bool read_on = false;                          // past the end of a G-code program
  bool strict = false;                           // unusual G-code words are errors
  std::optional<double> filament_diameter = {};  // mm, of a printer; nothing: from the program
  ArcCentres arc_centres = ArcCentres::detect;   // of G-code
  decltype(GcodeReadOptions::tool_diameter) tool_diameter = {};  // for cutter compensation
  std::map<int, double> compensation_radii = {};                 // mm, by D; GcodeReadOptions
  std::vector<std::string> defines = {};  // gcmc statements that run first: "depth=5mm"
  std::string gcmc_version = {};          // whose arcs and angles it expects, 1.8 or 1.9; empty: none stated
  MeasuredSettings measured = {};
  UnknownDiameter unknown_diameter = UnknownDiameter::error;
  PathDrawingOptions drawing = {};
  std::vector<std::string> include_paths = {};  // folders searched for included files after the program's own
  /// Is called with each line that the program itself prints while it runs, its location first: message() of
  /// gcmc, echo() of OpenSCAD. Empty: they are dropped.
  std::function<void(std::string_view)> printed = {};
};

/// Options that have a meaning for programs of some kinds only.
enum class OptionGroup { define, drawing, gcmc, gcode };

/// A reader of programs. `endings` are in lower case with their dot.
struct FrontEnd {
  std::string_view name;
  std::vector<std::string_view> endings;
  bool (*looks_like)(std::string_view text);  // of the first few kB of a file with an unknown ending
  Program (*read)(const InputFile& file, const ProgramOptions& options, Diagnostics& diagnostics,
                  Progress* progress);
  std::vector<OptionGroup> reads = {};  // other options of a command line are errors
};
/// Every front end, in the order in which `looks_like` is called.
const std::vector<FrontEnd>& front_ends();
/// ".nc .ngc ..." of every front end, for help texts.
std::string known_endings();

/// Reads the program in a file ("-": standard input, as G-code). A program with errors is returned as far as
/// it could be read; nothing if the file cannot be read or is not recognised by a front end.
std::optional<Program> load_program(const std::string& file, const ProgramOptions& options,
                                    Diagnostics& diagnostics, Progress* progress = nullptr);

/// The same of a file that is open, or of a text that is not saved yet.
std::optional<Program> load_program(const InputFile& file, const ProgramOptions& options,
                                    Diagnostics& diagnostics, Progress* progress = nullptr);

/// Reads outlines: a JSON file (kerf/drawing/outline_files.h), or a Python script (.py), which is run and
/// whose outlines are those passed to cnc25d_api.cnc_cut_outline(). With errors the result may be incomplete.
std::vector<NamedOutline> load_outlines(const std::string& file, Diagnostics& diagnostics);

}  // namespace kerf
