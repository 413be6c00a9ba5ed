// Chains of level motions of tools that consist of cylinders: however the motions are grouped, each column
// must be cut by the first motion over it.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "cut_jobs.h"

namespace kerf::test {
namespace {

constexpr double kHead = 3.0, kNeck = 1.5;  // radii
constexpr double kFloor = 2.0, kShoulder = 3.0, kHeight = 8.0;
constexpr std::uint32_t kNone = UINT32_MAX;

Tool keyhole_cutter() {
  return make_drawn(1, profile({{0, 0, 0}, {kHead, 0, 0}, {kHead, 1, 0}, {kNeck, 1, 0}, {kNeck, 12, 0}}));
}

/// Smooth slots, turns in place, steps back and forth, and motions across the block from outside it.
std::vector<Point3> wandering(int count) {
  std::mt19937 random(3);
  const auto fraction = [&] { return static_cast<double>(random() % 1000000u) * 1e-6; };
  std::vector<Point3> all{{-6, 9, kFloor}};
  double heading = 0.0;
  for (int k = 0; k < count; ++k) {
    Point3 at = all.back();
    const int kind = k / 150 % 4;
    heading += kind == 0 ? 0.01 : kind == 1 ? 0.3 * fraction() : 2 * std::numbers::pi * fraction();
    double length = kind == 2 ? 0.1 * fraction() : 0.04;
    if (kind == 3) length = fraction() < 0.1 ? 20 * fraction() : 0.5 * fraction();
    at.x = std::clamp(at.x + length * std::cos(heading), -6.0, 30.0);
    at.y = std::clamp(at.y + length * std::sin(heading), -4.0, 22.0);
    all.push_back(at);
  }
  return all;
}

double distance_to(Point3 a, Point3 b, double x, double y) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double along = length2 > 0.0 ? ((x - a.x) * dx + (y - a.y) * dy) / length2 : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(x - a.x - t * dx, y - a.y - t * dy);
}

/// The first motion within `radius` of a point, and whether rounding may select another one.
struct First {
  std::uint32_t step = kNone;
  bool is_doubtful = false;
};
First first_over(const std::vector<Point3>& moves, double radius, double x, double y) {
  constexpr double kRounding = 1e-5;
  First first;
  for (std::size_t k = 1; k < moves.size() && first.step == kNone; ++k) {
    const double distance = distance_to(moves[k - 1], moves[k], x, y);
    first.is_doubtful = first.is_doubtful || std::abs(distance - radius) < kRounding;
    if (distance < radius) first.step = static_cast<std::uint32_t>(k + 1);  // after tool change and rapid
  }
  return first;
}

class Cylinders : public testing::TestWithParam<double> {};

TEST_P(Cylinders, TheFirstMotionOverAColumnCutsIt) {
  const std::vector<Point3> moves = wandering(1800);
  ToolTable tools;
  tools.set(1, keyhole_cutter());
  Path path;
  path.tool(1).rapid(moves[0]);
  for (std::size_t k = 1; k < moves.size(); ++k) path.cut(moves[k]);
  Diagnostics diagnostics;
  const auto result =
      run(path.path(), tools, block({0, 0, 0}, {24, 18, kHeight}), GetParam(), diagnostics, 2);
  ASSERT_TRUE(result);
  const ColumnGrid grid = result->workpiece.grid();
  int checked = 0, roofed = 0;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const double x = grid.column_x(i), y = grid.column_y(j);
      const First head = first_over(moves, kHead, x, y), neck = first_over(moves, kNeck, x, y);
      if (head.is_doubtful || neck.is_doubtful) continue;
      ++checked;
      const std::vector<Interval> runs = result->workpiece.column(i, j);
      const std::size_t expected = head.step != kNone && neck.step == kNone ? 2 : 1;
      ASSERT_EQ(runs.size(), expected) << x << " " << y;
      if (head.step == kNone) {
        ASSERT_EQ(runs[0].high_step, kStockSurface) << x << " " << y;
        continue;
      }
      ASSERT_EQ(runs[0].high_step, head.step) << x << " " << y;
      ASSERT_NEAR(runs[0].high, kFloor, 1e-5);
      if (expected == 1) continue;
      ++roofed;
      ASSERT_EQ(runs[1].low_step, head.step) << x << " " << y;
      ASSERT_NEAR(runs[1].low, kShoulder, 1e-5);
      ASSERT_NEAR(runs[1].high, kHeight, 1e-5);
    }
  }
  EXPECT_GT(checked, 0.99 * grid.nx * grid.ny);
  EXPECT_GT(roofed, 0.05 * checked);
}

INSTANTIATE_TEST_SUITE_P(Pitches, Cylinders, testing::Values(0.13, 0.25, 0.6));

}  // namespace
}  // namespace kerf::test
