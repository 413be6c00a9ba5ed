// Machines from files: TOML profiles and GRBL's `$$` output.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/path/machine.h"
#include "kerf/tool/material.h"

namespace kerf {

/// Reads a machine file; its kind is detected from the text ("$110=3000" on a line is GRBL's). Missing
/// settings are those of a default Machine. All errors are reported with their location (TOML profiles:
/// docs/manual/machine.md); nothing is returned then. `file_name` is for the messages.
std::optional<Machine> read_machine_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);

// Materials from files: data/materials.toml, compiled in.

/// The built-in materials (docs/manual/machine.md).
const std::vector<Material>& built_in_materials();
/// Reads a file of materials in the form of data/materials.toml. All errors are reported with their location.
std::vector<Material> read_material_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);
/// The built-in material of a name, compared by fold_name; an unknown name is an error with a hint.
std::optional<Material> material_named(std::string_view name, Diagnostics& diagnostics);

}  // namespace kerf
