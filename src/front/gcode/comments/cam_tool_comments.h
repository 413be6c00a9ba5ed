// Tool descriptions in the fixed forms of CAM programs: "T4 D=3.175 CR=0 - ZMIN=-5.3 - flat end mill".
#pragma once

#include <optional>
#include <string_view>

#include "kerf/tool/tool.h"

namespace kerf::gcode {

struct CamTool {
  std::optional<int> number;  // nothing: the comment has none
  ToolShape shape;
  std::string_view assumed = {};  // what its shape is assumed to be; empty: the comment describes it
};

inline constexpr std::string_view kAssumedCountersink = "a countersink without an angle, assuming 90 degrees";
/// What is assumed of the profile of a tap, a reamer or a boring bar that `capitals` names; empty: of none.
std::string_view assumed_profile(std::string_view capitals);

/// The tool that a comment describes. Lengths are in mm times `scale` unless the comment names a unit.
/// Nothing if the form is not one of those known.
std::optional<CamTool> read_cam_tool(std::string_view text, double scale);

/// True for a comment of the form "T4 D=3.175 ..." even if read_cam_tool does not accept its tool.
bool is_other_tool_form(std::string_view text);

}  // namespace kerf::gcode
