// Selects the reader of a picture by its first bytes, whatever its name ends in.
#include "base/codes/files.h"
#include "codec/picture/image_files.h"

namespace kerf {

std::optional<GreyImage> read_picture(std::string_view bytes, const std::string& file_name,
                                      Diagnostics& diagnostics) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xFF\xD8\xFF"sv)) return read_jpeg(bytes, file_name, diagnostics);
  if (bytes.starts_with("\x89PNG"sv)) return read_png(bytes, file_name, diagnostics);
  diagnostics
      .error(codes::file_unreadable, TextLocation{file_name, 0, 0}, "the file is neither a PNG nor a JPEG")
      .hint = "pictures are PNG or JPEG files";
  return std::nullopt;
}

}  // namespace kerf
