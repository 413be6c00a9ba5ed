// The limits with which the firmware of a printer plans motions, as steps set them.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "kerf/path/toolpath.h"

namespace kerf {

/// The names of the values of a limit, as in JSON and Python: "x", "y", "z", "e"; "beads", "retractions",
/// "travel", ""; "value", "", "", "".
const std::array<std::string_view, 4>& value_names(LimitKind kind);
/// The kind of a name such as "jerk"; nothing for an unknown one.
std::optional<LimitKind> limit_named(std::string_view name);
/// The kind of a name such as "outer_wall"; "" is none; nothing for an unknown one.
std::optional<BeadKind> bead_kind_named(std::string_view name);

}  // namespace kerf
