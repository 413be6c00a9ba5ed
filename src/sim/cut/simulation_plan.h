// Data that a simulation keeps for meshes with exact edges, so that nothing is computed twice.
#pragma once

#include "sim/sweep/batch_source.h"
#include "sim/sweep/survey.h"

#include "kerf/sim/simulate.h"

namespace kerf {

struct Simulation::Plan {
  sim::Survey survey;
  sim::KeptBatches batches;
};

}  // namespace kerf
