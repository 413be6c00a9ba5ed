// Code points of UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace kerf {

/// A byte that is not UTF-8 becomes the code point of its value.
std::u32string from_utf8(std::string_view bytes);

/// Appends a character; one that is no code point of a text becomes U+FFFD.
void append_utf8(std::string& out, char32_t character);

}  // namespace kerf
