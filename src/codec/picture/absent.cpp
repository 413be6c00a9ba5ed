// Replaces readers and writer where their libraries are not available: such pictures are refused.
#include "base/codes/files.h"
#include "codec/picture/image_files.h"

namespace kerf {

#if !KERF_WITH_PNG

std::string write_png(const ImageView&) { return {}; }

std::optional<GreyImage> read_png(std::string_view, const std::string& file_name, Diagnostics& diagnostics) {
  diagnostics.error(codes::file_unreadable, TextLocation{file_name, 0, 0}, "this build reads no pictures")
      .hint = "use the kerf command";
  return std::nullopt;
}

#endif

#if !KERF_WITH_JPEG

std::optional<GreyImage> read_jpeg(std::string_view, const std::string& file_name, Diagnostics& diagnostics) {
  diagnostics.error(codes::file_unreadable, TextLocation{file_name, 0, 0}, "this build reads no JPEG files")
      .hint = "convert the picture to PNG";
  return std::nullopt;
}

#endif

}  // namespace kerf
