// Firmwares of printers: the one table of their names, the language that each reads, and the settings of
// slicers that name it. A new firmware is a row here and a profile of its name in posts/.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace kerf {

enum class PrinterLanguage : std::uint8_t { marlin, klipper, reprap };

struct PrinterFirmware {
  std::string_view name;  ///< of its post
  PrinterLanguage language;
  /// Values of "gcode_flavor" (PrusaSlicer, SuperSlicer, OrcaSlicer) and of ";FLAVOR:" (Cura), as fold_name()
  /// writes them. The same word means different firmwares: "reprap" is Sprinter in the first.
  std::vector<std::string_view> gcode_flavor, flavor;
};

/// Sources: the manuals of PrusaSlicer ("G-code flavor") and Cura ("G-code flavor" of the machine settings).
std::span<const PrinterFirmware> printer_firmwares();

/// The firmware that a setting of a slicer names; null where there is none. `text` is the value as written.
const PrinterFirmware* firmware_of_gcode_flavor(std::string_view text);
const PrinterFirmware* firmware_of_flavor(std::string_view text);

}  // namespace kerf
