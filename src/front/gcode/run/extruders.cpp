// Printers with several extruders, and the factors of speed (M220) and flow (M221).
//
// The E coordinate is one for all extruders; Klipper sets it to 0 when another one is activated, and the
// factor of flow to 1. Sources: Marlin's pages M220 and M221; Klipper's kinematics/extruder.py and
// extras/gcode_move.py; Duet's "GCode dictionary".
#include "front/gcode/run/extruders.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "base/names.h"
#include "front/gcode/run/printer_words.h"

#include "kerf/base/limits.h"

namespace kerf::gcode {
namespace {

constexpr double kMaxCelsius = 2000.0;
constexpr double kMaxFactor = 100.0;
constexpr double kPercent = 100.0;

/// "extruder" is 0, "extruder1" is 1; nothing for other names.
std::optional<double> extruder_named(std::string_view name) {
  constexpr std::string_view kName = "extruder";
  const std::string folded = fold_name(name);
  if (folded.substr(0, kName.size()) != kName) return std::nullopt;
  const std::string number = folded.substr(kName.size());
  if (number.empty()) return 0.0;
  if (number.size() > 3 || number.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  return std::stod(number);
}

}  // namespace

/// The extruder of a T or P word. T1000 and such, in the programs of some printers, are commands of another
/// kind.
std::optional<int> Extruders::number_of(double number, std::uint32_t column) {
  if (number >= 0.0 && number < limits::kMaxExtruders && number == std::floor(number))
    return static_cast<int>(number);
  if (number >= 0.0 && number == std::floor(number))
    reporter_.note(codes::code_ignored, column,
                   fmt::format("extruders have the numbers 0 to {}, so that this one is a command of the "
                               "printer's own; skipped",
                               limits::kMaxExtruders - 1));
  else
    reporter_.error(codes::word_out_of_range, column, "the number of an extruder is an integer from 0");
  return std::nullopt;
}

void Extruders::use(int number) {
  if (program_.dialect == GcodeDialect::klipper && number != extruder_) {
    filament_ = 0.0;
    flow_factors_[number] = 1.0;
  }
  extruder_ = number;
  add(step::Extruder{number});
}

double Extruders::flow_factor() const {
  const auto found = flow_factors_.find(extruder_);
  return found == flow_factors_.end() ? 1.0 : found->second;
}

/// True for Klipper's ACTIVATE_EXTRUDER, M220 and M221, and for RepRapFirmware's temperatures of tools.
bool Extruders::command(std::string_view text) {
  const CommandParts parts = command_parts(text);
  if (parts.name == "activateextruder") {
    const std::size_t sign = parts.rest.find('=');
    if (sign == std::string_view::npos) return false;
    const auto number = extruder_named(trim(parts.rest.substr(sign + 1)));
    if (!number) return false;
    if (const auto valid = number_of(*number, 1)) use(*valid);
    return true;
  }
  if (parts.name == "m220") return set_speed_factor(parts.rest);
  if (parts.name == "m221") return set_flow_factor(parts.rest);
  return program_.dialect == GcodeDialect::reprap && set_tool_temperature(parts.name, parts.rest);
}

/// A factor of a word in percent; nothing with a warning for one that no firmware takes.
std::optional<double> Extruders::factor_of(double percent, double min, std::string_view code) {
  const double factor = percent / kPercent;
  if (factor >= min && factor <= kMaxFactor) return factor;
  reporter_.unusual(codes::word_out_of_range, 1,
                    fmt::format("S of {} is a percentage from {:g} to {:g}; skipped", code, kPercent * min,
                                kPercent * kMaxFactor));
  return std::nullopt;
}

/// M220 S50; Marlin's M220 B stores the factor, M220 R returns it.
bool Extruders::set_speed_factor(std::string_view words) {
  constexpr double kMinFactor = 0.01;
  const std::string flag = fold_name(words);
  if (flag == "b") stored_speed_factor_ = feeds_.factor();
  if (flag == "r") feeds_.set_factor(stored_speed_factor_);
  if (flag == "b" || flag == "r" || flag.empty()) return true;
  const auto list = command_words(words, false);
  const auto percent = list ? value_of(*list, "s") : std::nullopt;
  if (!percent) return false;
  if (const auto factor = factor_of(*percent, kMinFactor, "M220")) feeds_.set_factor(*factor);
  return true;
}

/// M221 S95 T1 (RepRapFirmware: D1); without an extruder, of the one in use.
bool Extruders::set_flow_factor(std::string_view words) {
  if (trim(words).empty()) return true;
  const auto list = command_words(words, false);
  const auto percent = list ? value_of(*list, "s") : std::nullopt;
  if (!percent) return false;
  const auto given = value_of(*list, program_.dialect == GcodeDialect::reprap ? "d" : "t");
  const auto number = number_of(given.value_or(extruder_), 1);
  if (!number) return true;
  if (const auto factor = factor_of(*percent, 0.0, "M221")) flow_factors_[*number] = *factor;
  return true;
}

/// RepRapFirmware: G10 P0 S200 sets the temperature of a tool, M116 waits for those of all.
bool Extruders::set_tool_temperature(std::string_view code, std::string_view words) {
  if (code == "m116" && trim(words).empty()) {
    for (const auto& [extruder, celsius] : tool_celsius_)
      add(step::Temperature{Heater::nozzle, celsius, true, extruder});
    return !tool_celsius_.empty();
  }
  const auto list = code == "g10" ? command_words(words, false) : std::nullopt;
  const auto celsius = list ? value_of(*list, "s") : std::nullopt;
  if (!celsius) return false;
  const auto tool = value_of(*list, "p");
  const auto number = tool ? number_of(*tool, 1) : std::optional(-1);
  if (!number) return true;
  const double heat = std::min(*celsius, kMaxCelsius);
  tool_celsius_[*number] = heat;
  add(step::Temperature{Heater::nozzle, heat, false, *number});
  return true;
}

}  // namespace kerf::gcode
