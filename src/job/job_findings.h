// What a simulation finds in the stock and at the fixtures of a job.
#pragma once

#include <vector>

#include "kerf/job/job.h"

namespace kerf {

/// What the job says of its simulation: the board below the stock, the machine's rapids.
SimulationOptions simulation_of(const Job& job);
/// Empty without fixtures, or with an error if the contacts could not be computed.
std::vector<Finding> findings_at_fixtures(const Toolpath& path, const Job& job, const SimulationOptions& how,
                                          Diagnostics& diagnostics, Progress* progress);

/// The hazards in the stock and at the fixtures. If Z counts downwards, only that is reported: the other
/// hazards follow from it.
std::vector<Finding> findings_of_milling(const Job& job, const std::vector<Hazard>& hazards,
                                         const SimulationOptions& how, Diagnostics& diagnostics,
                                         Progress* progress);
/// The result of check_job() for findings in the material that are already known.
std::vector<Finding> check_with_material(const Job& job, const JobCheckOptions& options,
                                         std::vector<Finding> in_material, Diagnostics& diagnostics);

}  // namespace kerf
