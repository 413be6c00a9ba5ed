// Machines from files: TOML profiles and GRBL's `$$` output.
#pragma once

#include <optional>
#include <string_view>

#include "kerf/diagnostics.h"
#include "kerf/machine.h"

namespace kerf {

/// Reads a machine file; its kind is detected from the text ("$110=3000" on a line is GRBL's). Missing
/// settings are those of a default Machine. All errors are reported with their location (TOML profiles:
/// docs/manual/machine.md); nothing is returned then. `file_name` is for the messages.
std::optional<Machine> read_machine_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);

}  // namespace kerf
