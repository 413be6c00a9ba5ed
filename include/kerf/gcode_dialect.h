// Dialects of G-code: their names, and the detection of a program's dialect from its text.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// The controller that a program is written for, where that changes the meaning of its words.
enum class GcodeDialect : unsigned char {
  rs274,    // LinuxCNC, and what all milling controllers have in common
  grbl,     // GRBL and grblHAL: as rs274, streamed line by line
  mach3,    // scaling (G51) and rotation (G68)
  fanuc,    // O-numbered programs, M98, M99
  laser,    // GRBL with a laser: M3 and M4 switch the beam, S is its power on each line
  marlin,   // printers: E, heaters, fans; G4 P in milliseconds
  klipper,  // as marlin, with commands in words
  reprap,   // RepRapFirmware: as marlin, speeds of M203 and M566 in mm/min, fans from 0 to 1
};
/// Whether the controller is that of a printer.
constexpr bool is_printer(GcodeDialect dialect) { return dialect >= GcodeDialect::marlin; }
std::string_view to_string(GcodeDialect dialect);
/// The dialect of a name such as "linuxcnc", "GRBL", "grblhal", "Mach3"; nothing for an unknown name.
std::optional<GcodeDialect> dialect_named(std::string_view name);
/// Every name that dialect_named accepts, for messages.
const std::vector<std::string>& dialect_names();

/// The dialect detected from comments and words; rs274 without evidence.
struct DialectGuess {
  GcodeDialect dialect = GcodeDialect::rs274;
  std::string from = {};   // the evidence, for a message: "M104 in line 3 and E in line 20"
  std::uint32_t line = 0;  // the first line with evidence
};
DialectGuess guess_dialect(std::string_view text);

/// A program in the language of a control that is not supported, such as Heidenhain's.
struct ForeignProgram {
  std::string_view control, word;  // `word`, without blanks, gives it away
  std::uint32_t line = 0;
};
std::optional<ForeignProgram> find_foreign_language(std::string_view text);

}  // namespace kerf
