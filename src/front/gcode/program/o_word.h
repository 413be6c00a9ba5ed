// The parts of an O-word: "O<name> call [1]" is the label <name>, the word call and the values after it.
#pragma once

#include <string>
#include <string_view>

#include "front/gcode/program/flow.h"

namespace kerf::gcode {

struct OWord {
  std::string label;        // "100", "<name>"; one that is computed as it stands
  std::string_view values;  // what follows the keyword
  OKind kind = OKind::nothing;
};

/// `text` from the letter O on, without a comment.
OWord read_o_word(std::string_view text);

}  // namespace kerf::gcode
