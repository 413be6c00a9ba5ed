// The words of a printer's command: "S200 T1", "EXTRUDER=extruder1".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::gcode {

struct CommandWord {
  std::string name;  // folded: "x", "accel"
  double value = 0.0;
};

/// The words after the command; nothing if one is no number from 0.
std::optional<std::vector<CommandWord>> command_words(std::string_view text, bool with_names);
/// The value of a word, if it is among them.
std::optional<double> value_of(const std::vector<CommandWord>& words, std::string_view name);
/// "M220" and " S50" of "M220 S50".
struct CommandParts {
  std::string name;  // folded: "m220"
  std::string_view rest;
};
CommandParts command_parts(std::string_view command);
/// Whether a line of the program extrudes filament: G0 to G3 with an E word.
bool extrudes(std::string_view program);

}  // namespace kerf::gcode
