// An O-word: "O<name> call [1]" has the label <name>, the keyword call and the value [1].
#pragma once

#include <string>
#include <string_view>

#include "front/gcode/program/flow.h"

namespace kerf::gcode {

struct OWord {
  std::string label;        // "100", "<name>"; a computed one as its expression
  std::string_view values;  // the text after the keyword
  std::string_view action;  // of IF: the text after GOTO or THEN
  OKind kind = OKind::invalid;
};

/// Parses `text`, which starts with the letter O or is a statement of Fanuc's macros, and has no comment.
/// "DO1" and "END1" have the label "do1", "GOTO 20" has the label "n" and the value "20".
OWord read_o_word(std::string_view text);

}  // namespace kerf::gcode
