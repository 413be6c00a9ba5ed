// Isolation of copper: at each point of a grid, whether it is cut, against its distance from the copper.
#include <gtest/gtest.h>
#include <random>

#include "base/codes/op.h"
#include "random_regions.h"
#include "swept.h"

#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

IsolationOptions usual(int passes, double width = 0.0) {
  IsolationOptions options;
  options.cut.depth = mm(0.1), options.cut.feed = mm_per_min(400);
  options.passes = passes, options.width = mm(width);
  return options;
}

/// Points of copper that are cut, and points within the width that remain though the tool could be there.
std::string wrong_copper(const Operation& made, const Region& copper, double radius, double width,
                         double pitch) {
  const std::vector<Motion> cuts = motions(made.path);
  const RegionSearch search(copper), left(made.unreached);
  const Box2 box = bounds(copper).grown(width + 2.0 * radius);
  std::string wrong;
  for (double y = box.low.y; y < box.high.y; y += pitch)
    for (double x = box.low.x; x < box.high.x && wrong.size() < 300; x += pitch) {
      const Point2 p{x, y};
      const double outwards = -search.clearance(p)->mm();
      const auto near_left = left.nearest(p);
      const bool stays = !made.unreached.empty() &&
                         (left.locate(p, mm(1e-6)) == Location::inside || near_left->distance.mm() < 0.01);
      const char* what = nullptr;
      if (outwards < -0.01 && touched(cuts, p, radius - 1e-4, 0.0)) what = "copper is cut";
      if (outwards > 0.01 && outwards < width - 0.01 && !stays && !removed_to(cuts, p, radius + 1e-4, -0.1))
        what = "copper is left";
      if (what != nullptr)
        wrong += std::string(what) + " at " + std::to_string(x) + ", " + std::to_string(y) + "; ";
    }
  return wrong;
}

TEST(Isolation, IsAsWideAsItsPassesAroundAllCopper) {
  const Region copper =
      region_of({as_outline({{0, 0}, mm(2)}), rectangle(5, -3, 12, 3), as_outline({{8, 0}, mm(1)})});
  for (const int passes : {1, 2, 3, 5}) {
    Diagnostics diagnostics;
    const auto made = isolation(copper, mill(0.4), usual(passes), diagnostics);
    ASSERT_TRUE(made) << passes;
    const double width = 0.4 + (passes - 1) * 0.2;
    EXPECT_EQ(wrong_copper(*made, copper, 0.2, width, 0.07), "") << passes;
    // Where all around is copper of no other part, nothing is cut beyond the width.
    const std::vector<Motion> cuts = motions(made->path);
    for (double angle = 2.0; angle < 4.2; angle += 0.1) {
      const Point2 way{std::cos(angle), std::sin(angle)};
      EXPECT_FALSE(touched(cuts, (2.0 + width + 0.01) * way, 0.2 - 1e-4, 0.0)) << passes << " " << angle;
    }
  }
}

TEST(Isolation, RandomCopperIsLeftAndAllAroundItIsCut) {
  std::mt19937_64 random(39);
  for (int i = 0; i < 25; ++i) {
    const Region copper = random_region(random);
    for (const double width : {0.0, 3.7}) {
      Diagnostics diagnostics;
      const auto made = isolation(copper, mill(1.0), usual(i % 3 + 1, width), diagnostics);
      ASSERT_TRUE(made) << i;
      const double wide = width > 0.0 ? width : 1.0 + (i % 3) * 0.5;
      EXPECT_EQ(wrong_copper(*made, copper, 0.5, wide, 0.9), "") << i << " " << width;
    }
  }
}

TEST(Isolation, GapsNarrowerThanTheToolAreOneWarningWithTheNarrowest) {
  std::vector<Outline> pads;
  for (int i = 0; i < 4; ++i) pads.push_back(rectangle(4.0 * i, 0, 4.0 * i + 4.0 - 0.1 * (i + 1), 3));
  for (const int passes : {1, 3}) {
    Diagnostics diagnostics;
    const auto made = isolation(region_of(pads), mill(0.5), usual(passes), diagnostics);
    ASSERT_TRUE(made);
    ASSERT_EQ(diagnostics.list().size(), 1u) << passes;
    const Diagnostic& warning = diagnostics.list().front();
    EXPECT_EQ(warning.code, codes::op_tool_wide);
    EXPECT_NE(warning.message.find("3 parts, the narrowest at 3.95,"), std::string::npos) << warning.message;
    EXPECT_NE(warning.message.find("the largest that fits there has 0.1 mm"), std::string::npos)
        << warning.message;
  }
}

TEST(Isolation, RefusesWidthsBelowTheToolAndOtherImpossibleOptions) {
  const Region pad = region_of({rectangle(0, 0, 3, 3)});
  IsolationOptions overlapping = usual(2);
  overlapping.overlap = 1.0;
  for (const IsolationOptions& options : {usual(0), usual(1, 0.3), usual(1, -1), overlapping}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(isolation(pad, mill(0.5), options, diagnostics));
    ASSERT_FALSE(diagnostics.list().empty());
    EXPECT_EQ(diagnostics.list().front().code, codes::op_option);
  }
}

}  // namespace
}  // namespace kerf
