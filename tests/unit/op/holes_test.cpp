// Drilled and bored holes.
#include "kerf/op/holes.h"

#include <gtest/gtest.h>

#include "base/codes/op.h"
#include "swept.h"

namespace kerf {
namespace {

using namespace test;

TEST(Drill, EachPointIsDrilledOnceToItsDepth) {
  DrillOptions options{
      .kind = DrillKind::peck, .top = 1, .depth = mm(10), .peck = mm(3), .feed = mm_per_min(100)};
  Diagnostics diagnostics;
  const auto made = drill({{0, 0}, {30, 0}, {10, 0}, {20, 0}}, mill(3), options, diagnostics);
  ASSERT_TRUE(made);
  std::vector<double> bottoms;
  double travel = 0.0;
  for (const Motion& m : motions(made->path)) {
    if (!m.rapid && m.to.z == -9.0) bottoms.push_back(m.to.x);
    if (m.rapid && m.from.xy() != m.to.xy()) {
      travel += distance(m.from.xy(), m.to.xy());
      EXPECT_EQ(m.low(), 5.0);
    }
  }
  // In the order of the way, not of the list.
  EXPECT_EQ(bottoms, (std::vector<double>{0, 10, 20, 30}));
  EXPECT_NEAR(travel, 30, 1e-9);
}

TEST(Drill, BadInputIsAnError) {
  const DrillOptions good{.depth = mm(10), .feed = mm_per_min(100)};
  const auto code = [](const std::vector<Point2>& points, const DrillOptions& options) {
    Diagnostics diagnostics;
    EXPECT_FALSE(drill(points, mill(3), options, diagnostics));
    return diagnostics.list().empty() ? Code{} : diagnostics.list().front().code;
  };
  EXPECT_EQ(code({}, good), codes::op_empty);
  EXPECT_EQ(code({{INFINITY, 0}}, good), codes::op_option);
  DrillOptions bad = good;
  bad.kind = DrillKind::peck;
  EXPECT_EQ(code({{0, 0}}, bad), codes::op_option);
  bad.peck = mm(1e-12);
  EXPECT_NE(code({{0, 0}}, bad), Code{});
  bad = good;
  bad.kind = DrillKind::back_bore;
  EXPECT_EQ(code({{0, 0}}, bad), codes::op_option);
}

double lowest(const Toolpath& path) {
  double z = INFINITY;
  for (const Motion& m : motions(path)) z = std::min(z, m.to.z);
  return z;
}

TEST(Drill, TheFullDiameterReachesTheDepthWhereItIsAskedFor) {
  DrillOptions options{.depth = mm(8), .depth_of = DrillDepth::diameter, .feed = mm_per_min(100)};
  Diagnostics diagnostics;
  // The point of a drill of 6 mm and 118 degrees is 3 / tan 59 = 1.8026 mm high, of 90 degrees 3 mm.
  for (const auto& [angle, bottom] : {std::pair(118.0, -9.8026), {90.0, -11.0}}) {
    const auto hole =
        drill({{0, 0}}, made(shape::Drill{mm(6), mm(60), degrees(angle)}), options, diagnostics);
    ASSERT_TRUE(hole);
    EXPECT_NEAR(lowest(hole->path), bottom, 1e-4);
  }
  EXPECT_NEAR(lowest(drill({{0, 0}}, mill(3), options, diagnostics)->path), -8.0, 1e-9);
  EXPECT_NEAR(lowest(drill({{0, 0}}, made(shape::Ball{mm(4), mm(20)}), options, diagnostics)->path), -10.0,
              1e-9);
  options.depth_of = DrillDepth::tip;
  const Tool twist = made(shape::Drill{mm(6), mm(60), degrees(118)});
  EXPECT_NEAR(lowest(drill({{0, 0}}, twist, options, diagnostics)->path), -8.0, 1e-9);
  EXPECT_TRUE(diagnostics.list().empty());
}

TEST(Drill, ToolsThatDoNotCutAtTheirCentreAreRefused) {
  const DrillOptions options{.depth = mm(4), .feed = mm_per_min(100)};
  for (const ToolShape& shape : {ToolShape(shape::TSlot{mm(12), mm(4), mm(5), mm(10)}),
                                 ToolShape(shape::Dovetail{mm(12), mm(8), degrees(10)}),
                                 ToolShape(shape::ThreadMill{mm(4), mm(6), mm(1), mm(15)})}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(drill({{0, 0}}, made(shape), options, diagnostics));
    ASSERT_EQ(diagnostics.list().size(), 1u);
    EXPECT_EQ(diagnostics.list().front().code, codes::op_tool_kind);
  }
}

TEST(Bore, AHoleHasItsDiameterAndAFlatBottom) {
  for (const double diameter : {7.0, 12.0, 30.0}) {
    BoreOptions options;
    options.cut.depth = mm(5), options.cut.stepdown = mm(1), options.cut.feed = mm_per_min(500);
    Diagnostics diagnostics;
    const auto made = bore({{{10, 20}, mm(diameter / 2)}}, mill(6), options, diagnostics);
    ASSERT_TRUE(made);
    const Region hole = region_of({as_outline({{10, 20}, mm(diameter / 2)})});
    // Points that only the last turn of a helix covers are lower than its top; judged at the flat bottom.
    const std::vector<Motion> cuts = motions(made->path);
    for (double x = -8; x < 28; x += 0.31)
      for (double y = 2; y < 38; y += 0.31) {
        const double d = distance(Point2{x, y}, Point2{10, 20});
        if (d > diameter / 2 + 0.001) {
          ASSERT_FALSE(touched(cuts, {x, y}, 2.9999, 0));
        }
        if (d < diameter / 2 - 0.001) {
          ASSERT_TRUE(removed_to(cuts, {x, y}, 3.0001, -5)) << diameter << " " << x << " " << y;
        }
      }
  }
}

TEST(Bore, AHoleNoLargerThanTheToolIsAnError) {
  BoreOptions options;
  options.cut.depth = mm(5), options.cut.feed = mm_per_min(500);
  Diagnostics diagnostics;
  EXPECT_FALSE(bore({{{10, 20}, mm(3)}}, mill(6), options, diagnostics));
  EXPECT_EQ(diagnostics.list().front().code, codes::op_tool_wide);
  EXPECT_FALSE(bore({}, mill(6), options, diagnostics));
}

}  // namespace
}  // namespace kerf
