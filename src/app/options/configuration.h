// The configuration of this run of the command, and the files that it finds by name.
#pragma once

#include <string>

#include "job/configuration.h"

namespace kerf::app {

/// Empty until main() has loaded it.
Configuration& configuration();
/// A file in the folder `key` of the configuration if `name` is the name of one, else `name`.
std::string configured_file(std::string_view key, const std::string& name);

}  // namespace kerf::app
