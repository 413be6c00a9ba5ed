// The front end for OpenSCAD programs with the commands of gcodepreview: from a program to a toolpath, files,
// material and outlines.
//
//   ScadOptions options;
//   options.file_name = "part.scad";
//   ScadRun run = run_scad(text, options, diagnostics);
//
// echo() goes to ScadRun::output, in the form of OpenSCAD's messages. `use <gcodepreview.py>` and
// `include <gcodepreview.scad>` load nothing: the commands are built in. Intended differences from the real
// program: docs/differences.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/scad/value/scad_limits.h"

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/progress.h"
#include "kerf/geom/region.h"
#include "kerf/stock/stock.h"

namespace kerf {

namespace scad {
struct CommandSet;
}

struct ScadOptions {
  std::string file_name = "part.scad";     // for messages and origins
  std::vector<std::string> include_paths;  // searched after the folder of the including file
  std::vector<std::string> defines;        // assignments that replace those of the text: "depth=5"
  /// The built-in commands and what they share; null: none.
  const scad::CommandSet* commands = nullptr;

  std::size_t max_memory = limits::kMaxScriptMemory;  // bytes of strings and vectors
  std::uint64_t max_steps = limits::kMaxScadSteps;    // calls and passes of loops
  std::size_t max_stack = limits::kMaxScadStack;      // bytes, for calls that are not last in their function
  std::size_t max_range = limits::kMaxScadRange;      // values of a range in a loop
  std::uint64_t max_output = limits::kMaxScadOutput;  // bytes of echo()

  /// Is called with each line of ScadRun::output while the program runs; may be empty.
  std::function<void(const TextLocation&, std::string_view)> printed = {};
};

/// A parameter for the user: an assignment with the comments around it, as OpenSCAD's customizer reads them.
struct ScadParameter {
  std::string name, value, group, description;
  std::string choices;  // the comment after it: "[10:500]", "[Top, Bottom]"
  std::uint32_t line = 0;
};

struct ScadRun {
  std::string output;              // of echo(), a line each
  std::optional<Stock> material;   // the solids of the top level
  std::optional<Region> area;      // the areas of the top level
  std::vector<std::string> files;  // read besides the program: included and used ones
  std::vector<ScadParameter> parameters;
  bool stopped = false;  // by Progress::stop_requested
};

/// The functions and modules of the language, for editors.
std::vector<std::string> scad_names();
/// Parses and runs a program. With a syntax error it does not run; after an error that ends it, the output
/// ends there.
ScadRun run_scad(std::string_view text, const ScadOptions& options, Diagnostics& diagnostics,
                 Progress* progress = nullptr);

/// Values of a set of a customizer's JSON file as assignments, for ScadOptions::defines. The set's texts are
/// numbers, booleans and vectors as they are; others become strings.
std::vector<std::string> read_parameter_set(std::string_view json, const std::string& file,
                                            const std::string& set, Diagnostics& diagnostics);

}  // namespace kerf
