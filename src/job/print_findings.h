// What a print fails by, as findings.
#pragma once

#include <vector>

#include "kerf/job/job.h"

namespace kerf {

/// The findings of a print: the nozzle in printed material, beads in the air, blobs, layers with far more
/// filament than fits. Bridges are none, nor filament purged before the first bead or beside the print.
std::vector<Finding> findings_in_print(const Job& job, const JobCheckOptions& options,
                                       Diagnostics& diagnostics, Progress* progress);

}  // namespace kerf
