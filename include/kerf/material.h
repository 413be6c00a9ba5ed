// What a tool may take from a material: the highest chip load (mm a tooth) by the tool's diameter.
#pragma once

#include <string>
#include <vector>

#include "kerf/units.h"

namespace kerf {

struct ChipLoad {
  Length diameter;
  Length highest;  // mm a tooth
};

struct Material {
  std::string name;
  std::vector<std::string> other_names;
  std::vector<ChipLoad> chip_loads;  // by rising diameter, at least one
};

/// The highest chip load for a tool of `diameter`: between two of the table's in proportion, below the first
/// in proportion to the diameter, above the last as the last.
Length highest_chip_load(const Material& material, Length diameter);

}  // namespace kerf
