// Surfaces through measured points.
#include <gtest/gtest.h>

#include "kerf/op/level.h"

namespace kerf {
namespace {

std::optional<HeightMap> map_of(const std::vector<Point3>& points) {
  Diagnostics diagnostics;
  return HeightMap::make(points, {}, diagnostics);
}

/// z = 3 + x y / 8 is bilinear: it is exact in the cells of a grid. Outside it is that of the nearest
/// position.
TEST(HeightMap, AGridIsBilinearInEachCell) {
  const auto surface = [](double x, double y) { return 3 + x * y / 8; };
  std::vector<Point3> points;
  for (const double y : {-4.0, 0.0, 6.0})
    for (const double x : {0.0, 2.0, 5.0}) points.push_back({x, y, surface(x, y)});
  const auto map = map_of(points);
  ASSERT_TRUE(map);
  for (double x = 0.0; x <= 5.0; x += 0.25)
    for (double y = -4.0; y <= 6.0; y += 0.25)
      EXPECT_NEAR(map->at({x, y}), surface(x, y), 1e-12) << x << " " << y;
  EXPECT_NEAR(map->at({9, 20}), surface(5, 6), 1e-12);
  EXPECT_NEAR(map->at({-1, 3}), surface(0, 3), 1e-12);
}

TEST(HeightMap, APlaneIsExactBetweenScatteredPoints) {
  const auto surface = [](double x, double y) { return 0.5 * x - 0.25 * y + 1; };
  std::vector<Point3> points;
  for (const Point2 p : {Point2{0, 0}, {10, 1}, {11, 9}, {1, 8}, {4, 5}, {7, 3}, {6, 7}})
    points.push_back({p.x, p.y, surface(p.x, p.y)});
  const auto map = map_of(points);
  ASSERT_TRUE(map);
  for (double x = 2.0; x <= 9.0; x += 0.5)
    for (double y = 2.0; y <= 7.0; y += 0.5)
      EXPECT_NEAR(map->at({x, y}), surface(x, y), 1e-9) << x << " " << y;
}

TEST(HeightMap, PointsOnALineAreAProfile) {
  const auto map = map_of({{0, 0, 1}, {6, 8, 3}, {3, 4, 0}});  // 0, 10 and 5 mm along it
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->at({1.5, 2}), 0.5, 1e-12);
  EXPECT_NEAR(map->at({4.5, 6}), 1.5, 1e-12);
  EXPECT_NEAR(map->at({4.5 - 8, 6 + 6}), 1.5, 1e-12) << "beside the line";
  EXPECT_NEAR(map->at({-3, -4}), 1, 1e-12);
  EXPECT_NEAR(map->at({30, 40}), 3, 1e-12);
}

}  // namespace
}  // namespace kerf
