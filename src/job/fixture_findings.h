// Contacts with a job's fixtures, as findings.
#pragma once

#include <vector>

#include "kerf/job.h"

namespace kerf {

/// None where there are no fixtures, or where the contacts could not be computed (`diagnostics` has the
/// error).
std::vector<Finding> findings_at_fixtures(const Toolpath& path, const Job& job, const SimulationOptions& how,
                                          Diagnostics& diagnostics, Progress* progress);

}  // namespace kerf
