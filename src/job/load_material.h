// Materials by name or from files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "kerf/base/diagnostics.h"
#include "kerf/tool/material.h"

namespace kerf {

/// The end of the file's name in "birch.toml" and "shop.toml:birch"; nothing if the text names no file.
std::optional<std::size_t> end_of_material_file(const std::string& text);

/// A built-in material of this name, or the one of a file: "shop.toml:birch", "birch.toml" for its first one.
/// Nothing, with errors, if there is none.
std::optional<Material> load_material(const std::string& text, Diagnostics& diagnostics);

}  // namespace kerf
