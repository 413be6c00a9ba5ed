// Arc walks: directions in the three planes, full circles, helices, bounds and chords.
#include <gtest/gtest.h>
#include <numbers>

#include "kerf/geom/geometry.h"

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(ArcWalk, TurnsCounterClockwiseSeenFromTheThirdAxis) {
  const ArcWalk xy = walk_arc({1, 0, 0}, {0, 1, 0}, {0, 0}, Plane::xy, Turn::ccw, 0);
  EXPECT_NEAR(xy.sweep, kPi / 2, 1e-12);
  // Seen from +Y, Z turned counter-clockwise arrives at X.
  const ArcWalk xz = walk_arc({0, 0, 1}, {1, 0, 0}, {0, 0}, Plane::xz, Turn::ccw, 0);
  EXPECT_NEAR(xz.sweep, kPi / 2, 1e-12);
  const ArcWalk yz = walk_arc({0, 1, 0}, {0, 0, 1}, {0, 0}, Plane::yz, Turn::ccw, 0);
  EXPECT_NEAR(yz.sweep, kPi / 2, 1e-12);
  EXPECT_NEAR(walk_arc({1, 0, 0}, {0, 1, 0}, {0, 0}, Plane::xy, Turn::cw, 0).sweep, -1.5 * kPi, 1e-12);
}

TEST(ArcWalk, EqualEndsMakeAFullCircleAndTurnsAddUp) {
  EXPECT_NEAR(walk_arc({2, 0, 0}, {2, 0, -3}, {0, 0}, Plane::xy, Turn::cw, 0).sweep, -2 * kPi, 1e-12);
  const ArcWalk helix = walk_arc({2, 0, 0}, {2, 0, -3}, {0, 0}, Plane::xy, Turn::ccw, 2);
  EXPECT_NEAR(helix.sweep, 6 * kPi, 1e-12);
  EXPECT_NEAR(helix.length(), std::hypot(12 * kPi, 3.0), 1e-12);
  EXPECT_NEAR(helix.at(0.5).z, -1.5, 1e-12);
}

TEST(ArcWalk, CentreIsInTheOrderOfThePlanesName) {
  const ArcWalk w = walk_arc({5, 0, 0}, {15, 0, 0}, {10, 0}, Plane::xz, Turn::cw, 0);
  EXPECT_NEAR(w.start_radius, 5.0, 1e-12);
  EXPECT_NEAR(w.end_radius, 5.0, 1e-12);
  EXPECT_NEAR(w.at(0.5).z, -5.0, 1e-12);  // clockwise from -X, seen from +Y: -X, -Z, +X
  EXPECT_NEAR(w.at(0.5).x, 10.0, 1e-12);
}

TEST(ArcWalk, BoundsContainTheExtremes) {
  const Box3 b = walk_arc({1, 0, 0}, {0, -1, 2}, {0, 0}, Plane::xy, Turn::ccw, 0).bounds();
  EXPECT_NEAR(b.low.x, -1, 1e-12);
  EXPECT_NEAR(b.high.y, 1, 1e-12);
  EXPECT_NEAR(b.low.y, -1, 1e-12);
  EXPECT_NEAR(b.high.x, 1, 1e-12);
  EXPECT_NEAR(b.high.z, 2, 1e-12);
}

TEST(ArcWalk, ChordsKeepTheTolerance) {
  const ArcWalk w = walk_arc({10, 0, 0}, {10, 0, 0}, {0, 0}, Plane::xy, Turn::ccw, 0);
  const int n = w.chords(mm(0.01));
  const double sagitta = 10.0 * (1.0 - std::cos(kPi / n));
  EXPECT_LE(sagitta, 0.01);
  EXPECT_GT(10.0 * (1.0 - std::cos(kPi / (n - 1))), 0.01);
}

}  // namespace
}  // namespace kerf
