// Machines from files: TOML profiles and GRBL's `$$` output.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/machine.h"

namespace kerf {

/// Reads a machine file; its kind is detected from the text ("$110=3000" on a line is GRBL's). Missing
/// settings are those of a default Machine. All errors are reported with their location (TOML profiles:
/// docs/manual/machine.md); nothing is returned then. `file_name` is for the messages.
std::optional<Machine> read_machine_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);

/// The names of the built-in profiles, "grbl_router": the files of data/machines.
std::vector<std::string> built_in_machine_names();

/// The machine of a file or, if there is none of that path, the built-in one of that name. Errors as by
/// read_machine_file(), and if there is neither.
std::optional<Machine> load_machine(const std::string& file_or_name, Diagnostics& diagnostics);

}  // namespace kerf
