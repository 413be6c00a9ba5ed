// An O-word: "O<name> call [1]" has the label <name>, the keyword call and the value [1].
#pragma once

#include <string>
#include <string_view>

#include "front/gcode/program/flow.h"

namespace kerf::gcode {

struct OWord {
  std::string label;        // "100", "<name>"; a computed one as its expression
  std::string_view values;  // the text after the keyword
  OKind kind = OKind::invalid;
};

/// Parses `text`, which starts with the letter O and has no comment.
OWord read_o_word(std::string_view text);

}  // namespace kerf::gcode
