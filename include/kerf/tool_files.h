// Tools from files: Kerf's own TOML tool files and the table that every Kerf knows.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/tool.h"

namespace kerf {

/// The tools that every Kerf knows: data/tools.toml, compiled in. Vendor's, generated and program numbers are
/// keys. spec/gcodepreview.md section 4.
const ToolTable& built_in_tools();

/// Reads a tool file in Kerf's TOML form (docs/manual/tools.md) into `table`. Every error of the file is
/// reported with its place; tools without an error are kept. `file_name` is for the messages.
void read_tool_file(std::string_view text, std::string_view file_name, ToolTable& table,
                    Diagnostics& diagnostics);

/// Reads a tool told in words: "square d=3.175 flute=12.7", "V d=12.7 angle=90", the name of a built-in tool,
/// or its number. `where` is the errors' place.
std::optional<Tool> read_tool_option(std::string_view text, const Origin& where, Diagnostics& diagnostics);

/// A key of tool files and options besides the measures of the shape (parameters_of).
struct ToolKey {
  std::string_view name, meaning;
};
const std::vector<ToolKey>& tool_keys();
/// The short names that a key has for a shape: "d" and "dia" for the diameter; "r" stands for whichever
/// radius the shape has.
std::vector<std::string_view> short_names_of(std::string_view key, const ToolShape& shape);

}  // namespace kerf
