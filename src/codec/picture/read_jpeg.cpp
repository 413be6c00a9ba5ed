// Reads the tones of JPEG files, by libjpeg-turbo.
#if KERF_WITH_JPEG

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <fmt/format.h>
#include <jerror.h>
#include <jpeglib.h>
#include <utility>

#include "base/codes/files.h"
#include "codec/picture/exif.h"
#include "codec/picture/image_files.h"

namespace kerf {
namespace {

/// A scan goes over the whole picture, so that a small file of many scans takes minutes; encoders make ten.
constexpr int kMaxScans = 200;
/// A block of 64 pixels has one bit at least. Files with less are cut off, and claim memory for nothing.
constexpr std::size_t kMaxPixelsPerByte = 64 * 8;
/// A JPEG of several scans needs six bytes for each pixel while it is read.
constexpr std::size_t kMaxPixelsInScans = kMaxReadPixels / 2;
constexpr double kMmPerInch = 25.4, kMmPerCm = 10.0;

/// Where libjpeg's functions return to after an error; it has no other way to stop.
struct Failure {
  jpeg_error_mgr base;
  std::jmp_buf back;
  std::array<char, JMSG_LENGTH_MAX> message;
};
Failure& failure_of(j_common_ptr file) { return *reinterpret_cast<Failure*>(file->err); }

[[noreturn]] void stop(j_common_ptr file) {
  Failure& failure = failure_of(file);
  file->err->format_message(file, failure.message.data());
  std::longjmp(failure.back, 1);
}

/// Warnings, of which one is harmless, are of missing or damaged data; libjpeg would make pixels up.
void on_message(j_common_ptr file, int level) {
  const int code = file->err->msg_code;
  if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM && code != JWRN_JFIF_MAJOR)
    stop(file);
}
void print_nothing(j_common_ptr) {}

void watch_scans(j_common_ptr file) {
  if (reinterpret_cast<j_decompress_ptr>(file)->input_scan_number <= kMaxScans) return;
  Failure& failure = failure_of(file);
  fmt::format_to_n(failure.message.data(), failure.message.size() - 1, "it has more than {} scans{}",
                   kMaxScans, '\0');
  std::longjmp(failure.back, 1);
}

/// The luminance of colours of sRGB as its grey, as libpng makes it of a PNG.
class Luminance {
 public:
  Luminance() {
    for (std::size_t i = 0; i < 256; ++i) {
      const double v = static_cast<double>(i) / 255.0;
      const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
      for (std::size_t c = 0; c < 3; ++c) linear_[c][i] = static_cast<float>(kFraction[c] * linear);
    }
    for (std::size_t i = 0; i <= kSteps; ++i) {
      const double v = static_cast<double>(i) / kSteps;
      const double coded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
      coded_[i] = static_cast<std::uint8_t>(std::lround(255.0 * coded));
    }
  }
  std::uint8_t operator()(std::uint8_t r, std::uint8_t g, std::uint8_t b) const {
    if (r == g && g == b) return r;
    const float light = linear_[0][r] + linear_[1][g] + linear_[2][b];
    return coded_[static_cast<std::size_t>(std::clamp(light, 0.0f, 1.0f) * kSteps + 0.5f)];
  }

 private:
  static constexpr std::array<double, 3> kFraction{0.2126, 0.7152, 0.0722};  // ITU-R BT.709
  static constexpr std::size_t kSteps = 65535;
  std::array<std::array<float, 256>, 3> linear_;
  std::array<std::uint8_t, kSteps + 1> coded_;
};

/// The tones of a row: of one, three or four components.
void append_row(const std::vector<std::uint8_t>& row, int components, bool is_inverted,
                std::vector<std::uint8_t>& grey) {
  static const Luminance luminance;
  if (components == 1) {
    grey.insert(grey.end(), row.begin(), row.end());
    return;
  }
  const auto step = static_cast<std::size_t>(components);
  for (std::size_t i = 0; i + step <= row.size(); i += step) {
    if (components == 3) {
      grey.push_back(luminance(row[i], row[i + 1], row[i + 2]));
      continue;
    }
    // Cyan, magenta, yellow and black; Adobe's programs store 255 for no ink.
    std::array<std::uint8_t, 3> light{};
    const auto without_ink = [&](std::size_t c) { return is_inverted ? row[i + c] : 255 - row[i + c]; };
    for (std::size_t c = 0; c < 3; ++c)
      light[c] = static_cast<std::uint8_t>((without_ink(c) * without_ink(3) + 127) / 255);
    grey.push_back(luminance(light[0], light[1], light[2]));
  }
}

/// What a call of libjpeg may leave by a jump is outside of the functions that make the calls.
struct Reading {
  jpeg_decompress_struct file{};
  Failure failure{};
  jpeg_progress_mgr watch{};
  std::vector<std::uint8_t> row;
  GreyImage made;
  ExifValues exif;

  ~Reading() { jpeg_destroy_decompress(&file); }
};

/// False with the failure's message.
bool read_head(Reading& reading, std::string_view bytes) {
  jpeg_decompress_struct& file = reading.file;
  if (setjmp(reading.failure.back) != 0) return false;
  jpeg_create_decompress(&file);
  reading.watch.progress_monitor = watch_scans;
  file.progress = &reading.watch;
  jpeg_save_markers(&file, JPEG_APP0 + 1, 0xFFFF);
  jpeg_mem_src(&file, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&file, TRUE);
  return true;
}

bool read_rows(Reading& reading) {
  jpeg_decompress_struct& file = reading.file;
  if (setjmp(reading.failure.back) != 0) return false;
  const bool is_ink = file.jpeg_color_space == JCS_CMYK || file.jpeg_color_space == JCS_YCCK;
  file.out_color_space = is_ink ? JCS_CMYK : file.jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE : JCS_RGB;
  file.dct_method = JDCT_ISLOW;
  jpeg_start_decompress(&file);
  reading.row.resize(std::size_t{file.output_width} * static_cast<std::size_t>(file.output_components));
  while (file.output_scanline < file.output_height) {
    JSAMPROW row = reading.row.data();
    jpeg_read_scanlines(&file, &row, 1);
    append_row(reading.row, file.output_components, file.saw_Adobe_marker != 0, reading.made.grey);
  }
  jpeg_finish_decompress(&file);
  return true;
}

ExifValues exif_of(const jpeg_decompress_struct& file) {
  for (const jpeg_marker_struct* marker = file.marker_list; marker != nullptr; marker = marker->next) {
    const std::string_view data(reinterpret_cast<const char*>(marker->data), marker->data_length);
    if (data.starts_with("Exif")) return read_exif(data);
  }
  return {};
}

/// Along the rows of the turned picture.
std::optional<double> resolution_of(const Reading& reading, bool is_on_side) {
  const jpeg_decompress_struct& file = reading.file;
  const int per_unit = is_on_side ? file.Y_density : file.X_density;
  const bool is_known = file.saw_JFIF_marker != 0 && per_unit > 0;
  if (is_known && file.density_unit == 1) return per_unit / kMmPerInch;
  if (is_known && file.density_unit == 2) return per_unit / kMmPerCm;
  return reading.exif.pixels_per_mm;
}

/// The rows of a picture as EXIF's orientation 2 to 8 says: mirrored, upside down, on a side.
GreyImage turned(const GreyImage& from, int orientation) {
  const bool is_on_side = orientation >= 5;
  const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  GreyImage made{is_on_side ? from.height : from.width, is_on_side ? from.width : from.height, {}, {}};
  made.grey.reserve(from.grey.size());
  for (int y = 0; y < made.height; ++y)
    for (int x = 0; x < made.width; ++x) {
      const int column = is_on_side ? y : x, line = is_on_side ? x : y;
      const int u = from_right ? from.width - 1 - column : column;
      const int v = from_below ? from.height - 1 - line : line;
      made.grey.push_back(from.grey[static_cast<std::size_t>(v) * static_cast<std::size_t>(from.width) +
                                    static_cast<std::size_t>(u)]);
    }
  return made;
}

}  // namespace

std::optional<GreyImage> read_jpeg(std::string_view bytes, const std::string& file_name,
                                   Diagnostics& diagnostics) {
  const auto refused = [&](const std::string& why) {
    diagnostics.error(codes::file_unreadable, TextLocation{file_name, 0, 0}, why).hint =
        "save the picture again as PNG or JPEG";
    return std::nullopt;
  };
  Reading reading;
  reading.file.err = jpeg_std_error(&reading.failure.base);
  reading.failure.base.error_exit = stop;
  reading.failure.base.emit_message = on_message;
  reading.failure.base.output_message = print_nothing;
  const auto failed = [&] {
    return refused(fmt::format("the JPEG cannot be read: {}", reading.failure.message.data()));
  };
  if (!read_head(reading, bytes)) return failed();
  const std::size_t pixels = std::size_t{reading.file.image_width} * reading.file.image_height;
  const bool in_scans = jpeg_has_multiple_scans(&reading.file) != 0;
  const std::size_t limit = in_scans ? kMaxPixelsInScans : kMaxReadPixels;
  if (pixels == 0 || pixels > limit)
    return refused(fmt::format("the picture has {} pixels; the limit is {}{}", pixels, limit,
                               in_scans ? " for a progressive JPEG" : ""));
  if (pixels / kMaxPixelsPerByte > bytes.size())
    return refused(fmt::format("the JPEG is cut off: {} bytes for {} x {} pixels", bytes.size(),
                               reading.file.image_width, reading.file.image_height));
  reading.made.width = static_cast<int>(reading.file.image_width);
  reading.made.height = static_cast<int>(reading.file.image_height);
  reading.made.grey.reserve(pixels);
  reading.exif = exif_of(reading.file);
  if (!read_rows(reading)) return failed();
  const int orientation = reading.exif.orientation;
  GreyImage made = orientation == 1 ? std::move(reading.made) : turned(reading.made, orientation);
  made.pixels_per_mm = resolution_of(reading, orientation >= 5);
  return made;
}

}  // namespace kerf

#endif  // KERF_WITH_JPEG
