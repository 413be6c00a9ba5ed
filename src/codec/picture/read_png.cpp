// Reads the tones of PNG files, by libpng.
#if KERF_WITH_PNG

#include <fmt/format.h>
#include <png.h>

#include "base/codes/files.h"
#include "codec/picture/image_files.h"

namespace kerf {
namespace {

constexpr double kMmPerMetre = 1000.0;

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

/// The chunk pHYs, which libpng's simple interface does not show.
std::optional<double> resolution_of(std::string_view bytes) {
  constexpr std::size_t kSignature = 8, kFrame = 12, kPerMetre = 1;
  for (std::size_t at = kSignature; at + kFrame <= bytes.size();) {
    const std::size_t size = number_at(bytes, at);
    const std::string_view kind = bytes.substr(at + 4, 4);
    if (size > bytes.size() - at - kFrame || kind == "IDAT") break;
    if (kind == "pHYs" && size == 9 && bytes[at + 16] == kPerMetre && number_at(bytes, at + 8) > 0)
      return number_at(bytes, at + 8) / kMmPerMetre;
    at += kFrame + size;
  }
  return std::nullopt;
}

std::optional<GreyImage> refused(const std::string& file_name, const std::string& why,
                                 Diagnostics& diagnostics) {
  diagnostics.error(codes::file_unreadable, TextLocation{file_name, 0, 0}, why).hint =
      "pictures are PNG or JPEG files";
  return std::nullopt;
}

}  // namespace

std::optional<GreyImage> read_png(std::string_view bytes, const std::string& file_name,
                                  Diagnostics& diagnostics) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    return refused(file_name, fmt::format("not a PNG: {}", image.message), diagnostics);
  GreyImage made;
  made.width = static_cast<int>(image.width), made.height = static_cast<int>(image.height);
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (pixels == 0 || pixels > kMaxReadPixels) {
    png_image_free(&image);
    return refused(file_name,
                   fmt::format("the picture has {} pixels; the limit is {}", pixels, kMaxReadPixels),
                   diagnostics);
  }
  image.format = PNG_FORMAT_GRAY;
  made.grey.resize(pixels);
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&image, &white, made.grey.data(), 0, nullptr) == 0)
    return refused(file_name, fmt::format("the picture cannot be read: {}", image.message), diagnostics);
  made.pixels_per_mm = resolution_of(bytes);
  return made;
}

}  // namespace kerf

#endif  // KERF_WITH_PNG
