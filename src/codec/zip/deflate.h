// Compressing bytes in memory, as zlib does. Without zlib (WebAssembly) nothing is compressed.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kerf::zip {

bool can_deflate();
/// A stream of zlib; empty where bytes cannot be compressed.
std::string deflated(std::string_view bytes);
/// Unpacks a stream that must hold exactly `size` bytes; false if it is damaged.
bool inflated(std::string_view stream, std::size_t size, std::string& bytes);

}  // namespace kerf::zip
