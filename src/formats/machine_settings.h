// The settings of a machine by name, for both kinds of machine files.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/path/machine.h"

namespace kerf::detail {

/// A setting that is a number or a list of numbers.
struct MachineSetting {
  std::string_view name;
  std::size_t count = 1;         // numbers
  double low = 0.0, high = 0.0;  // range of each
  std::string_view meaning;      // "rates in mm/min"
  void (*set)(Machine&, const double* values) = nullptr;
};
const std::vector<MachineSetting>& machine_settings();

/// A setting of GRBL: `$110=3000`.
struct GrblSetting {
  int number = 0;
  double low = 0.0, high = 0.0;
  std::string_view meaning;
  void (*set)(Machine&, double value) = nullptr;
};
const std::vector<GrblSetting>& grbl_settings();

/// Whether a text has settings of GRBL, in a dump of any program: "$110=3000", several on a line, with a time
/// or an arrow before them, or as JSON. A profile in TOML has none.
bool has_grbl_settings(std::string_view text);
std::optional<Machine> read_grbl_settings(std::string_view text, std::string_view file_name,
                                          Diagnostics& diagnostics);

}  // namespace kerf::detail
