// Materials from files: data/materials.toml, compiled in.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/material.h"

namespace kerf {

/// The built-in materials (docs/manual/machine.md).
const std::vector<Material>& built_in_materials();
/// Reads a file of materials in the form of data/materials.toml. All errors are reported with their location.
std::vector<Material> read_material_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);
/// The built-in material of a name, compared by fold_name; an unknown name is an error with a hint.
std::optional<Material> material_named(std::string_view name, Diagnostics& diagnostics);

}  // namespace kerf
