// Writes PNG with libpng. libpng leaves a failed call by longjmp, which must not cross C++ objects: the frame
// that it returns to has plain pointers only, and the caller owns the objects.
#include <csetjmp>
#include <png.h>
#include <vector>

#include "kerf/image_files.h"

namespace kerf {
namespace {

void append_bytes(png_structp png, png_bytep data, png_size_t size) {
  auto* out = static_cast<std::string*>(png_get_io_ptr(png));
  out->append(reinterpret_cast<const char*>(data), size);
}
void flush_nothing(png_structp) {}
void ignore_warning(png_structp, png_const_charp) {}
void leave(png_structp png, png_const_charp) { png_longjmp(png, 1); }

/// The calls that may end with longjmp. The caller creates and destroys all objects that they use.
bool write_rows(png_structp png, png_infop info, const ImageView& image, png_bytepp rows, std::string* out) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, out, append_bytes, flush_nothing);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::string write_png(const ImageView& image) {
  if (image.width <= 0 || image.height <= 0) return {};
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  if (image.rgba.size() / 4 / width < height) return {};
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = const_cast<png_bytep>(image.rgba.data() + 4 * width * y);
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool done = info != nullptr && write_rows(png, info, image, rows.data(), &out);
  png_destroy_write_struct(&png, &info);
  if (!done) out.clear();
  return out;
}

}  // namespace kerf
