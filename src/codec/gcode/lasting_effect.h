// Which words act beyond their own line: they move the machine, or change how it reads or carries out later
// lines. Who passes a single line on to a controller without following it must not let such words through.
#pragma once

#include <string>
#include <string_view>

#include "codec/gcode/block.h"

namespace kerf::gcode {

/// What a word moves, or changes for later lines ("the plane", "a position"); empty for words that act on
/// their own line only, such as M101, G4 and their parameters. Modal groups: RS274/NGC section 3.4.
std::string_view lasting_effect(char letter, double value);

/// The first word of a block that has such an effect, or what else about the block has one (parameters,
/// O-words, block delete); both texts are empty where there is none.
struct LastingEffect {
  std::string word;  // as in the text
  std::string_view effect;
  std::uint32_t column = 0;
};
LastingEffect lasting_effect(const Block& block);

}  // namespace kerf::gcode
