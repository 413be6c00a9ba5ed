// PNG files from plain pixels, and the tones of PNG and JPEG files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"

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

inline constexpr std::size_t kMaxReadPixels = 100'000'000;  // of a picture that is read

/// Rows from the top, one byte per pixel: 0 is black, 255 white.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey;
  std::optional<double> pixels_per_mm{};  ///< along a row, if the file has it
};
/// The tones of a picture, PNG or JPEG by its first bytes; transparent pixels are on white. Nothing, with an
/// error, if it is neither, is damaged or cut off, or has more pixels than the limit.
std::optional<GreyImage> read_picture(std::string_view bytes, const std::string& file_name,
                                      Diagnostics& diagnostics);
std::optional<GreyImage> read_png(std::string_view bytes, const std::string& file_name,
                                  Diagnostics& diagnostics);
/// Turned as its EXIF orientation says.
std::optional<GreyImage> read_jpeg(std::string_view bytes, const std::string& file_name,
                                   Diagnostics& diagnostics);

}  // namespace kerf
