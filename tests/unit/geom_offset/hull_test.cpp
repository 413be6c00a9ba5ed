// Convex hulls and Minkowski sums whose areas are known in closed form.
#include "geom/offset/hull.h"

#include <cmath>
#include <gtest/gtest.h>

#include "../geom_region/region_samples.h"
#include "base/codes/outline.h"

namespace kerf {
namespace {

class Hulls : public RegionTest {
 protected:
  Region disc(double x, double y, double r) { return {{circle(x, y, r)}}; }
  Region hull(const std::vector<Region>& regions) { return *convex_hull(regions, {}, diagnostics); }
  Region sum(const Region& a, const Region& b) { return *minkowski_sum(a, b, mm(0.001), {}, diagnostics); }
};

TEST_F(Hulls, OfTwoCirclesIsASlotOfArcs) {
  const Region slot = hull({disc(0, 0, 5), disc(20, 0, 5)});
  EXPECT_NEAR(area(slot), 200.0 + 25.0 * kPi, 1e-9);
  ASSERT_EQ(slot.loops.size(), 1u);
  EXPECT_LE(slot.loops[0].segments.size(), 6u);
  // Of other radii: the tangents leave the circles at the angle with the cosine (r1 - r2) / distance.
  const double a = std::acos(3.0 / 20.0);
  EXPECT_NEAR(area(hull({disc(1, 2, 5), disc(1, 22, 2)})),
              25.0 * (kPi - a) + 4.0 * a + 7.0 * 20.0 * std::sin(a), 1e-9);
}

TEST_F(Hulls, AreThoseOfCornersAndArcs) {
  EXPECT_NEAR(area(hull({made({rectangle(0, 0, 10, 10)}), made({rectangle(20, 0, 10, 10)})})), 300.0, 1e-9);
  // A circle in the corner of a square changes nothing; one beyond a side adds two tangents.
  EXPECT_NEAR(area(hull({made({rectangle(0, 0, 10, 10)}), disc(5, 5, 3)})), 100.0, 1e-9);
  EXPECT_NEAR(area(hull({disc(3, 4, 7)})), 49.0 * kPi, 1e-9);
  EXPECT_NEAR(area(hull({disc(0, 0, 7), disc(1, 1, 2)})), 49.0 * kPi, 1e-9);
  EXPECT_TRUE(hull({}).empty());
  // A half disc, its arc upwards: its hull is itself.
  Outline half{{5, 0}, {{{-5, 0}, Point2{0, 5}}, {{5, 0}, {}}}};
  EXPECT_NEAR(area(hull({made({half})})), 12.5 * kPi, 1e-9);
  // An arch: below the straight line between its feet, the concave arc vanishes.
  Outline arch{{10, 0}, {{{-10, 0}, Point2{0, 10}}, {{-5, 0}, {}}, {{5, 0}, Point2{0, 5}}}};
  arch.segments.push_back({{10, 0}, {}});
  EXPECT_NEAR(area(hull({made({arch})})), 50.0 * kPi, 1e-9);
}

TEST_F(Hulls, OfManyCirclesHaveNoKinks) {
  std::vector<Region> regions;
  double expected = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double angle = kPi / 3.0 * i;
    regions.push_back(disc(30 * std::cos(angle), 30 * std::sin(angle), 4));
  }
  expected = 1.5 * std::sqrt(3.0) * 900.0 + 6.0 * 30.0 * 4.0 + 16.0 * kPi;  // hexagon, strips, corners
  EXPECT_NEAR(area(hull(regions)), expected, 1e-8);
}

TEST_F(Hulls, SumsWithCirclesAreOffsets) {
  const Region square = made({rectangle(0, 0, 10, 10)});
  EXPECT_NEAR(area(sum(square, disc(0, 0, 2))), 180.0 + 4.0 * kPi, 1e-9);
  const Region moved = sum(disc(100, 0, 2), square);
  EXPECT_NEAR(area(moved), 180.0 + 4.0 * kPi, 1e-9);
  EXPECT_NEAR(bounds(moved).low.x, 98.0, 1e-9);
}

TEST_F(Hulls, SumsOfPolygons) {
  const Region square = made({rectangle(0, 0, 10, 10)}), tool = made({rectangle(-1, -1, 2, 2)});
  EXPECT_NEAR(area(sum(square, tool)), 144.0, 1e-9);
  const Region ring = made({rectangle(0, 0, 20, 20), rectangle(5, 5, 10, 10)}, FillRule::even_odd);
  EXPECT_NEAR(area(sum(ring, tool)), 22.0 * 22.0 - 8.0 * 8.0, 1e-9);
  // Two parts, each moved by the corner of the other.
  const Region two = made({rectangle(0, 0, 1, 1), rectangle(10, 0, 1, 1)});
  EXPECT_NEAR(area(sum(two, made({rectangle(0, 0, 2, 3)}))), 24.0, 1e-9);
}

}  // namespace
}  // namespace kerf
