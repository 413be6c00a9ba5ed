// The way in: any file that describes work becomes a LoadedProgram. Which front end reads it is told by the
// file's ending; a new front end is one file that makes a FrontEnd, and a line in input.cpp.
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
#include "kerf/progress.h"
#include "kerf/stock.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"

namespace kerf {

enum class InputUnits { mm, inch };

struct LoadedProgram {
  std::string source;     // the file's name as the user told it
  std::string front_end;  // "G-code"
  Toolpath path;
  InputUnits units = InputUnits::mm;  // of the program's text; the toolpath is always in mm
  std::map<int, Tool> tools;          // those that the program itself describes
  std::optional<Stock> stock;         // where the program itself describes it
  ProgramEnd end = ProgramEnd::not_asked;
};

/// What the reader of a program is told besides the file.
struct InputOptions {
  std::optional<Machine> machine;           // the one that is to run the program, where it is known
  std::optional<GcodeDialect> dialect;      // of G-code; nothing: told by the text
  bool read_on = false;                     // behind the end of a G-code program
  bool strict = false;                      // what is unusual in G-code is an error
  std::optional<double> filament_diameter;  // mm, of a printer; nothing: told by the program
  decltype(GcodeReadOptions::tool_diameter) tool_diameter;  // for cutter compensation
};

/// A way to read files. `endings` are in lower case with their dot.
struct FrontEnd {
  std::string_view name;
  std::vector<std::string_view> endings;
  bool (*looks_like)(std::string_view beginning);
  LoadedProgram (*read)(const InputFile& file, const InputOptions& options, Diagnostics& diagnostics,
                        Progress* progress);
};
FrontEnd gcode_front_end();
FrontEnd gcmc_front_end();

/// Reads the program of a file ("-": standard input, as G-code). What was understood is returned with the
/// errors in `diagnostics`; nothing is returned where there is nothing to read or no front end for it.
std::optional<LoadedProgram> load_program(const std::string& path, Diagnostics& diagnostics,
                                          Progress* progress, const InputOptions& options = {});

/// The folder of a file with its last slash; nothing for the current one.
std::string folder_of(const std::string& file);

/// ".nc .ngc ..." of every front end, for the help.
std::string known_endings();

}  // namespace kerf
