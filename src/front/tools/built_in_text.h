// The text of data/tools.toml, compiled in.
#pragma once

#include <string_view>

namespace kerf::detail {

std::string_view built_in_tool_text();

}  // namespace kerf::detail
