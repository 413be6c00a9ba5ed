// PNG files from plain pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace kerf {

/// Rows from the top, four bytes per pixel (red, green, blue, alpha; sRGB, not premultiplied).
struct ImageView {
  int width = 0;
  int height = 0;
  std::span<const std::uint8_t> rgba;
};

/// The file's bytes; empty if the picture has no pixels, fewer than width * height, or more than a PNG can
/// hold.
std::string write_png(const ImageView& image);

}  // namespace kerf
