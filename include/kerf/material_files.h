// Materials from files: data/materials.toml, compiled in.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/material.h"

namespace kerf {

/// The materials that every Kerf knows (docs/manual/machine.md).
const std::vector<Material>& built_in_materials();
/// Reads a file of materials in the form of data/materials.toml. Every fault is reported with its place.
std::vector<Material> read_material_file(std::string_view text, std::string_view file_name,
                                         Diagnostics& diagnostics);
/// The built-in material of a name, compared by fold_name; an unknown one is an error with a hint.
std::optional<Material> material_named(std::string_view name, Diagnostics& diagnostics);

}  // namespace kerf
