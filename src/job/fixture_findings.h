// Contacts with a job's fixtures, as findings.
#pragma once

#include <vector>

#include "kerf/job.h"

namespace kerf {

/// Empty without fixtures, or with an error if the contacts could not be computed.
std::vector<Finding> findings_at_fixtures(const Toolpath& path, const Job& job, const SimulationOptions& how,
                                          Diagnostics& diagnostics, Progress* progress);

}  // namespace kerf
