// Checks of the arguments of fitting functions.
#pragma once

#include <vector>

#include "kerf/geom/fit.h"

namespace kerf::outline_detail {

/// False, with an error appended, for fewer than `fewest` points, numbers that are not usable, and a
/// tolerance that is not above 0.
bool check_fit(const std::vector<Point2>& points, std::size_t fewest, Length within,
               const FitOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::outline_detail
