// What `kerf --version` prints.
#pragma once

#include <string>

namespace kerf::app {

/// The version, the build and the features of this command, a line each.
std::string version_text();

}  // namespace kerf::app
