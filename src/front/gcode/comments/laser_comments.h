// Comments of programs for lasers on controllers with the firmware of a printer.
#pragma once

#include <string_view>

namespace kerf::gcode {

/// Whether the start of a program for a laser names a firmware of printers, whose G4 P is in milliseconds:
/// "; Marlin device profile" (LightBurn), "; Kerf 0.2.0, marlin for a laser".
bool is_for_printer_firmware(std::string_view text);

}  // namespace kerf::gcode
