// The options of `kerf gcmc`, parsed as by getopt_long: combined letters, values after '=', unique prefixes.
#pragma once

#include <string>
#include <vector>

#include "back/drawing/gcmc_drawing.h"
#include "front/gcmc/gcmc.h"

namespace kerf::app {

struct GcmcCommandLine {
  GcmcOptions run;
  GcmcDrawingOptions drawing;
  std::string input;   // empty: standard input
  std::string output;  // empty: standard output
  std::string prologue_file, epilogue_file;
  bool warnings_are_errors = false;
  bool help = false, version = false;
  // Kerf's own
  bool check = false, json = false, explain = false;
  std::vector<std::string> errors;  // of the command line, in the order found
};

GcmcCommandLine parse_gcmc_options(const std::vector<std::string>& arguments);
/// What -h prints.
std::string gcmc_usage();

}  // namespace kerf::app
