// The options of `kerf adjustz`: those of PathGCodeAdjustZ, and long names beside them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/units.h"

namespace kerf::app {

struct AdjustzCommandLine {
  Length max_correction;                             // /m
  std::optional<std::string> shown_lines;            // /x: lines of the program that match this expression
  std::string measured;                              // file with measured positions
  std::optional<std::array<double, 3>> work_offset;  // of machine coordinates in it
  Language language = Language::english;
  std::vector<std::string> files;
  bool help = false;
  Diagnostics problems;  // of the command line
};

AdjustzCommandLine parse_adjustz_options(const std::vector<std::string>& arguments);
/// What /h prints.
std::string adjustz_usage(Language language);
/// "X,Y,Z" as three numbers.
std::optional<std::array<double, 3>> parse_offset(std::string_view text);

}  // namespace kerf::app
