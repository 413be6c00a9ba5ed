// A tool from keys and values, the same ones in tool files and options.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/tool/tool.h"

namespace kerf::detail {

struct Setting {
  std::string key;
  Origin where;
  std::variant<double, std::string, bool, Profile> value;
};

/// Whether a shape has a dimension of this name.
bool has_measure(const ToolShape& shape, std::string_view key);
/// The blank shape of a name. Unknown names are an error with a hint.
std::optional<ToolShape> blank_shape(std::string_view name, const Origin& where, Diagnostics& diagnostics);
/// Makes a tool from a blank shape and settings with lengths in units of `scale` mm. Every invalid setting is
/// reported.
std::optional<Tool> tool_of(const ToolShape& blank, const std::vector<Setting>& settings, double scale,
                            const Origin& where, Diagnostics& diagnostics);

}  // namespace kerf::detail
