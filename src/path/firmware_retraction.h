// Retraction by the firmware of a printer: the lines that draw filament back and return it, and those that
// set how far. In a toolpath they are step::Verbatim.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kerf {

/// mm of filament and mm/min; nothing where the line does not set it.
struct RetractionLengths {
  std::optional<double> length, speed;
  std::optional<double> extra, return_speed;  // more filament than was drawn back; the speed of its return
  std::optional<double> hop;                  // mm in Z
  bool any() const { return length || speed || extra || return_speed || hop; }
  /// Takes over what `other` sets.
  void update(const RetractionLengths& other);
};

enum class RetractionLine : std::uint8_t { none, back, forth, lengths };
struct FirmwareRetraction {
  RetractionLine line = RetractionLine::none;
  RetractionLengths lengths;
};

/// G10, G11; M207 and M208 of Marlin and RepRapFirmware; SET_RETRACTION of Klipper. Other lines are none,
/// such as RepRapFirmware's "G10 P1 S200".
FirmwareRetraction read_firmware_retraction(std::string_view text);
/// The same line in mm, of a line of lengths in units of `unit_mm`.
std::string retraction_in_mm(std::string_view text, double unit_mm);

}  // namespace kerf
