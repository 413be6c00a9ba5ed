// PNG files: read back by libpng's simple interface; invalid images are refused.
#include <gtest/gtest.h>
#include <png.h>
#include <vector>

#include "kerf/image_files.h"

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

TEST(Png, RefusesInvalidImages) {
  const std::vector<std::uint8_t> pixels(40);
  EXPECT_EQ(write_png({}), "");
  EXPECT_EQ(write_png({-1, 4, pixels}), "");
  EXPECT_EQ(write_png({4, 4, pixels}), "");  // too few pixels
  const std::vector<std::uint8_t> wide(4'000'004,
                                       0);  // libpng's own limit of a million columns: its error path
  EXPECT_EQ(write_png({1'000'001, 1, wide}), "");
}

}  // namespace
}  // namespace kerf
