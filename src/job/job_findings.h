// What a simulation finds in the stock and at the fixtures of a job.
#pragma once

#include <vector>

#include "kerf/job.h"

namespace kerf {

/// The hazards in the stock, without the cuts below its floor that end inside of the spoilboard.
std::vector<Finding> findings_in_stock(const Job& job, const Simulation& simulation);
/// Empty without fixtures, or with an error if the contacts could not be computed.
std::vector<Finding> findings_at_fixtures(const Toolpath& path, const Job& job, const SimulationOptions& how,
                                          Diagnostics& diagnostics, Progress* progress);

}  // namespace kerf
