// Interpolation of chip loads.
#include "kerf/tool/material.h"

namespace kerf {

Length highest_chip_load(const Material& material, Length diameter) {
  ChipLoad below;  // chip load 0 at diameter 0
  for (const ChipLoad& above : material.chip_loads) {
    if (diameter <= above.diameter) {
      const double fraction = (diameter - below.diameter) / (above.diameter - below.diameter);
      return below.highest + fraction * (above.highest - below.highest);
    }
    below = above;
  }
  return below.highest;
}

}  // namespace kerf
