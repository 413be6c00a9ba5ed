// The assumed tool: wider than the stepover of a pattern, narrower than the distance of single cuts.
#include "path/assumed_tool.h"

#include <cmath>
#include <gtest/gtest.h>

namespace kerf {
namespace {

class Program {
 public:
  Program& rapid(double x, double y, double z) {
    path_.add(step::Rapid{{x, y, z}}, OriginId::none);
    return *this;
  }
  Program& feed(double x, double y, double z) {
    path_.add(step::Cut{{x, y, z}, mm_per_min(300)}, OriginId::none);
    return *this;
  }
  Program& tool(int number) {
    path_.add(step::ToolChange{number}, OriginId::none);
    return *this;
  }
  /// Parallel passes of 60 mm along X, turned by `angle`, to and fro.
  Program& raster(double stepover, int passes, double z, double angle = 0.0) {
    const auto at = [&](double x, double y) {
      return Point2{x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle)};
    };
    const Point2 first = at(0, 0);
    rapid(first.x, first.y, 5).feed(first.x, first.y, z);
    for (int i = 0; i < passes; ++i)
      for (const double x : {i % 2 == 0 ? 0.0 : 60.0, i % 2 == 0 ? 60.0 : 0.0}) {
        const Point2 p = at(x, i * stepover);
        feed(p.x, p.y, z);
      }
    return *this;
  }
  Program& square(double low, double high, double z) {
    rapid(low, low, 5).feed(low, low, z).feed(high, low, z).feed(high, high, z).feed(low, high, z);
    return feed(low, low, z);
  }
  AssumedTool assumed(std::optional<int> tool = std::nullopt) const { return assume_tool(path_, tool); }

 private:
  Toolpath path_;
};

TEST(AssumedTool, IsSlightlyWiderThanTheStepover) {
  for (const double stepover : {0.2, 0.6, 1.5, 6.0})
    for (const double angle : {0.0, 0.4, 1.2}) {
      const AssumedTool assumed = Program().raster(stepover, 30, -0.5, angle).assumed();
      EXPECT_EQ(assumed.basis, AssumedDiameter::stepover) << stepover << " at " << angle;
      EXPECT_GT(assumed.diameter.mm(), stepover);
      EXPECT_LT(assumed.diameter.mm(), 2.0 * stepover);
    }
}

TEST(AssumedTool, IsTheUsualOneForCutsFarApart) {
  EXPECT_EQ(Program().square(0, 60, -3).assumed().diameter, kUsualDiameter);
  EXPECT_EQ(Program().square(0, 60, -1).square(0, 60, -2).assumed().diameter, kUsualDiameter);  // two passes
  EXPECT_EQ(Program().assumed().diameter, kUsualDiameter);                                      // no cut
  EXPECT_EQ(Program().square(0, 60, -3).assumed().basis, AssumedDiameter::usual);
}

TEST(AssumedTool, LeavesMaterialBetweenCutsThatAreClose) {
  // The two sides of a track of 0.8 mm.
  const AssumedTool track = Program()
                                .rapid(0, 0, 2)
                                .feed(0, 0, -0.1)
                                .feed(50, 0, -0.1)
                                .feed(50, 0.8, -0.1)
                                .feed(0, 0.8, -0.1)
                                .assumed();
  EXPECT_EQ(track.basis, AssumedDiameter::spacing);
  EXPECT_LT(track.diameter.mm(), 0.8);
  Program holes;
  for (int i = 0; i < 8; ++i) holes.rapid(2.54 * i, 0, 2).feed(2.54 * i, 0, -2).feed(2.54 * i, 0, 2);
  EXPECT_LT(holes.assumed().diameter.mm(), 2.54);
  EXPECT_GT(holes.assumed().diameter.mm(), 0.5);
}

TEST(AssumedTool, HasAFluteForTheDeepestCutAndIsNotTooSlender) {
  const AssumedTool deep = Program().square(0, 60, -38).assumed();
  EXPECT_GE(std::get<shape::Square>(deep.shape).flute.mm(), 38.0);
  const AssumedTool close = Program().square(0, 60, -20).square(0.1, 59.9, -20).assumed();
  EXPECT_GE(close.diameter.mm(), 2.0);  // a finishing pass, not a track: 20 mm deep with a tool of 0.05 mm
}

TEST(AssumedTool, LooksAtTheCutsOfItsNumberOnly) {
  const Program two = Program().tool(1).raster(0.4, 30, -0.5).tool(2).square(0, 60, -1);
  EXPECT_EQ(two.assumed(1).basis, AssumedDiameter::stepover);
  EXPECT_EQ(two.assumed(2).basis, AssumedDiameter::usual);
}

TEST(AssumedTool, TakesAnyNumbers) {
  Program wild;
  wild.rapid(0, 0, 5);
  for (int i = 0; i < 300; ++i) wild.feed(1e8 * std::sin(i), 1e8 * std::cos(7 * i), -i);
  EXPECT_GT(wild.assumed().diameter.mm(), 0.0);
  Program tiny;
  for (int i = 0; i < 300; ++i) tiny.feed(1e-7 * i, 1e-7 * (i % 3), -1);
  EXPECT_GT(tiny.assumed().diameter.mm(), 0.0);
}

}  // namespace
}  // namespace kerf
