// Adaptive pockets: the engagement measured in a picture of the material, what is cut and what stays.
#include <gtest/gtest.h>
#include <random>

#include "base/codes/op.h"
#include "engagement_meter.h"
#include "op/mill/engagement.h"
#include "random_regions.h"
#include "swept.h"

#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

constexpr double kPictureError = 3.0;  // degrees, of the measured angle

PocketOptions adaptive(double engagement, double depth = 2.0) {
  PocketOptions options;
  options.cut.depth = mm(depth), options.cut.feed = mm_per_min(900), options.cut.plunge = mm_per_min(300);
  options.pattern = PocketPattern::adaptive, options.stepover = 1.0;
  options.engagement = degrees(engagement);
  return options;
}

/// The problems of an adaptive pocket of one pass, or nothing.
std::string problems(const Operation& made, const Region& region, double radius,
                     const PocketOptions& options) {
  const double bottom = -options.cut.depth.mm();
  std::string wrong = wrong_points(made.path, region, made.unreached, radius, 0, bottom, 0.91);
  wrong += rapid_problem(made.path, radius, 0);
  EngagementMeter meter(region, radius);
  if (const double highest = meter.largest(made.path, bottom);
      highest > options.engagement.deg() + kPictureError)
    wrong += "engagement " + std::to_string(highest) + " at " + std::to_string(meter.where.x) + ", " +
             std::to_string(meter.where.y);
  return wrong;
}

TEST(Adaptive, TheMeterSeesAFullSlotAndAHalfOne) {
  Diagnostics diagnostics;
  const Region region = region_of({rectangle(0, 0, 30, 20)});
  const auto rings = pocket(region, mill(4), {.cut = adaptive(60).cut, .stepover = 0.5}, diagnostics);
  ASSERT_TRUE(rings);
  EXPECT_GT(EngagementMeter(region, 2).largest(rings->path, -2), 170);
  // A straight cut that overlaps a slot by half of the diameter.
  Toolpath path;
  path.add(step::Rapid{{-5, 5, -2}}, OriginId::none);
  path.add(step::Cut{{35, 5, -2}, mm_per_min(100)}, OriginId::none);
  path.add(step::Rapid{{35, 7, -2}}, OriginId::none);
  path.add(step::Cut{{-5, 7, -2}, mm_per_min(100)}, OriginId::none);
  EngagementMeter meter(region, 2);
  EXPECT_NEAR(meter.largest(path, -2), 180, 1);
  Toolpath second;
  second.add(step::Rapid{{-5, 9, -2}}, OriginId::none);
  second.add(step::Cut{{35, 9, -2}, mm_per_min(100)}, OriginId::none);
  EXPECT_NEAR(meter.largest(second, -2), 90, 3);
}

TEST(Adaptive, TheBoundIsThatOfAStraightWallForLargeCircles) {
  // A straight cut of width w engages acos(1 - w / r).
  EXPECT_NEAR(op_detail::largest_engagement(1, 1e7, 1e-3), std::acos(1 - 1e-3), 1e-3);
  for (const double limit : {0.3, 0.6, 1.0, 1.5})
    for (const double cleared : {4.0, 1.0, 0.1}) {
      const double step = op_detail::step_within(1, cleared, limit);
      EXPECT_GT(step, 0);
      EXPECT_LE(op_detail::largest_engagement(1, cleared, step), limit);
      EXPECT_LT(step, 1 - std::cos(limit));
    }
}

TEST(Adaptive, ARectangleIsClearedWithinTheLimit) {
  const Region region = region_of({rectangle(0, 0, 36, 24)});
  for (const double limit : {30.0, 60.0, 90.0})
    for (const CutDirection direction : {CutDirection::climb, CutDirection::conventional}) {
      PocketOptions options = adaptive(limit);
      options.cut.direction = direction;
      Diagnostics diagnostics;
      const auto made = pocket(region, mill(4), options, diagnostics);
      ASSERT_TRUE(made);
      EXPECT_TRUE(diagnostics.list().empty());
      EXPECT_EQ(problems(*made, region, 2, options), "") << limit;
    }
}

/// Shapes that are hard for an adaptive clearing.
std::vector<Region> degenerate_regions() {
  return {
      // A slot exactly as wide as the tool between two squares, and one between that and the narrowest.
      region_of({polygon({{0, 0},
                          {14, 0},
                          {14, 5},
                          {24, 5},
                          {24, 0},
                          {38, 0},
                          {38, 14},
                          {24, 14},
                          {24, 9},
                          {14, 9},
                          {14, 14},
                          {0, 14}})}),
      region_of({polygon({{0, 0}, {14, 0}, {14, 5}, {34, 5}, {34, 9.3}, {14, 9.3}, {14, 14}, {0, 14}})}),
      // A slot for trochoidal loops, straight and with a corner.
      region_of({rectangle(0, 0, 36, 5)}),
      region_of({polygon({{0, 0}, {30, 0}, {30, 25}, {25, 25}, {25, 5}, {0, 5}})}),
      // Islands that touch each other and a wall.
      region_of({rectangle(0, 0, 40, 24), rectangle(10, 8, 18, 16), rectangle(18, 8, 26, 16)}),
      region_of({rectangle(0, 0, 40, 24), polygon({{0, 8}, {8, 8}, {8, 16}, {0, 16}})}),
      // An acute corner, a star, a ring, a disc, a disc barely larger than the tool.
      region_of({polygon({{0, 0}, {40, 0}, {0, 12}})}),
      region_of({polygon({{0, 14},
                          {18, 14},
                          {24, 0},
                          {30, 14},
                          {48, 14},
                          {34, 24},
                          {39, 40},
                          {24, 30},
                          {9, 40},
                          {14, 24}})}),
      region_of({as_outline({{20, 20}, mm(18)}), as_outline({{20, 20}, mm(9)})}),
      region_of({as_outline({{0, 0}, mm(12)})}),
      region_of({as_outline({{0, 0}, mm(2.4)})}),
      // Chambers with necks from wide to none.
      region_of({polygon({{0, 0},
                          {12, 0},
                          {12, 4},
                          {16, 4},
                          {16, 0},
                          {28, 0},
                          {28, 12},
                          {16, 12},
                          {16, 9},
                          {12, 9},
                          {12, 12},
                          {0, 12}})}),
  };
}

TEST(Adaptive, DegenerateRegionsAreClearedWithinTheLimit) {
  int number = 0;
  for (const Region& region : degenerate_regions()) {
    const PocketOptions options = adaptive(number % 2 == 0 ? 60 : 40);
    Diagnostics diagnostics;
    const auto made = pocket(region, mill(4), options, diagnostics);
    ASSERT_TRUE(made) << number << to_string(diagnostics.list().front());
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_EQ(problems(*made, region, 2, options), "") << number;
    ++number;
  }
}

TEST(Adaptive, RandomRegionsAreClearedWithinTheLimit) {
  std::mt19937_64 random(20261123);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int cut_count = 0;
  for (int i = 0; i < 16; ++i) {
    const Region region = random_region(random);
    const double diameter = in(3, 7);
    PocketOptions options = adaptive(in(25, 90));
    if (in(0, 1) < 0.4) options.cut.direction = CutDirection::conventional;
    if (in(0, 1) < 0.3) options.stepover = in(0.05, 0.3);
    Diagnostics diagnostics;
    const auto made = pocket(region, mill(diameter), options, diagnostics);
    if (!made) {
      for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, codes::op_tool_wide) << to_string(d);
      continue;
    }
    ++cut_count;
    EXPECT_EQ(problems(*made, region, 0.5 * diameter, options), "") << i;
  }
  EXPECT_GT(cut_count, 10);
}

TEST(Adaptive, SlotsTooNarrowForTheLimitAreNamed) {
  // A slot of 4.3 mm beside a square: 4.3 / 1.125 is the largest diameter that keeps the limit there.
  const Region region =
      region_of({polygon({{0, 0}, {14, 0}, {14, 5}, {34, 5}, {34, 9.3}, {14, 9.3}, {14, 14}, {0, 14}})});
  Diagnostics diagnostics;
  const auto made = pocket(region, mill(4), adaptive(60), diagnostics);
  ASSERT_TRUE(made);
  ASSERT_EQ(diagnostics.warnings(), 1u);
  EXPECT_EQ(diagnostics.list().front().code, codes::op_tool_wide);
  const std::string message = diagnostics.list().front().message;
  EXPECT_NE(message.find("largest that does has 3.822 mm"), std::string::npos) << message;
  ASSERT_EQ(made->narrow.size(), 1u);
  // That one does.
  Diagnostics unused;
  EXPECT_TRUE(pocket(region, mill(3.82), adaptive(60), unused));
  EXPECT_TRUE(unused.list().empty());
  // Where there is nothing else, it is an error.
  Diagnostics found;
  EXPECT_FALSE(pocket(region_of({rectangle(0, 0, 30, 4.3)}), mill(4), adaptive(60), found));
  EXPECT_EQ(found.errors(), 1u);
}

TEST(Adaptive, PassesRepeatThePlanAndStopAtLimits) {
  const Region region = region_of({rectangle(0, 0, 30, 20), as_outline({{15, 10}, mm(3)})});
  PocketOptions options = adaptive(60, 6);
  options.cut.stepdown = mm(2);
  Diagnostics diagnostics;
  const auto made = pocket(region, mill(4), options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(wrong_points(made->path, region, made->unreached, 2, 0, -6, 0.61), "");
  EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
  const auto code = [&](const Region& r, const PocketOptions& bad) {
    Diagnostics found;
    EXPECT_FALSE(pocket(r, mill(4), bad, found));
    return found.list().empty() ? Code{} : found.list().front().code;
  };
  for (const double angle : {0.0, -40.0, 14.0, 91.0, std::nan(""), double{INFINITY}})
    EXPECT_EQ(code(region, adaptive(angle)), codes::op_option) << angle;
  PocketOptions few = options;
  few.cut.max_steps = 20;
  EXPECT_EQ(code(region, few), codes::op_limit);
  PocketOptions fine = options;
  fine.stepover = 1e-6;
  EXPECT_EQ(code(region_of({rectangle(0, 0, 200, 200)}), fine), codes::op_limit);
  EXPECT_EQ(code(region_of({rectangle(0, 0, 1e6, 1e6)}), options), codes::op_limit);
  EXPECT_EQ(code({}, options), codes::op_empty);
  Region open = region;
  open.loops[0].segments.pop_back();
  EXPECT_EQ(code(open, options), codes::op_open);
}

TEST(Adaptive, StepoversThatAreNoneAreRefused) {
  const Region region = region_of({rectangle(0, 0, 36, 24)});
  for (const double stepover : {0.0, -0.4, 1.01, std::nan(""), double{INFINITY}}) {
    PocketOptions options = adaptive(60);
    options.stepover = stepover;
    Diagnostics diagnostics;
    EXPECT_FALSE(pocket(region, mill(4), options, diagnostics)) << stepover;
    ASSERT_EQ(diagnostics.errors(), 1u) << stepover;
    EXPECT_EQ(diagnostics.list().front().code, codes::op_option);
    EXPECT_NE(diagnostics.list().front().message.find("stepover"), std::string::npos);
  }
}

TEST(Adaptive, OutlinesThatIntersectThemselvesAreClearedByTheirFillRule) {
  // A figure of eight of two right triangles, and a loop whose overlap is a hole by even-odd.
  const Outline eight = polygon({{0, 0}, {40, 30}, {40, 0}, {0, 30}});
  const Outline loop = polygon({{0, 0}, {40, 0}, {40, 30}, {8, 30}, {8, 8}, {30, 8}, {30, 22}, {0, 22}});
  const auto material = [](const Outline& outline, FillRule rule) {
    Diagnostics diagnostics;
    return *make_region({outline}, rule, {}, diagnostics);
  };
  EXPECT_NEAR(area(material(eight, FillRule::even_odd)), 600, 1e-6);
  for (const Outline& outline : {eight, loop})
    for (const FillRule rule : {FillRule::nonzero, FillRule::even_odd}) {
      const Region region = material(outline, rule);
      const PocketOptions options = adaptive(60);
      Diagnostics diagnostics;
      const auto made = pocket(region, mill(4), options, diagnostics);
      ASSERT_TRUE(made) << to_string(diagnostics.list().front());
      EXPECT_EQ(problems(*made, region, 2, options), "");
    }
}

TEST(Adaptive, RegionsOfTheToolsSizeHaveNoPathOrAreNamed) {
  // The axis' region is a point, a line, or empty by less than the tolerance: no helix fits there.
  const std::vector<Region> regions{region_of({as_outline({{5, 5}, mm(2)})}),
                                    region_of({rectangle(0, 0, 30, 4)}), region_of({rectangle(0, 0, 4, 4)}),
                                    region_of({as_outline({{5, 5}, mm(2 + 1e-7)})}),
                                    region_of({as_outline({{5, 5}, mm(2 - 1e-7)})})};
  for (const Region& region : regions) {
    Diagnostics diagnostics;
    EXPECT_FALSE(pocket(region, mill(4), adaptive(60), diagnostics));
    ASSERT_EQ(diagnostics.errors(), 1u);
    EXPECT_EQ(diagnostics.list().front().code, codes::op_tool_wide);
  }
}

TEST(Adaptive, PiecesThatTouchAreClearedEach) {
  // Squares that meet in a corner, with an edge in common, and discs that touch.
  const std::vector<std::vector<Outline>> pieces{{rectangle(0, 0, 16, 16), rectangle(16, 16, 32, 32)},
                                                 {rectangle(0, 0, 16, 16), rectangle(16, 4, 32, 20)},
                                                 {as_outline({{0, 0}, mm(8)}), as_outline({{16, 0}, mm(8)})},
                                                 {rectangle(0, 0, 16, 16), rectangle(16 + 1e-7, 0, 32, 16)}};
  for (const auto& outlines : pieces) {
    Diagnostics diagnostics;
    std::vector<Region> parts;
    for (const Outline& outline : outlines) parts.push_back(region_of({outline}));
    const Region region = *unite(parts, {}, diagnostics);
    const PocketOptions options = adaptive(60);
    const auto made = pocket(region, mill(4), options, diagnostics);
    ASSERT_TRUE(made) << to_string(diagnostics.list().front());
    EXPECT_TRUE(diagnostics.list().empty());
    EXPECT_EQ(problems(*made, region, 2, options), "");
  }
}

TEST(Adaptive, AFinishingPassFollowsTheWalls) {
  const Region region = region_of({rectangle(0, 0, 30, 20)});
  PocketOptions options = adaptive(60);
  options.finish = mm(0.3);
  Diagnostics diagnostics;
  const auto made = pocket(region, mill(4), options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
  // All but the corners, which have the radius of the tool.
  const std::vector<Motion> cuts = motions(made->path);
  for (double x = 0.31; x < 30; x += 0.7)
    EXPECT_EQ(removed_to(cuts, {x, 0.005}, 2.0001, -2), x > 2 && x < 28) << x;
}

}  // namespace
}  // namespace kerf
