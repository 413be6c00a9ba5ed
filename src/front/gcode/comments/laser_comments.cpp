// The firmware that the first comments of a program for a laser name.
#include "front/gcode/comments/laser_comments.h"

#include "base/names.h"
#include "path/own_header.h"
#include "path/printer_firmware.h"

namespace kerf::gcode {

bool is_for_printer_firmware(std::string_view text) {
  constexpr std::size_t kStart = 4096;  // bytes; the header is at the start of the file
  const std::string start = fold_name(text.substr(0, kStart));
  for (const PrinterFirmware& firmware : printer_firmwares())
    for (const std::string_view after : {std::string_view(" device profile"), kForBeam})
      if (start.find(fold_name(std::string(firmware.name) + std::string(after))) != std::string::npos)
        return true;
  return false;
}

}  // namespace kerf::gcode
