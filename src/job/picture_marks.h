// Axes, sizes and a legend over a picture of a part or of a toolpath.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "kerf/sim/render.h"

namespace kerf {

using LegendEntry = std::pair<std::string, std::array<std::uint8_t, 3>>;

/// The lines of the marks that `view` asks for, for a part within `box`. Adds the points to `view` that they
/// need room for.
std::vector<PictureLine> draw_marks(View& view, const Box3& box, const std::vector<LegendEntry>& legend);

}  // namespace kerf
