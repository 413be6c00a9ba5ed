// The commands of gcodepreview for OpenSCAD programs: their table, what a run of them shares, and its result.
//
//   const std::unique_ptr<CommandState> state = make_state({.tools = &built_in_tools()});
//   // the interpreter runs a program with {&commands(), state.get()}
//   CommandResult result = finish(*state, diagnostics);
//
// Front ends neither simulate nor write G-code, nor do they use each other: what commands need of that is in
// CommandOptions, and programs to be written are in the result. A command that needs an option that is not
// set is an error.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "front/scad/commands/scad_output.h"
#include "front/scad/value/command.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf::scad {

/// The result of reading a program for previewgcodefile().
struct ReadProgram {
  Toolpath path;
  std::map<int, Tool> tools;
  std::optional<Stock> stock;
};

/// The cuts of the first side of a part, for flipstock().
struct CutSide {
  const Toolpath& path;
  const Stock& stock;
  const ToolTable& tools;
  Length resolution;  // 0: by the size of the stock
};

struct CommandOptions {
  const ToolTable* tools = nullptr;  // the built-in ones
  std::function<std::optional<Stock>(const std::string& file, Diagnostics&)> load_stock = {};
  std::function<std::optional<ReadProgram>(const std::string& file, Diagnostics&)> read_program = {};
  std::function<std::optional<Stock>(const CutSide& side, Diagnostics&)> left_stock = {};
  Progress* progress = nullptr;
};

struct CommandResult {
  Toolpath path;
  std::map<int, Tool> tools;  // the program's own
  std::optional<Stock> stock;
  Length resolution;   // of a simulation; 0: by the size of the stock
  bool shown = false;  // the program asked for the part: stockandtoolpaths()
  std::vector<ScadFile> files;
  std::vector<ScadProgram> programs;
};

const std::vector<Command>& commands();
/// A command as "name(first, second=1)", as in the manual.
std::string signature_of(const Command& command);
std::unique_ptr<CommandState> make_state(const CommandOptions& options);
/// Ends a run. Files that were opened and not closed are not written, with a warning.
CommandResult finish(CommandState& state, Diagnostics& diagnostics);

}  // namespace kerf::scad
