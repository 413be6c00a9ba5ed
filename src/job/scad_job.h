// An OpenSCAD program with all that it makes: what `kerf run part.scad` prints and writes, and the Program
// that other commands read from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/machine/outputs.h"
#include "front/scad/scad.h"

#include "kerf/base/files.h"
#include "kerf/job/program.h"

namespace kerf {

struct ScadJob {
  Program program;
  std::vector<DesignFile> files;          // without G-code
  std::vector<DesignProgram> programs;    // G-code files
  bool shown = false;                     // the program asks for its part: stockandtoolpaths()
  Length resolution;                      // of the simulation; 0: by the size of the stock
  std::string output;                     // of echo(), a line each
  std::vector<ScadParameter> parameters;  // for the user
  std::optional<Region> area;             // the areas of the top level
};

/// Values of a program's parameters besides ProgramOptions::defines, which precede them.
struct ScadParameterSet {
  std::string file, name;  // a file of sets in JSON, and the set; both empty: none
};

/// Runs the program in a file. Its errors are in `diagnostics`; the result goes as far as it ran.
ScadJob run_scad_file(const InputFile& file, const ProgramOptions& options, const ScadParameterSet& set,
                      Diagnostics& diagnostics, Progress* progress = nullptr);

/// All files of a program, its G-code posted. Nothing, with errors, if a post refuses a toolpath.
std::optional<std::vector<DesignFile>> scad_files(const ScadJob& job, Diagnostics& diagnostics,
                                                  Progress* progress = nullptr);

/// Whether a file name is that of an OpenSCAD program.
bool is_scad_name(std::string_view file);

}  // namespace kerf
