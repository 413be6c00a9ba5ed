// Detects from the start of a file whether it is text.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace kerf::gcode {

/// The kind of a file that is not plain text, and the byte that shows it.
struct NotPlain {
  enum class Kind : unsigned char { utf16, binary } kind;
  std::size_t at = 0;
};
/// Nothing for text that can be read line by line. Letters of any eight-bit alphabet are text, as comments
/// contain them.
std::optional<NotPlain> find_not_plain(std::string_view bytes);

}  // namespace kerf::gcode
