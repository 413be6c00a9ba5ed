// The table of the firmwares of printers.
#include "path/printer_firmware.h"

#include <algorithm>

#include "base/names.h"

namespace kerf {
namespace {

const PrinterFirmware* named_in(std::vector<std::string_view> PrinterFirmware::*list, std::string_view text) {
  const std::string name = fold_name(text);
  for (const PrinterFirmware& firmware : printer_firmwares())
    if (std::find((firmware.*list).begin(), (firmware.*list).end(), name) != (firmware.*list).end())
      return &firmware;
  return nullptr;
}

}  // namespace

std::span<const PrinterFirmware> printer_firmwares() {
  static const PrinterFirmware kFirmwares[] = {
      {"marlin",
       PrinterLanguage::marlin,
       {"marlin", "marlin2", "marlin(legacy)", "repetier", "reprap"},
       {"marlin", "reprap(marlin/sprinter)", "repetier"}},
      {"klipper", PrinterLanguage::klipper, {"klipper"}, {}},
      {"reprapfirmware",
       PrinterLanguage::reprap,
       {"reprapfirmware"},
       {"reprap", "reprap(reprap)", "reprapfirmware"}},
      {"plain", PrinterLanguage::marlin, {}, {}},
      {"prusa", PrinterLanguage::marlin, {}, {}},
  };
  return kFirmwares;
}

const PrinterFirmware* firmware_of_gcode_flavor(std::string_view text) {
  return named_in(&PrinterFirmware::gcode_flavor, text);
}
const PrinterFirmware* firmware_of_flavor(std::string_view text) {
  return named_in(&PrinterFirmware::flavor, text);
}

}  // namespace kerf
