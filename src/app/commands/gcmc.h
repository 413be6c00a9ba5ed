// `kerf gcmc`: a drop-in for the command of the same name, with its options, messages and exit statuses.
#pragma once

#include <string>
#include <vector>

#include "kerf/progress.h"

namespace kerf::app {

/// Runs the command; `arguments` stand behind "kerf gcmc". Returns the exit status. `progress` may be null;
/// its stop_requested() ends an endless program.
int gcmc_command(const std::vector<std::string>& arguments, Progress* progress);

}  // namespace kerf::app
