// Tool comments in words: "3mm Endmill", "1/4 in Carbide End Mill", "TOOL 1 - DIA 6.", "Tool #5
// "0.3mm30degree"".
#pragma once

#include <optional>
#include <string_view>

#include "front/gcode/comments/cam_tool_comments.h"

namespace kerf::gcode {

/// The tool that a comment describes, if it has the form of a program that is known to write it so. Nothing
/// for all other comments, such as prose and names of operations, and for tools whose profile the comment
/// does not give. Numbers without a unit are in mm times `scale`. `at_tool_change`: the comment is on the
/// line of a tool change.
std::optional<CamTool> read_worded_tool_comment(std::string_view text, double scale, bool at_tool_change);

}  // namespace kerf::gcode
