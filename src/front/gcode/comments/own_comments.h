// The comments of Kerf's own posts: "(tool 2: square, diameter 6 mm, flute 20 mm)", "(change to tool 2)".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kerf/tool/tool.h"

namespace kerf::gcode {

/// What a comment of Kerf's posts says.
struct OwnComment {
  std::optional<int> change_to;  // of "change to tool 2", before a pause
  std::optional<Tool> tool;      // of "tool 2: ..."
  bool zero_stays = false;       // "touch-off of tool 2: the zero in Z stays", before one
  bool at_start = false;         // "tool 2 at the start: ...", in a program without a change to it
};

class OwnComments {
 public:
  /// Reads a comment without its parentheses; nothing for comments in other forms. A comment that ends in a
  /// comma is continued by the next one.
  std::optional<OwnComment> read(std::string_view text, const Origin& where, Diagnostics& diagnostics);

 private:
  std::string joined_;  // a description that the next comment continues
};

}  // namespace kerf::gcode
