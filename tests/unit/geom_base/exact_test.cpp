// Orientation of points where floating-point rounding would decide.
#include "geom/base/exact.h"

#include <gtest/gtest.h>

namespace kerf::region_detail {
namespace {

TEST(Orientation, OfPlainTriangles) {
  EXPECT_GT(orientation({0, 0}, {1, 0}, {0, 1}), 0.0);
  EXPECT_LT(orientation({0, 0}, {0, 1}, {1, 0}), 0.0);
  EXPECT_EQ(orientation({0, 0}, {1, 1}, {2, 2}), 0.0);
}

TEST(Orientation, OfPointsOneRoundingUnitOffALine) {
  // Steps of one unit of rounding around a point of the diagonal: the sign is that of y - x, exactly.
  const double unit = 0x1p-53;
  for (int i = -8; i <= 8; ++i)
    for (int k = -8; k <= 8; ++k) {
      const Point2 p{0.5 + i * unit, 0.5 + k * unit};
      const double found = orientation({12, 12}, {24, 24}, p);
      EXPECT_EQ(found > 0.0, k > i) << i << " " << k;
      EXPECT_EQ(found < 0.0, k < i) << i << " " << k;
    }
}

TEST(Orientation, CancelsFarFromTheOrigin) {
  const double far = 0x1p40;
  EXPECT_EQ(orientation({far, far}, {far + 1, far + 1}, {-far, -far}), 0.0);
  EXPECT_GT(orientation({far, far}, {far + 1, far + 1}, {-far, -far + 0x1p-12}), 0.0);
}

}  // namespace
}  // namespace kerf::region_detail
