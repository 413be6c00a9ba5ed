// Rows over surfaces: where the tip of a tool is that touches planes and spheres, by geometry.
#include "op/mesh/surface_rows.h"

#include <cmath>
#include <gtest/gtest.h>

#include "base/codes/op.h"

namespace kerf {
namespace {

Tool ball(double diameter) {
  Diagnostics diagnostics;
  return *make_tool(1, shape::Ball{mm(diameter), mm(20)}, {}, {}, diagnostics);
}
Tool square(double diameter) {
  Diagnostics diagnostics;
  return *make_tool(1, shape::Square{mm(diameter), mm(20)}, {}, {}, diagnostics);
}

TEST(SurfaceRows, AreAtTheHeightOfALevelSurface) {
  Diagnostics diagnostics;
  const auto rows = surface_rows([](Point2) { return -2.0; }, ball(6), {{0, 0}, {30, 12}, 0.5}, diagnostics);
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->size(), 5u);  // 0, 3, 6, 9, 12
  for (std::size_t i = 0; i < rows->size(); ++i) {
    ASSERT_EQ((*rows)[i].size(), 2u) << "a straight row has two points";
    const Point3 first{i % 2 == 0 ? 0.0 : 30.0, 3.0 * static_cast<double>(i), -2.0};
    EXPECT_EQ((*rows)[i][0], first);
  }
}

TEST(SurfaceRows, ASquareToolStandsOnTheHigherSideOfASlope) {
  Diagnostics diagnostics;
  const auto rows =
      surface_rows([](Point2 p) { return p.x / 2; }, square(4), {{0, 0}, {20, 4}, 1.0}, diagnostics);
  ASSERT_TRUE(rows);
  EXPECT_NEAR(rows->front().front().z, 1.0, 1e-6) << "its edge is 2 mm to the right";
  EXPECT_NEAR(rows->front().back().z, 11.0, 1e-6);
}

TEST(SurfaceRows, ABallOnASlopeTouchesBesideItsAxis) {
  Diagnostics diagnostics;
  const auto rows =
      surface_rows([](Point2 p) { return p.x / 2; }, ball(6), {{0, 0}, {20, 6}, 1.0}, diagnostics);
  ASSERT_TRUE(rows);
  // A sphere on a plane z = x / 2: its centre is r * sqrt(1 + 1/4) above it.
  EXPECT_NEAR(rows->front().front().z, 3 * std::sqrt(1.25) - 3, 0.01);
}

TEST(SurfaceRows, WrongOptionsAreRefused) {
  const auto codes = [](HeightFunction surface, SurfaceRowOptions options) {
    Diagnostics diagnostics;
    EXPECT_FALSE(surface_rows(surface, ball(6), options, diagnostics));
    return diagnostics.list().at(0).code;
  };
  const HeightFunction level = [](Point2) { return 0.0; };
  EXPECT_EQ(codes(level, {{0, 0}, {0, 10}, 0.1}), codes::op_option);
  EXPECT_EQ(codes(level, {{0, 0}, {10, NAN}, 0.1}), codes::op_option);
  EXPECT_EQ(codes(level, {{0, 0}, {10, 10}, 0.0}), codes::op_option);
  EXPECT_EQ(codes(level, {{0, 0}, {10, 10}, 1.5}), codes::op_option);
  EXPECT_EQ(codes(level, {{0, 0}, {90'000, 90'000}, 0.1}), codes::op_limit);
  EXPECT_EQ(codes([](Point2 p) { return std::sqrt(p.x); }, {{-10, -10}, {10, 10}, 0.1}), codes::op_option);
}

}  // namespace
}  // namespace kerf
