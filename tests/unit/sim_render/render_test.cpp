// Pictures: views by name, the position of the part in the picture, shading, sections, reproducibility.
#include "kerf/sim/render.h"

#include <array>
#include <cstdlib>
#include <gtest/gtest.h>

namespace kerf {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

/// A block 20 x 10 x 5 mm of columns 0.5 mm wide; runs_at(i): the runs of the columns of a row along Y.
template <class RunsAt>
Mesh block_of_rows(const RunsAt& runs_at) {
  ColumnGrid grid;
  grid.bounds = {{0, 0, -5}, {20, 10, 0}};
  grid.pitch = 0.5;
  grid.nx = 40;
  grid.ny = 20;
  grid.first.push_back(0);
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const std::vector<Interval> runs = runs_at(i);
      grid.intervals.insert(grid.intervals.end(), runs.begin(), runs.end());
      grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
    }
  }
  return extract_mesh(grid);
}

/// The half at low x is lower by `depth`.
Mesh stepped_block(float depth) {
  return block_of_rows([&](int i) -> std::vector<Interval> {
    return {{0.0f, i < 20 ? 5.0f - depth : 5.0f, kStockSurface, i < 20 ? 4u : kStockSurface}};
  });
}

std::vector<Rgb> colours_of(const Mesh& mesh) {
  std::vector<Rgb> colours;
  for (const std::uint32_t step : mesh.step)
    colours.push_back(step == 4 ? Rgb{40, 60, 220} : Rgb{220, 60, 40});
  return colours;
}

struct Seen {
  int red = 0, blue = 0, other = 0;
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;  // of the coloured pixels
};
Seen look(const Image& image) {
  Seen seen;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p =
          image.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(x));
      const int balance = p[0] - p[2];
      if (std::abs(balance) < 40) {
        ++seen.other;
        continue;
      }
      ++(balance > 0 ? seen.red : seen.blue);
      seen.left = std::min(seen.left, x);
      seen.right = std::max(seen.right, x);
      seen.top = std::min(seen.top, y);
      seen.bottom = std::max(seen.bottom, y);
    }
  }
  return seen;
}

View small(const char* name) {
  View view = named_view(name).value();
  view.width = 400;
  view.height = 300;
  return view;
}

TEST(Render, HasNamedViews) {
  for (const char* name : {"top", "bottom", "front", "back", "left", "right", "iso"})
    EXPECT_TRUE(named_view(name)) << name;
  EXPECT_FALSE(named_view("below"));
  EXPECT_FALSE(named_view("TOP"));
  EXPECT_DOUBLE_EQ(named_view("top")->elevation.deg(), 90);
  EXPECT_DOUBLE_EQ(named_view("bottom")->elevation.deg(), -90);
  EXPECT_DOUBLE_EQ(named_view("front")->azimuth.deg(), 0);
}

TEST(Render, TopViewIsToScaleAndFitted) {
  const Mesh mesh = stepped_block(1);
  const Seen seen = look(render(mesh, colours_of(mesh), small("top")));
  // 20 x 10 mm in 88 % of 400 pixels: 352 x 176 pixels in the centre, half of it cut.
  EXPECT_NEAR(seen.right - seen.left + 1, 352, 3);
  EXPECT_NEAR(seen.bottom - seen.top + 1, 176, 3);
  EXPECT_NEAR(seen.left + seen.right, 399, 3);
  EXPECT_NEAR(seen.top + seen.bottom, 299, 3);
  EXPECT_NEAR(seen.blue, 176 * 176, 1000);
  EXPECT_NEAR(seen.red, 176 * 176, 1000);
}

TEST(Render, SideViewsShowTheirSides) {
  const Mesh mesh = stepped_block(3);
  const auto colours = colours_of(mesh);
  // From the front the lower half is at the left, from the back at the right; cut faces are not visible.
  const Image front = render(mesh, colours, small("front")), back = render(mesh, colours, small("back"));
  const auto red_at = [](const Image& image, int x, int y) {
    const std::uint8_t* p = image.rgba.data() + 4 * (y * image.width + x);
    return p[0] - p[2] > 40;
  };
  EXPECT_EQ(look(front).blue, 0);
  EXPECT_FALSE(red_at(front, 100, 120));
  EXPECT_TRUE(red_at(front, 300, 120));
  EXPECT_TRUE(red_at(back, 100, 120));
  EXPECT_FALSE(red_at(back, 300, 120));
  // From the left the wall of the step is visible above the low side, from the right only the stock.
  EXPECT_GT(look(render(mesh, colours, small("left"))).blue, 2000);
  EXPECT_EQ(look(render(mesh, colours, small("right"))).blue, 0);
}

TEST(Render, TheBackgroundIsBrighterAtTheTop) {
  const Image image = render(stepped_block(3), {}, small("iso"));
  const std::uint8_t *top = image.rgba.data(), *bottom = top + 4 * image.width * (image.height - 1);
  for (int channel = 0; channel < 3; ++channel) EXPECT_GT(top[channel], bottom[channel] + 10);
}

TEST(Render, IsoViewIsShaded) {
  const Mesh mesh = stepped_block(3);
  const Image image = render(mesh, {}, small("iso"));
  std::array<int, 256> grey{};
  for (std::size_t k = 0; k < image.rgba.size(); k += 4) {
    EXPECT_EQ(image.rgba[k + 3], 255);
    ++grey[image.rgba[k]];
  }
  int shades = 0;
  for (const int count : grey) shades += count > 200 ? 1 : 0;
  EXPECT_GT(shades, 6);
}

/// With a slot along Y that is 4 mm wide below Z-2 and 2 mm wide above.
Mesh undercut_block() {
  return block_of_rows([](int i) {
    const bool head = i >= 16 && i < 24, neck = i >= 18 && i < 22;
    std::vector<Interval> runs{{0.0f, head ? 1.0f : 5.0f, kStockSurface, head ? 4u : kStockSurface}};
    if (head && !neck) runs.push_back({3.0f, 5.0f, 4u, kStockSurface});
    return runs;
  });
}

/// Pixels of the cut face of a section: all others are blue here.
int section_pixels(const Mesh& mesh, View view, const Section& section) {
  view.section = section;
  return look(render(mesh, std::vector<Rgb>(mesh.step.size(), Rgb{40, 60, 220}), view)).red;
}

TEST(Render, ASectionShowsTheProfileOfAnUndercut) {
  const Mesh mesh = undercut_block();
  const double square = 17.6 * 17.6;  // pixels per mm2: 20 mm in 88 % of 400 pixels
  // 20 x 5 mm without the head of 4 x 2 mm and the neck of 2 x 2 mm; one mm in, it is the same.
  for (const double y : {0.25, 5.0, 9.75})
    EXPECT_NEAR(section_pixels(mesh, small("front"), {Plane::xz, y}), (100 - 12) * square, 500) << y;
  EXPECT_NEAR(section_pixels(mesh, small("back"), {Plane::xz, 5.0}), (100 - 12) * square, 500);
  // Through the neck, the head, and the floor below.
  EXPECT_NEAR(section_pixels(mesh, small("top"), {Plane::xy, -1.0}), (200 - 20) * square, 1000);
  EXPECT_NEAR(section_pixels(mesh, small("top"), {Plane::xy, -3.0}), (200 - 40) * square, 1000);
  EXPECT_NEAR(section_pixels(mesh, small("top"), {Plane::xy, -4.5}), 200 * square, 1000);
  EXPECT_GT(section_pixels(mesh, small("iso"), {Plane::yz, 5.0}), 3000);
}

TEST(Render, ASectionRemovesTheViewersSide) {
  // The half at low x is lower. From the left it is removed, so that the full height of the other half is
  // visible; from the right the height of the lower one.
  const Mesh mesh = stepped_block(3);
  const double square = 35.2 * 35.2;  // pixels per mm2: now 10 mm in 88 % of 400 pixels
  EXPECT_NEAR(section_pixels(mesh, small("left"), {Plane::yz, 15.0}), 50 * square, 1500);
  EXPECT_NEAR(section_pixels(mesh, small("right"), {Plane::yz, 5.0}), 20 * square, 1500);
  // In a view along the plane there is no section.
  EXPECT_FALSE(faces(small("top"), {Plane::yz, 10.0}));
  EXPECT_TRUE(faces(small("iso"), {Plane::yz, 10.0}));
  EXPECT_EQ(section_pixels(mesh, small("top"), {Plane::yz, 10.0}), 0);
}

TEST(Render, SamePictureTwiceAndNothingToDraw) {
  const Mesh mesh = stepped_block(2);
  EXPECT_EQ(render(mesh, colours_of(mesh), small("iso")).rgba,
            render(mesh, colours_of(mesh), small("iso")).rgba);
  const Image empty = render(Mesh{}, {}, small("iso"));
  EXPECT_EQ(empty.rgba.size(), 4u * 400 * 300);
  EXPECT_EQ(look(empty).other, 400 * 300);
  View none = small("top");
  none.width = -5;
  none.height = 0;
  EXPECT_EQ(render(mesh, {}, none).rgba.size(), 4u);
}

}  // namespace
}  // namespace kerf
