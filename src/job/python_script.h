// Running a user's Python script with Kerf's modules on its path.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kerf/diagnostics.h"

namespace kerf {

/// Runs `script` with $KERF_PYTHON, else the virtual environment's python, else python3. Kerf's modules are
/// on its path, `environment` is added to its environment, and its output goes to stderr. Returns its exit
/// status; -1, with an error, if it could not be started or was ended by a signal.
int run_python(const std::string& script, const std::vector<std::pair<std::string, std::string>>& environment,
               Diagnostics& diagnostics);

}  // namespace kerf
