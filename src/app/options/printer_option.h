// The option --printer.
#pragma once

#include <optional>
#include <string>

#include "app/options/parser.h"

#include "kerf/printer_files.h"

namespace kerf::app {

Option add_printer_option(CommandParser& parser, std::string& text);
/// "NAME", "FILE.toml", each with ":FILAMENT" if wanted. Nothing, with errors, if it is unknown or invalid.
std::optional<PrinterChoice> read_printer_option(const std::string& text, Diagnostics& diagnostics);

}  // namespace kerf::app
