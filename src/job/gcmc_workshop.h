// The operations of cutting jobs for gcmc programs.
#pragma once

#include "front/gcmc/run/workshop.h"

namespace kerf {

/// For GcmcOptions::workshop.
const GcmcWorkshop& gcmc_workshop();

}  // namespace kerf
