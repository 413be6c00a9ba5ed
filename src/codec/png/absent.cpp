// Replaces reader and writer where libpng and zlib are not available: no picture is read or written.
#if !KERF_WITH_PNG

#include "base/codes/files.h"
#include "codec/png/image_files.h"

namespace kerf {

std::string write_png(const ImageView&) { return {}; }

std::optional<GreyImage> read_png(std::string_view, const std::string& file_name, Diagnostics& diagnostics) {
  diagnostics.error(codes::file_unreadable, TextLocation{file_name, 0, 0}, "this build reads no pictures")
      .hint = "use the kerf command";
  return std::nullopt;
}

}  // namespace kerf

#endif  // !KERF_WITH_PNG
