// Printers by name or from files, as --printer has them.
#pragma once

#include <optional>
#include <string>

#include "kerf/base/diagnostics.h"
#include "kerf/formats/printer_files.h"

namespace kerf {

/// "NAME", "FILE.toml", each with ":FILAMENT" if wanted. Nothing, with errors, if it is unknown or invalid.
std::optional<PrinterChoice> load_printer(const std::string& text, Diagnostics& diagnostics);

}  // namespace kerf
