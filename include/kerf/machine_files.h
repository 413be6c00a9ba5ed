// Machines from files: Kerf's own TOML profiles and what GRBL answers to `$$`.
#pragma once

#include <optional>
#include <string_view>

#include "kerf/diagnostics.h"
#include "kerf/machine.h"

namespace kerf {

/// Reads a machine's file; which kind it is tells its text ("$110=3000" on a line is GRBL's). Settings that
/// are not told stay those of a new Machine. Every fault is reported with its place (TOML profiles:
/// docs/manual/machine.md); nothing is returned then. `file_name` is for the messages.
std::optional<Machine> read_machine_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);

}  // namespace kerf
