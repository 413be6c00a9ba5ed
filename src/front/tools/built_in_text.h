// The texts of data/tools.toml and data/materials.toml, compiled in.
#pragma once

#include <string_view>

namespace kerf::detail {

std::string_view built_in_tool_text();
std::string_view built_in_material_text();

}  // namespace kerf::detail
