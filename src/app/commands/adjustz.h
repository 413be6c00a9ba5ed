// `kerf adjustz`: a replacement for PathGCodeAdjustZ, with its options, messages and exit statuses.
#pragma once

#include <string>
#include <vector>

#include "kerf/base/progress.h"

namespace kerf::app {

/// Runs the command with the arguments after "kerf adjustz". Returns the exit status.
int adjustz_command(const std::vector<std::string>& arguments, Progress* progress);

}  // namespace kerf::app
