// kerf run of an OpenSCAD program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options/parser.h"
#include "app/report/console.h"
#include "app/report/status.h"
#include "job/scad_job.h"

#include "kerf/base/files.h"
#include "kerf/base/units.h"
#include "kerf/job/job.h"
#include "kerf/job/outputs.h"

namespace kerf::app {

struct ScadCommand {
  std::string file;
  std::vector<std::string> outputs;  // of -o
  ProgramOptions program;            // values of variables, folders of included files
  ScadParameterSet parameters;
  std::optional<Length> mesh_tolerance;
  std::vector<Option> mesh_options;  // without effect where no mesh is written
  bool list_parameters = false;      // print the parameters and write nothing
};

/// Writes the part of a program into `set`; its hazards go to `findings`. A resolution of 0 is that of the
/// stock's size.
bool write_part_of(Program program, Length resolution, const std::vector<PartFile>& files,
                   const PartFileOptions& options, OutputSet& set, std::vector<Finding>& findings,
                   Diagnostics& diagnostics, Progress& progress);

/// Prints what the program echoes; writes its files and the part that it shows, all of them or none.
Status run_scad(Console& console, const ScadCommand& command);

}  // namespace kerf::app
