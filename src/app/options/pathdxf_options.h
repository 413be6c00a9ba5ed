// The options of `kerf pathdxf`: those of PathDxf2GCode, /f150, /f 150 or -f 150, and long names beside them.
#pragma once

#include <string>
#include <vector>

#include "app/options/parser.h"
#include "front/pathdxf/pathdxf.h"

#include "kerf/base/diagnostics.h"

namespace kerf::app {

struct PathdxfCommandLine {
  PathdxfOptions run;
  std::vector<std::string> files;
  std::string sheet;   // --svg: file of the sheet for the workshop
  std::string output;  // --output: the only file of the run; "-": standard output
  bool help = false;
  bool explain = false;  // hints and notes with the messages
  Diagnostics problems;  // of the command line
};

PathdxfCommandLine parse_pathdxf_options(const std::vector<std::string>& arguments);
/// Adds those of these options that change what is milled, by their long names, to a command that reads
/// programs.
void add_drawing_options(CommandParser& parser, PathDrawingOptions& out);
std::vector<OptionDescription> pathdxf_option_descriptions();
/// What /h prints.
std::string pathdxf_usage(Language language);

}  // namespace kerf::app
