// The tool comments of CAM programs in the order of a program: those of one comment, and those of several.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "front/gcode/comments/cam_tool_comments.h"

namespace kerf::gcode {

class CamComments {
 public:
  /// The tool that a comment describes, together with those before it: "TOOL NUMBER: 1" with a description
  /// below, PyCAM's settings, "Tool Size" with the size below. Lengths without a unit are in mm times
  /// `scale`. `at_tool_change`: the comment is on the line of a tool change.
  std::optional<CamTool> read(std::string_view text, double scale, bool at_tool_change);

 private:
  std::optional<CamTool> read_settings(std::string_view text, double scale);

  std::optional<int> number_;           // of "TOOL NUMBER: 1"
  bool size_follows_ = false;           // after "Tool Size"
  bool spherical_ = false;              // PyCAM's "shape = SphericalCutter"
  std::size_t comments_left_ = 20'000;  // a program with a comment in every line is read as fast as without
};

}  // namespace kerf::gcode
