// Tools as frusta, intersected with rays of any tilt, against geometry by hand.
#include "sim/rotary/rotary_tool.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "../path/jobs.h"

namespace kerf::test {
namespace {

std::vector<sim::RayInterval> intervals(const sim::Frusta& part, const sim::TiltedRay& ray) {
  std::vector<sim::RayInterval> found;
  sim::RayInterval interval{};
  for (std::size_t body = 0; body < part.bodies(); ++body)
    if (part.intersect(body, ray, 100.0, interval)) found.push_back(interval);
  return found;
}

/// A cone of 90 degrees with its tip at Z0, 10 mm high: y^2 + x^2 <= z^2. A ray of the direction (0.6, 0.8)
/// is 3/4 as far to the side as it rises.
TEST(Frusta, ARayThroughACone) {
  const sim::Frusta cone(profile({{0, 0, 0}, {10, 10, 0}}), mm(0.01), Length{});
  const auto found = intervals(cone, {0, 3, 0, -0.6, 0.8});  // enters where 3 - 0.6 r = 0.8 r
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].low, 3 / 1.4, 1e-9);
  EXPECT_NEAR(found[0].high, 12.5, 1e-9);  // at the top
}

/// A ray that rises at the angle of the side crosses the cone once: its equation is linear.
TEST(Frusta, ARayParallelToTheSideOfACone) {
  const sim::Frusta cone(profile({{0, 0, 0}, {10, 10, 0}}), mm(0.01), Length{});
  const double s = std::sqrt(0.5);
  // From Y4 towards the axis and beyond: in the cone from |4 - a| = a, a = 2, where a = s r, to the top.
  const auto in = intervals(cone, {0, 4, 0, -s, s});
  ASSERT_EQ(in.size(), 1u);
  EXPECT_NEAR(in[0].low, 2 / s, 1e-9);
  EXPECT_NEAR(in[0].high, 10 / s, 1e-9);
  // Downwards from Z8 on the axis: |a| = 8 - a, a = 4.
  const auto out = intervals(cone, {0, 0, 8, s, -s});
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].low, 0.0, 1e-9);
  EXPECT_NEAR(out[0].high, 4 / s, 1e-9);
  // Beside it, outwards: 4 + a > a for all a.
  EXPECT_TRUE(intervals(cone, {0, 4, 0, s, s}).empty());
}

}  // namespace
}  // namespace kerf::test
