// Cuts the toolpaths of path/jobs.h.
#pragma once

#include "../path/jobs.h"

#include "kerf/sim/simulate.h"

namespace kerf::test {

inline std::optional<Simulation> run(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                                     double pitch, Diagnostics& diagnostics, unsigned threads = 1) {
  SimulationOptions options;
  options.resolution = mm(pitch);
  options.threads = threads;
  return simulate(path, tools, stock, options, diagnostics);
}

}  // namespace kerf::test
