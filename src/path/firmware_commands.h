// What commands of printers' firmwares do that a program may have without a meaning for its toolpath.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kerf {

/// `unknown` may move the nozzle or change the zero or the tool. `harmless`: the parts are printed where and
/// as they would be without it, by the settings of the printer. `pause` waits for a person. `heat` heats a
/// heater or waits for it.
enum class CommandEffect : std::uint8_t { unknown, harmless, pause, heat };

struct FirmwareCommand {
  std::string name;       // "M862.3", "SET_PRESSURE_ADVANCE"
  std::string_view what;  // it concerns: "pressure advance"; empty for unknown ones
  CommandEffect effect = CommandEffect::unknown;
};

/// Whether a command may be a macro of the printer, which can do anything: a word that is not in the table.
bool is_macro(const FirmwareCommand& command);

/// The command of a line such as "M117 ready" or "RESPOND MSG=ready".
FirmwareCommand firmware_command(std::string_view line);

}  // namespace kerf
