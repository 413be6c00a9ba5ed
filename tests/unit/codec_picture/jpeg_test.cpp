// JPEG files: made by libjpeg's compressor, whose pixels are known; damaged and hostile files are refused.
#include <csetjmp>
#include <cstdio>
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <vector>

#include "codec/picture/exif.h"
#include "codec/picture/image_files.h"

namespace kerf {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Form {
  J_COLOR_SPACE in = JCS_GRAYSCALE;
  int components = 1;
  bool is_progressive = false;
  int quality = 100;
  std::string exif{};  // the data of APP1
  int density = 0;     // dots per inch
};

/// A JPEG of pixels, rows from the top.
std::string encoded(int width, int height, const Bytes& pixels, const Form& form) {
  jpeg_compress_struct file{};
  jpeg_error_mgr errors{};
  file.err = jpeg_std_error(&errors);
  jpeg_create_compress(&file);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&file, &memory, &size);
  file.image_width = static_cast<JDIMENSION>(width);
  file.image_height = static_cast<JDIMENSION>(height);
  file.input_components = form.components;
  file.in_color_space = form.in;
  jpeg_set_defaults(&file);
  jpeg_set_quality(&file, form.quality, TRUE);
  for (int c = 0; c < file.num_components; ++c)
    file.comp_info[c].h_samp_factor = file.comp_info[c].v_samp_factor = 1;
  if (form.is_progressive) jpeg_simple_progression(&file);
  if (form.density > 0) {
    file.density_unit = 1;
    file.X_density = static_cast<UINT16>(form.density);
    file.Y_density = static_cast<UINT16>(2 * form.density);
  }
  jpeg_start_compress(&file, TRUE);
  if (!form.exif.empty())
    jpeg_write_marker(&file, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(form.exif.data()),
                      static_cast<unsigned>(form.exif.size()));
  while (file.next_scanline < file.image_height) {
    const std::size_t at =
        std::size_t{file.next_scanline} * static_cast<std::size_t>(width * form.components);
    auto* row = const_cast<JSAMPROW>(pixels.data() + at);
    jpeg_write_scanlines(&file, &row, 1);
  }
  jpeg_finish_compress(&file);
  std::string bytes(reinterpret_cast<char*>(memory), size);
  jpeg_destroy_compress(&file);
  std::free(memory);
  return bytes;
}

/// Blocks of 16 pixels, 2 across and 3 down, each of one colour.
constexpr int kWide = 32, kHigh = 48;
Bytes blocks(const std::vector<Bytes>& colours) {
  Bytes pixels;
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x)
      for (const std::uint8_t v : colours[static_cast<std::size_t>(2 * (y / 16) + x / 16)])
        pixels.push_back(v);
  return pixels;
}
const std::vector<Bytes> kGreys{{0}, {50}, {100}, {150}, {200}, {255}};

/// The tone at the centre of a block.
int tone(const GreyImage& image, int column, int row) {
  return image.grey[static_cast<std::size_t>((16 * row + 8) * image.width + 16 * column + 8)];
}

std::optional<GreyImage> read(const std::string& bytes) {
  Diagnostics diagnostics;
  auto made = read_picture(bytes, "photo.jpg", diagnostics);
  EXPECT_EQ(made.has_value(), !diagnostics.has_errors());
  return made;
}
std::string fault(const std::string& bytes) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read_picture(bytes, "photo.jpg", diagnostics));
  return diagnostics.list().empty() ? "" : diagnostics.list()[0].message;
}

TEST(Jpeg, ReadsGreyBaselineAndProgressive) {
  for (const bool is_progressive : {false, true}) {
    const auto image =
        read(encoded(kWide, kHigh, blocks(kGreys), {.is_progressive = is_progressive, .density = 254}));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, kWide);
    EXPECT_EQ(image->height, kHigh);
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(tone(*image, i % 2, i / 2), kGreys[static_cast<std::size_t>(i)][0], 1);
    EXPECT_NEAR(image->pixels_per_mm.value_or(0.0), 10.0, 1e-9);
  }
}

/// The luminance of colours, as a PNG of the same colours has it.
TEST(Jpeg, ColoursHaveTheTonesOfAPng) {
  const std::vector<Bytes> colours{{255, 0, 0},    {0, 255, 0},     {0, 0, 255},
                                   {200, 120, 40}, {255, 255, 255}, {90, 90, 90}};
  Bytes rgba;
  const Bytes pixels = blocks(colours);
  for (std::size_t i = 0; i < pixels.size(); i += 3) {
    for (std::size_t c = 0; c < 3; ++c) rgba.push_back(pixels[i + c]);
    rgba.push_back(255);
  }
  const auto png = read(write_png({kWide, kHigh, rgba}));
  const auto jpeg = read(encoded(kWide, kHigh, pixels, {.in = JCS_RGB, .components = 3}));
  ASSERT_TRUE(png && jpeg);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(tone(*jpeg, i % 2, i / 2), tone(*png, i % 2, i / 2), 3) << i;
  // sRGB: 0.2126, 0.7152 and 0.0722 of the light, coded again.
  EXPECT_NEAR(tone(*jpeg, 0, 0), 127, 2);
  EXPECT_NEAR(tone(*jpeg, 1, 0), 220, 2);
  EXPECT_NEAR(tone(*jpeg, 0, 1), 76, 3);
}

/// Inks as Adobe's programs store them: 255 is none. libjpeg's compressor writes Adobe's marker.
TEST(Jpeg, ReadsInks) {
  const std::vector<Bytes> inks{{255, 255, 255, 255}, {255, 255, 255, 0}, {255, 255, 255, 128},
                                {0, 255, 255, 255},   {255, 255, 0, 255}, {128, 128, 128, 255}};
  const auto image = read(encoded(kWide, kHigh, blocks(inks), {.in = JCS_CMYK, .components = 4}));
  ASSERT_TRUE(image);
  EXPECT_NEAR(tone(*image, 0, 0), 255, 1);
  EXPECT_NEAR(tone(*image, 1, 0), 0, 1);
  EXPECT_NEAR(tone(*image, 0, 1), 128, 1);
  EXPECT_NEAR(tone(*image, 1, 1), 228, 3);  // cyan: green and blue light, 0.7874 of all
  EXPECT_NEAR(tone(*image, 0, 2), 247, 3);  // yellow: 0.9278
  EXPECT_NEAR(tone(*image, 1, 2), 128, 1);
}

/// A TIFF directory with an orientation, and a resolution of 100 pixels per cm.
std::string exif(char orientation, bool is_big) {
  const auto u16 = [&](int v) {
    const char low = static_cast<char>(v), high = static_cast<char>(v >> 8);
    return is_big ? std::string{high, low} : std::string{low, high};
  };
  const auto u32 = [&](int v) { return is_big ? u16(0) + u16(v) : u16(v) + u16(0); };
  const int after = 8 + 2 + 3 * 12 + 4;
  return std::string("Exif\0\0", 6) + (is_big ? "MM" : "II") + u16(42) + u32(8) + u16(3) +  //
         u16(0x0112) + u16(3) + u32(1) + u16(orientation) + u16(0) +                        //
         u16(0x011A) + u16(5) + u32(1) + u32(after) + u16(0x0128) + u16(3) + u32(1) + u16(3) + u16(0) +
         u32(0) + u32(200) + u32(2);
}

/// Where the first row and the first column of the file are, by the table of EXIF's tag 274.
TEST(Jpeg, TurnsAsItsOrientationSays) {
  // The tones of a picture as it is to be seen, and how its rows are stored for each orientation: (u, v) of
  // the file is (x, y) of the picture.
  const auto seen = [](int x, int y) { return 10 + 40 * (2 * y + x); };  // 2 across, 3 down
  for (char orientation = 1; orientation <= 8; ++orientation) {
    const bool is_on_side = orientation >= 5;
    const int wide = is_on_side ? kHigh : kWide, high = is_on_side ? kWide : kHigh;
    Bytes stored;
    for (int v = 0; v < high; ++v)
      for (int u = 0; u < wide; ++u) {
        int x = 0, y = 0;
        switch (orientation) {
          case 1: x = u, y = v; break;                          // row: top, column: left
          case 2: x = kWide - 1 - u, y = v; break;              // top, right
          case 3: x = kWide - 1 - u, y = kHigh - 1 - v; break;  // bottom, right
          case 4: x = u, y = kHigh - 1 - v; break;              // bottom, left
          case 5: x = v, y = u; break;                          // left, top
          case 6: x = kWide - 1 - v, y = u; break;              // right, top
          case 7: x = kWide - 1 - v, y = kHigh - 1 - u; break;  // right, bottom
          default: x = v, y = kHigh - 1 - u; break;             // left, bottom
        }
        stored.push_back(static_cast<std::uint8_t>(seen(x / 16, y / 16)));
      }
    const auto image = read(encoded(wide, high, stored, {.exif = exif(orientation, orientation % 2 == 0)}));
    ASSERT_TRUE(image);
    ASSERT_EQ(image->width, kWide) << int{orientation};
    ASSERT_EQ(image->height, kHigh);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 2; ++x) EXPECT_NEAR(tone(*image, x, y), seen(x, y), 1) << int{orientation};
    EXPECT_NEAR(image->pixels_per_mm.value_or(0.0), 10.0, 1e-9);
  }
}

/// No length or offset of EXIF data leads beyond it.
TEST(Jpeg, DamagedExifHasNoValues) {
  const std::string whole = exif(6, true);
  for (std::size_t size = 0; size < whole.size(); ++size) read_exif(std::string_view(whole).substr(0, size));
  for (std::size_t i = 6; i < whole.size(); ++i) {
    std::string other = whole;
    other[i] = '\xFF';
    const ExifValues values = read_exif(other);
    EXPECT_TRUE(values.orientation >= 1 && values.orientation <= 8);
  }
  EXPECT_EQ(read_exif("Exif").orientation, 1);
}

TEST(Jpeg, RefusesFilesThatAreCutOff) {
  const std::string whole = encoded(kWide, kHigh, blocks(kGreys), {.quality = 90});
  ASSERT_TRUE(read(whole));
  for (const std::size_t size : {whole.size() - 20, whole.size() / 2, std::size_t{100}, std::size_t{4}})
    EXPECT_NE(fault(whole.substr(0, size)).find("the JPEG cannot be read"), std::string::npos) << size;
  std::string damaged = whole;
  for (std::size_t i = whole.size() - 60; i < whole.size() - 20; ++i) damaged[i] = '\xFF';
  EXPECT_FALSE(fault(damaged).empty());
}

/// A head that claims 10000 x 10000 pixels and more in a small file takes no memory.
TEST(Jpeg, RefusesSizesBeyondTheLimit) {
  const auto resized = [](std::string bytes, int width, int height) {
    const std::size_t at =
        bytes.find("\xFF\xC0") == std::string::npos ? bytes.find("\xFF\xC2") : bytes.find("\xFF\xC0");
    bytes[at + 5] = static_cast<char>(height >> 8), bytes[at + 6] = static_cast<char>(height);
    bytes[at + 7] = static_cast<char>(width >> 8), bytes[at + 8] = static_cast<char>(width);
    return bytes;
  };
  for (const bool is_progressive : {false, true}) {
    const std::string small = encoded(kWide, kHigh, blocks(kGreys), {.is_progressive = is_progressive});
    EXPECT_NE(fault(resized(small, 65500, 65500)).find("the limit is"), std::string::npos);
    EXPECT_NE(fault(resized(small, 5000, 5000)).find("cut off"), std::string::npos);
    EXPECT_FALSE(fault(resized(small, 0, 10)).empty());
  }
}

TEST(Jpeg, RefusesWhatIsNoPicture) {
  EXPECT_NE(fault("G1 X10").find("neither a PNG nor a JPEG"), std::string::npos);
  EXPECT_FALSE(fault("").empty());
  EXPECT_FALSE(fault("\xFF\xD8\xFF\xE0").empty());
}

/// Any byte changed: read or refused, in either case whole.
TEST(Jpeg, ReadsOrRefusesAnyBytes) {
  const std::string whole = encoded(kWide, kHigh, blocks(kGreys), {.is_progressive = true, .quality = 60});
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char c : {'\x00', '\x7F', '\xFF'}) {
      std::string other = whole;
      other[i] = c;
      Diagnostics diagnostics;
      const auto image = read_jpeg(other, "x.jpg", diagnostics);
      if (image)
        EXPECT_EQ(image->grey.size(),
                  static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height));
      else
        EXPECT_TRUE(diagnostics.has_errors());
    }
}

}  // namespace
}  // namespace kerf
