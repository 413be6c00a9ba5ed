// Extruders of printers, their filament and factors.
#pragma once

#include <map>
#include <optional>
#include <string_view>

#include "front/gcode/run/feeds.h"
#include "front/gcode/run/part.h"

namespace kerf::gcode {

class Extruders : Part {
 public:
  Extruders(Context& context, Feeds& feeds) : Part(context), feeds_(feeds) {}

  std::optional<int> number_of(double number, std::uint32_t column);
  void use(int number);
  double flow_factor() const;
  bool command(std::string_view text);
  /// The E coordinate in mm (mm3 after M200), one for all extruders.
  double filament() const { return filament_; }
  void set_filament(double e) { filament_ = e; }

 private:
  std::optional<double> factor_of(double percent, double min, std::string_view code);
  bool set_speed_factor(std::string_view words);
  bool set_flow_factor(std::string_view words);
  bool set_tool_temperature(std::string_view code, std::string_view words);

  Feeds& feeds_;
  int extruder_ = 0;
  double filament_ = 0.0;
  double stored_speed_factor_ = 1.0;    // by M220 B
  std::map<int, double> flow_factors_;  // M221, by extruder; 1 without an entry
  std::map<int, double> tool_celsius_;  // as G10 of RepRapFirmware has set them
};

}  // namespace kerf::gcode
