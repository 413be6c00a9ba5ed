// A job on a fourth axis, as kerf simulate does it.
#pragma once

#include "app/outputs.h"

#include "kerf/rotary.h"

namespace kerf::app {

/// Cuts the job's bar, writes the outputs, tells the result.
Status simulate_bar(Console& console, const Job& job, const SimulationOptions& how,
                    const std::vector<OutputFile>& outputs, const View& view, Diagnostics& diagnostics);

}  // namespace kerf::app
