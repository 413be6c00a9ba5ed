// A tool told by keys and values, from a file or an option: one meaning for both.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/tool.h"

namespace kerf::detail {

struct Setting {
  std::string key;
  Origin where;
  std::variant<double, std::string, bool, Profile> value;
};

/// Millimetres of a unit's name ("mm", "inch", "in"); nothing for other words.
std::optional<double> unit_scale(std::string_view name);
/// "6.35", "0.25in", "1/4 inch", "6mm" in mm; plain numbers times `scale`. Nothing if it is no length.
std::optional<double> parse_length(std::string_view text, double scale);

/// The blank shape of a name. Unknown names are an error with a hint.
std::optional<ToolShape> blank_shape(std::string_view name, const Origin& where, Diagnostics& diagnostics);
/// Makes a tool of a blank shape and its settings; lengths are mm times `scale`. Every wrong setting is
/// reported.
std::optional<Tool> tool_of(const ToolShape& blank, const std::vector<Setting>& settings, double scale,
                            const Origin& where, Diagnostics& diagnostics);

}  // namespace kerf::detail
