// Chip loads between those of the table.
#include "kerf/material.h"

namespace kerf {

Length highest_chip_load(const Material& material, Length diameter) {
  ChipLoad below;  // a tool of no diameter takes nothing
  for (const ChipLoad& above : material.chip_loads) {
    if (diameter <= above.diameter) {
      const double share = (diameter - below.diameter) / (above.diameter - below.diameter);
      return below.highest + share * (above.highest - below.highest);
    }
    below = above;
  }
  return below.highest;
}

}  // namespace kerf
