// PNG files: read back by libpng's simple interface; invalid images are refused.
#include <gtest/gtest.h>
#include <png.h>
#include <vector>

#include "codec/picture/image_files.h"

namespace kerf {
namespace {

TEST(Png, ReadsBack) {
  const int width = 37, height = 21;
  std::vector<std::uint8_t> pixels;
  for (int k = 0; k < width * height * 4; ++k) pixels.push_back(static_cast<std::uint8_t>(k * 7 + k / 50));
  const std::string bytes = write_png({width, height, pixels});
  EXPECT_EQ(bytes, write_png({width, height, pixels}));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(image.width, 37u);
  EXPECT_EQ(image.height, 21u);
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr), 0);
  EXPECT_EQ(read, pixels);
}

/// An image of opaque pixels in several bands, with edges, gradients and noise, so that every filter is used.
TEST(Png, ReadsBackLargeOpaqueImages) {
  const int width = 701, height = 1203;
  std::vector<std::uint8_t> pixels;
  std::uint32_t noise = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      noise = noise * 1664525u + 1013904223u;
      const int part = y / 100 % 4;
      const int value = part == 0   ? x / 3
                        : part == 1 ? y
                        : part == 2 ? (x + y) / 2
                                    : static_cast<int>(noise >> 24);
      for (int c = 0; c < 3; ++c) pixels.push_back(static_cast<std::uint8_t>(value + 5 * c));
      pixels.push_back(255);
    }
  const std::string bytes = write_png({width, height, pixels});
  EXPECT_LT(bytes.size(), pixels.size() / 2);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr), 0);
  EXPECT_EQ(read, pixels);
}

TEST(Png, RefusesInvalidImages) {
  const std::vector<std::uint8_t> pixels(40);
  EXPECT_EQ(write_png({}), "");
  EXPECT_EQ(write_png({-1, 4, pixels}), "");
  EXPECT_EQ(write_png({4, 4, pixels}), "");         // too few pixels
  const std::vector<std::uint8_t> wide(4'000'004);  // more columns than readers accept
  EXPECT_EQ(write_png({1'000'001, 1, wide}), "");
}

}  // namespace
}  // namespace kerf
