// Tools as CAM programs tell them to people: "T4 D=3.175 CR=0 - ZMIN=-5.3 - flat end mill".
#pragma once

#include <optional>
#include <string_view>

#include "kerf/tool.h"

namespace kerf::gcode {

struct ToolRemark {
  std::optional<int> number;  // nothing: the remark names none
  ToolShape shape;
};

/// What a remark says of a tool; lengths are in mm times `scale` where the remark names no unit. Nothing
/// where it is not surely about a tool.
std::optional<ToolRemark> read_remark(std::string_view text, double scale);

}  // namespace kerf::gcode
