// The reading options of the commands that have a program.
#pragma once

#include <string>
#include <vector>

#include "app/options/parser.h"

#include "kerf/job/program.h"

namespace kerf::app {

struct ReadingOptions {
  std::string dialect;                    // empty: determined from the text
  std::string arc_centres;                // empty: detected
  std::vector<std::string> compensation;  // "D1=0"
  bool read_on = false, strict = false;
  double filament = 0.0;              // mm; 0: from the program
  std::string measured, work_offset;  // file of measured heights, "X,Y,Z"
  double max_correction = 1.0;        // mm
  std::vector<std::string> defines, include_paths;
  std::string gcmc_version;  // empty: not stated
  PathDrawingOptions drawing;
};
/// The option --work-offset of commands that read measured heights.
void add_work_offset(CommandParser& parser, std::string& offset);
MeasuredOptions measured_options(const std::string& work_offset);
void add_reading_options(CommandParser& parser, ReadingOptions& options);
ProgramOptions read_reading_options(const ReadingOptions& options);

}  // namespace kerf::app
