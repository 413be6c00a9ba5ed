// The space below material, in columns laid out by hand: a room of 3 x 3 columns with a roof and walls.
#include <algorithm>
#include <array>
#include <gtest/gtest.h>

#include "sim/print/print_hollow.h"

namespace kerf::printing {
namespace {

constexpr int kSide = 7;  // of the grid; the room is at its centre, with air around its walls
constexpr double kPitch = 0.5, kTouch = 0.01;
constexpr double kRoom = 9 * 2.0 * kPitch * kPitch;  // mm3

using Column = std::vector<Interval>;
Column solid(float low, float high) { return {{low, high, 0, 0}}; }

/// Walls up to Z3 and a roof from Z2 to Z3; `changed` replaces the column (i, j).
ColumnGrid room(int i, int j, const Column& changed) {
  ColumnGrid grid;
  grid.pitch = kPitch;
  grid.nx = grid.ny = kSide;
  grid.bounds.add(Point3{0, 0, 0});
  grid.bounds.add(Point3{kSide * kPitch, kSide * kPitch, 3});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto is_in = [&](int low, int high) { return std::min(x, y) >= low && std::max(x, y) <= high; };
      grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
      Column column = is_in(2, 4) ? solid(2, 3) : is_in(1, 5) ? solid(0, 3) : Column{};
      if (x == i && y == j) column = changed;
      grid.intervals.insert(grid.intervals.end(), column.begin(), column.end());
    }
  }
  grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
  return grid;
}

PrintVolumes measured(const ColumnGrid& grid) {
  std::vector<PrintLayer> layers(3);
  for (int k = 0; k < 3; ++k) layers[static_cast<std::size_t>(k)].z = mm(k + 1);
  PrintVolumes total;
  const HollowSamples columns{
      kPitch * kPitch, [&grid](const HollowSamples::Visit& visit) {
        for (std::uint32_t n = 0; n + 1 < grid.first.size(); ++n)
          visit({n % kSide * kPitch, n / kSide * kPitch},
                std::span(grid.intervals).subspan(grid.first[n], grid.first[n + 1] - grid.first[n]));
      }};
  EXPECT_TRUE(measure_hollow(grid, kTouch, columns, layers, total, nullptr));
  EXPECT_NEAR((layers[0].volumes.enclosed + layers[1].volumes.enclosed + layers[2].volumes.enclosed).mm3(),
              total.enclosed.mm3(), 1e-9);
  EXPECT_EQ(layers[2].volumes.enclosed.mm3(), 0.0) << "the roof is solid";
  return total;
}

/// Columns of the walls, at the centre of each side.
constexpr std::array<std::array<int, 2>, 4> kDoors{{{1, 3}, {5, 3}, {3, 1}, {3, 5}}};

TEST(Hollow, AClosedRoomIsEnclosed) {
  const PrintVolumes closed = measured(room(-1, -1, {}));
  EXPECT_NEAR(closed.hollow.mm3(), kRoom, 1e-9);
  EXPECT_NEAR(closed.enclosed.mm3(), kRoom, 1e-9);
}

TEST(Hollow, ADoorOnAnySideOpensTheRoom) {
  for (const auto& [i, j] : kDoors) {
    SCOPED_TRACE(testing::Message() << "door at " << i << ", " << j);
    EXPECT_EQ(measured(room(i, j, {})).enclosed.mm3(), 0.0) << "without a lintel";
    EXPECT_EQ(measured(room(i, j, solid(0, 1))).enclosed.mm3(), 0.0) << "over a sill";
    EXPECT_EQ(measured(room(i, j, solid(1.5, 3))).enclosed.mm3(), 0.0) << "below a lintel";
    const PrintVolumes window = measured(room(i, j, {{0.0f, 0.5f, 0, 0}, {1.5f, 3.0f, 0, 0}}));
    EXPECT_EQ(window.enclosed.mm3(), 0.0);
    EXPECT_NEAR(window.hollow.mm3(), kRoom + 1.0 * kPitch * kPitch, 1e-6);
  }
}

TEST(Hollow, AnOpeningInTheRoofOpensTheRoom) {
  for (const auto& [i, j] : {std::array{2, 3}, std::array{4, 3}, std::array{3, 2}, std::array{3, 4}}) {
    EXPECT_EQ(measured(room(i, j, {})).enclosed.mm3(), 0.0) << i << ", " << j;
    EXPECT_NEAR(measured(room(i, j, solid(0, 2))).enclosed.mm3(), kRoom * 8 / 9, 1e-9) << "a pillar";
  }
}

TEST(Hollow, ASlitUpToTheTouchIsNoOpening) {
  for (const auto& [i, j] : kDoors) {
    EXPECT_NEAR(measured(room(i, j, solid(0.009f, 3))).enclosed.mm3(), kRoom, 1e-3);
    EXPECT_EQ(measured(room(i, j, solid(0.02f, 3))).enclosed.mm3(), 0.0);
  }
}

}  // namespace
}  // namespace kerf::printing
