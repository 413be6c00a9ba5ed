// `kerf pathdxf`: a drop-in for PathDxf2GCode, with its options, messages, files and exit statuses.
#pragma once

#include <string>
#include <vector>

#include "kerf/base/progress.h"

namespace kerf::app {

/// Runs the command with the arguments after "kerf pathdxf". Returns the exit status: 0 done, 1 errors, 2
/// wrong usage, 3 no DXF file. `progress` may be null.
int pathdxf_command(const std::vector<std::string>& arguments, Progress* progress);

}  // namespace kerf::app
