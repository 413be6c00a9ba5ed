// The time of each step at the programmed feeds. For times as planned by a controller see kerf/estimate.h.
#pragma once

#include <vector>

#include "kerf/report.h"

namespace kerf {

/// Seconds per step, dwells and motions, as report_on() adds them up; 0 for steps that it does not time.
std::vector<float> reported_seconds(const Toolpath& path, const ReportOptions& options);

}  // namespace kerf
