// `kerf gcmc`: a drop-in for the command of the same name, with its options, messages and exit statuses.
#pragma once

#include <string>
#include <vector>

#include "kerf/base/progress.h"

namespace kerf::app {

/// Runs the command with the arguments after "kerf gcmc". Returns the exit status. `progress` may be null;
/// its stop_requested() stops the run.
int gcmc_command(const std::vector<std::string>& arguments, Progress* progress);

}  // namespace kerf::app
