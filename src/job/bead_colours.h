// Colours of the beads of a print by what they are for and how they are printed.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kerf/job/outputs.h"

namespace kerf {

/// Indices into a palette, and the meaning of its colours.
struct StepColours {
  std::vector<std::uint8_t> of_step;
  std::vector<std::string> names;  // of the palette, as far as it is used
  std::vector<std::array<std::uint8_t, 3>> palette;
};

/// The colours of the steps of a print; numbers are divided into equal ranges. The first two colours of the
/// palette are the stock's and the hazards'.
StepColours colour_beads(const Toolpath& path, BeadColours by);

}  // namespace kerf
