// Pictures of measured surfaces.
#pragma once

#include <string>

#include "job/heights.h"

namespace kerf {

/// The surface from above, from blue (lowest) to red (highest), with its points; rings mark outliers.
std::string height_png(const MeasuredSurface& surface);
/// The same with the height of each point as text.
std::string height_svg(const MeasuredSurface& surface);

}  // namespace kerf
