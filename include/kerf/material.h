// Materials: the maximum chip load (mm per tooth) by tool diameter.
#pragma once

#include <string>
#include <vector>

#include "kerf/units.h"

namespace kerf {

struct ChipLoad {
  Length diameter;
  Length highest;  // mm per tooth
};

struct Material {
  std::string name;
  std::vector<std::string> other_names;
  std::vector<ChipLoad> chip_loads;  // by increasing diameter, at least one
};

/// The maximum chip load for a tool of `diameter`: interpolated between rows of the table, proportional to
/// the diameter below the first, and that of the last row above it.
Length highest_chip_load(const Material& material, Length diameter);

}  // namespace kerf
