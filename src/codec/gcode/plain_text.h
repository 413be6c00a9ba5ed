// Whether a file's bytes are text at all: a look at the begin, before anything is read from it.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace kerf::gcode {

/// What a text is instead of ASCII or UTF-8, and the byte that shows it.
struct NotPlain {
  enum class Kind : unsigned char { utf16, binary } kind;
  std::size_t at = 0;
};
/// Nothing for a text that can be read line by line. Letters of any eight-bit alphabet are text: comments
/// have them.
std::optional<NotPlain> find_not_plain(std::string_view bytes);

}  // namespace kerf::gcode
