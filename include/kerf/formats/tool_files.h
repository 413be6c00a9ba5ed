// Tools from files: Kerf's TOML tool files and the built-in table.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// The built-in tools: data/tools.toml, compiled in. Vendor, generated and program numbers are
/// keys.
const ToolTable& built_in_tools();

/// Reads a TOML tool file (docs/manual/tools.md) into `table`. All errors are reported with their location;
/// tools without an error are kept. `file_name` is for the messages.
void read_tool_file(std::string_view text, std::string_view file_name, ToolTable& table,
                    Diagnostics& diagnostics);

/// Reads a tool from text: "square d=3.175 flute=12.7", "V d=12.7 angle=90", the name of a built-in tool,
/// or its number. `where` is the origin of the errors.
std::optional<Tool> read_tool_option(std::string_view text, const Origin& where, Diagnostics& diagnostics);

/// A key of tool files and options other than the dimensions of the shape (parameters_of).
struct ToolKey {
  std::string_view name, meaning;
};
const std::vector<ToolKey>& tool_keys();
/// The short names of a key for a shape: "d" and "dia" for the diameter; "r" for the radius of the shape.
std::vector<std::string_view> short_names_of(std::string_view key, const ToolShape& shape);

}  // namespace kerf
