// Programs, toolpaths, tools and stock as bytes, without loss: .kerf files, and copies for other processes.
//
//   std::string bytes = write_program(program);
//   std::optional<Program> again = read_program(bytes, "part.kerf", diagnostics);
//
// What is read equals what was written, member by member, and writes the same bytes again.
// docs/decisions/0049-program-file.md describes the format. A newer version, another content and damage are
// one error each. What a file can make of memory is in proportion to its size: about 400 bytes per byte.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"
#include "kerf/formats/measured.h"
#include "kerf/path/check.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/simulate.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

// A program: a toolpath with all that its file specifies beside it.
//
// Front ends make programs (kerf/job/program.h), passes change them, jobs simulate and posts write them.
// Every member is stored in a .kerf file (kerf/job/program_file.h).

enum class ProgramUnits { mm, inch };

/// Where the tools of a program come from: comments, which may be incomplete or contradict the table (see
/// choose_tool), or the tools themselves, which precede tables.
enum class ToolsOfProgram : std::uint8_t { described, whole };

/// A toolpath with the units, tools and stock specified in its file.
struct Program {
  std::string source;     // the file's name as given
  std::string front_end;  // "G-code"
  Toolpath path;
  ProgramUnits units = ProgramUnits::mm;  // of the program's text; the toolpath is always in mm
  std::map<int, Tool> tools;              // those described in the program itself
  ToolsOfProgram tools_are = ToolsOfProgram::described;
  ToolTable tools_beside;                   // LinuxCNC's tool.tbl in its folder, for G-code of that dialect
  std::optional<Stock> stock;               // if described in the program itself
  std::optional<RoundBar> bar;              // instead of the stock: turned by a fourth axis
  std::vector<Fixture> fixtures;            // that the program itself names
  Length spoilboard;                        // thickness of the board below the stock that may be cut into
  std::optional<double> filament_diameter;  // mm, of a printer's program
  std::optional<double> filament_density;   // g/cm3, by its comments
  bool units_given = true;                  // the program itself says that it is in mm or inches
  ProgramEnd end = ProgramEnd::not_asked;
  bool manual_spindle = false;             // inputs of its kind have no means to start the spindle
  std::vector<HeightTarget> probes;        // points whose heights correct the program's
  std::optional<double> assumed_diameter;  // mm, of cutter compensation, see UnknownDiameter
  bool states_tool_lengths = false;        // the program itself says where a tool's length takes effect (G43)
  std::vector<std::string> files;  // all files read: `source`, then included, called and imported ones
};

/// Whether bytes start as all files of this format do.
bool is_program_file(std::string_view bytes);

// Each reader returns nothing, with an error under the file's name, for other bytes than those of its writer.
std::string write_program(const Program& program);
std::optional<Program> read_program(std::string_view bytes, const std::string& name,
                                    Diagnostics& diagnostics);
std::string write_toolpath(const Toolpath& path);
std::optional<Toolpath> read_toolpath(std::string_view bytes, const std::string& name,
                                      Diagnostics& diagnostics);
std::string write_tool(const Tool& tool);
std::optional<Tool> read_tool(std::string_view bytes, const std::string& name, Diagnostics& diagnostics);
std::string write_stock(const Stock& stock);
std::optional<Stock> read_stock(std::string_view bytes, const std::string& name, Diagnostics& diagnostics);

}  // namespace kerf
