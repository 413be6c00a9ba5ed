// How a program is to be read, as the command line tells it: --dialect and --strict of every command that
// reads one.
#pragma once

#include <string>

#include "app/command.h"
#include "app/input.h"

namespace kerf::app {

struct ReadingOptions {
  std::string dialect;  // empty: told by the text
  bool strict = false;
};
void add_reading_options(CLI::App& app, ReadingOptions& options);
void apply(const ReadingOptions& options, InputOptions& input);

}  // namespace kerf::app
