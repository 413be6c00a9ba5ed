// The option --printer.
#pragma once

#include <string>

#include "app/options/parser.h"
#include "job/load_printer.h"

namespace kerf::app {

/// --printer, as load_printer reads it.
Option add_printer_option(CommandParser& parser, std::string& text);

}  // namespace kerf::app
