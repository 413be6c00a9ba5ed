// How a program is to be read, as the command line tells it: --dialect, --read-on and --strict of every
// command that reads one.
#pragma once

#include <string>

#include "app/options/command.h"

#include "kerf/program.h"

namespace kerf::app {

struct ReadingOptions {
  std::string dialect;  // empty: told by the text
  bool read_on = false, strict = false;
  double filament = 0.0;  // mm; 0: told by the program
};
void add_reading_options(CommandParser& parser, ReadingOptions& options);
void apply(const ReadingOptions& options, InputOptions& input);

}  // namespace kerf::app
