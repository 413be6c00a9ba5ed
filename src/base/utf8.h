// Code points of UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace kerf {

/// A byte that is not UTF-8 becomes the code point of its value.
std::u32string from_utf8(std::string_view bytes);

}  // namespace kerf
