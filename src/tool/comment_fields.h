// CutViewer's tool comments as a word and its numbers, for reading, writing and comparing.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kerf/tool/tool.h"

namespace kerf::detail {

/// TOOL/MILL: all numbers mm, the taper in radians from the axis.
struct MillFields {
  double diameter = 0.0, corner_radius = 0.0, height = 0.0, taper = 0.0;
};
/// TOOL/CRMILL.
struct CornerFields {
  double tip_diameter = 0.0, diameter = 0.0, radius = 0.0, height = 0.0, length = 0.0;
};

/// The fields that describe a shape; nothing for shapes of other comments or without a comment.
std::optional<MillFields> mill_fields(const ToolShape& shape);
std::optional<CornerFields> corner_fields(const ToolShape& shape);

/// Whether a comment's tool is the known one, within the rounding and the known mistakes of comments (see
/// docs/manual/tools.md). A tool of Kerf's own description must have the same profile.
bool agrees(const Tool& known, const Tool& described);
/// "square 6.35 mm".
std::string text_of(const Tool& tool);

}  // namespace kerf::detail
