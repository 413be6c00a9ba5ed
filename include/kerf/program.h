// Programs from files: any input that describes work becomes a Program, whichever front end reads it.
//
//   Diagnostics diagnostics;
//   std::optional<Program> program = load_program("part.gcmc", {.defines = {"depth=5mm"}}, diagnostics);
//
// The file name's ending selects the front end; where it is unknown, the text does. A new front end is one
// file in src/job that makes a FrontEnd, and a line in program.cpp.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/check.h"
#include "kerf/diagnostics.h"
#include "kerf/files.h"
#include "kerf/gcode.h"
#include "kerf/machine.h"
#include "kerf/outline_files.h"
#include "kerf/progress.h"
#include "kerf/stock.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"

namespace kerf {

enum class ProgramUnits { mm, inch };

/// A toolpath with what its file says about units, tools and stock.
struct Program {
  std::string source;     // the file's name as given
  std::string front_end;  // "G-code"
  Toolpath path;
  ProgramUnits units = ProgramUnits::mm;  // of the program's text; the toolpath is always in mm
  std::map<int, Tool> tools;              // those described in the program itself
  std::optional<Stock> stock;             // where the program itself describes it
  ProgramEnd end = ProgramEnd::not_asked;
  std::vector<std::string> files;  // all files read: `source`, then included, called and imported ones
};

/// How a program is read. Options that a front end has no use for are ignored.
struct ProgramOptions {
  std::optional<Machine> machine = {};           // the one that is to run the program, if known
  std::optional<GcodeDialect> dialect = {};      // of G-code; nothing: determined from the text
  bool read_on = false;                          // past the end of a G-code program
  bool strict = false;                           // unusual G-code words are errors
  std::optional<double> filament_diameter = {};  // mm, of a printer; nothing: from the program
  decltype(GcodeReadOptions::tool_diameter) tool_diameter = {};  // for cutter compensation
  std::vector<std::string> defines = {};        // gcmc statements that run first: "depth=5mm"
  std::vector<std::string> include_paths = {};  // folders searched for included files after the program's own
};

/// A way to read files. `endings` are in lower case with their dot.
struct FrontEnd {
  std::string_view name;
  std::vector<std::string_view> endings;
  bool (*looks_like)(std::string_view text);  // of the first few kB of a file with an unknown ending
  Program (*read)(const InputFile& file, const ProgramOptions& options, Diagnostics& diagnostics,
                  Progress* progress);
};
/// Every front end, in the order in which `looks_like` is asked.
const std::vector<FrontEnd>& front_ends();
/// ".nc .ngc ..." of every front end, for help texts.
std::string known_endings();

/// Reads the program in a file ("-": standard input, as G-code). A program with errors is returned as far as
/// it was understood; nothing is returned where the file cannot be read or no front end recognizes it.
std::optional<Program> load_program(const std::string& file, const ProgramOptions& options,
                                    Diagnostics& diagnostics, Progress* progress = nullptr);

/// Reads outlines: a JSON file (kerf/outline_files.h), or a Python script (.py), which is run and whose
/// outlines are those passed to cnc25d_api.cnc_cut_outline(). With errors the result may be incomplete.
std::vector<NamedOutline> load_outlines(const std::string& file, Diagnostics& diagnostics);

}  // namespace kerf
