// V-carving: the depth at every point of a grid against the distance of the point from the boundary, which
// is what a cone through the boundary has there.
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "base/codes/op.h"
#include "carved.h"
#include "random_regions.h"
#include "swept.h"

#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

Tool vee(double angle, double diameter = 20.0, double tip = 0.0) {
  return made(shape::Vee{mm(diameter), {}, degrees(angle), mm(tip), {}});
}

VCarveOptions usual(double depth = 0.0, double stepdown = 0.0) {
  VCarveOptions options;
  options.cut.depth = mm(depth), options.cut.stepdown = mm(stepdown);
  options.cut.feed = mm_per_min(600), options.cut.plunge = mm_per_min(200);
  options.cut.entry.kind = EntryKind::ramp;
  return options;
}

std::string all(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.list()) text += to_string(d) + "\n";
  return text;
}

/// Compares the depth at points of a grid with that of a cone through the boundary of a region; points where
/// the floor is wider than `limit` from the boundary do not count.
std::string wrong_depths(const Toolpath& path, const Tool& tool, const Region& region, double angle,
                         double limit, double pitch, double tolerance = 0.008) {
  const CarvedSurface surface(path, tool);
  const RegionSearch search(region);
  const double slope = 1.0 / std::tan(0.5 * degrees(angle).rad());
  const Box2 box = bounds(region).grown(1.0);
  std::string wrong;
  int shown = 0;
  for (double y = box.low.y; y < box.high.y; y += pitch)
    for (double x = box.low.x; x < box.high.x && shown < 5; x += pitch) {
      const Point2 p{x, y};
      const double clearance = search.clearance(p)->mm();
      if (clearance > limit) continue;
      const double expected = -std::max(clearance, 0.0) * slope, found = surface.height(p);
      if (std::abs(found - expected) <= tolerance) continue;
      ++shown;
      wrong += std::to_string(x) + ", " + std::to_string(y) + ": " + std::to_string(found) + " instead of " +
               std::to_string(expected) + "; ";
    }
  return wrong;
}

TEST(VCarve, APyramidHasItsCornersAtTheSurface) {
  const Region region = region_of({rectangle(0, 0, 10, 6)});
  Diagnostics diagnostics;
  const auto made = v_carve(region, vee(90), usual(), diagnostics);
  ASSERT_TRUE(made) << all(diagnostics);
  EXPECT_EQ(all(diagnostics), "");
  EXPECT_TRUE(made->unreached.empty());
  EXPECT_EQ(wrong_depths(made->path, vee(90), region, 90, 100, 0.21), "");
  double low = 0.0;
  std::vector<Point2> corners;
  for (const Motion& m : motions(made->path)) {
    low = std::min(low, m.low());
    for (const Point2 corner : {Point2{0, 0}, Point2{10, 0}, Point2{10, 6}, Point2{0, 6}})
      if (!m.rapid && distance(m.to.xy(), corner) < 1e-3 && std::abs(m.to.z) < 1e-3)
        corners.push_back(corner);
  }
  EXPECT_NEAR(low, -3.0, 1e-3);
  EXPECT_GE(corners.size(), 4u);
}

TEST(VCarve, TheAngleOfTheToolSetsTheDepth) {
  const Region region = region_of({rectangle(0, 0, 10, 4)});
  for (const double angle : {30.0, 60.0, 120.0}) {
    Diagnostics diagnostics;
    const auto made = v_carve(region, vee(angle), usual(), diagnostics);
    ASSERT_TRUE(made) << all(diagnostics);
    EXPECT_EQ(wrong_depths(made->path, vee(angle), region, angle, 100, 0.23, 0.02), "") << angle;
  }
}

TEST(VCarve, ADepthLeavesAFlatFloorForAnotherTool) {
  const Region region = region_of({rectangle(0, 0, 30, 20), as_outline({{15, 10}, mm(3)})});
  for (const double tip : {0.0, 0.5}) {
    const Tool tool = vee(60, 20, tip);
    const VCarveOptions options = usual(2);
    Diagnostics diagnostics;
    const auto made = v_carve(region, tool, options, diagnostics);
    const auto floor = v_carve_floor(region, tool, options, diagnostics);
    ASSERT_TRUE(made && floor) << all(diagnostics);
    // The floor starts where a cone from the boundary is 2 mm deep.
    const double wall = 2.0 * std::tan(degrees(30).rad());
    EXPECT_NEAR(area(*floor), (30 - 2 * wall) * (20 - 2 * wall) - std::numbers::pi * std::pow(3 + wall, 2),
                0.02);
    // A flat tip does not reach into the corners.
    if (tip == 0.0) {
      EXPECT_EQ(wrong_depths(made->path, tool, region, 60, wall - 0.01, 0.37, 0.02), "");
    }
    // The two tools together make all of it: walls, and a floor at the depth.
    PocketOptions clear{.cut = options.cut};
    clear.cut.entry.kind = EntryKind::helix;
    const auto cleared = pocket(*floor, mill(3), clear, diagnostics);
    ASSERT_TRUE(cleared) << all(diagnostics);
    const CarvedSurface carved(made->path, tool), milled(cleared->path, mill(3));
    const RegionSearch search(region), rest(cleared->unreached);
    int counted = 0;
    for (double x = -1; x < 31; x += 0.43)
      for (double y = -1; y < 21; y += 0.41) {
        const double clearance = search.clearance({x, y})->mm();
        const auto left = rest.clearance({x, y});
        if (left && left->mm() > -0.3) continue;  // inner corners, and what is near them
        if (tip > 0.0 && std::min(x, 30 - x) < 2 && std::min(y, 20 - y) < 2) continue;
        const double depth = std::min(std::max(clearance, 0.0) / std::tan(degrees(30).rad()), 2.0);
        ASSERT_NEAR(std::min(carved.height({x, y}), milled.height({x, y})), -depth, 0.02) << x << " " << y;
        ++counted;
      }
    EXPECT_GT(counted, 3000);
  }
}

TEST(VCarve, PassesAreNoDeeperThanTheStepdown) {
  const Region region = region_of({rectangle(0, 0, 24, 16), rectangle(7, 5, 10, 9)});
  Diagnostics diagnostics;
  const auto made = v_carve(region, vee(60), usual(6, 2), diagnostics);
  ASSERT_TRUE(made) << all(diagnostics);
  EXPECT_EQ(wrong_depths(made->path, vee(60), region, 60, 6 * std::tan(degrees(30).rad()) - 0.01, 0.37, 0.02),
            "");
  // In the order of cutting, no motion is deeper than 2 mm below what was cut along it before.
  Toolpath before;
  int checked = 0;
  for (std::size_t i = 0; i < made->path.size(); ++i) {
    if (i % 7 == 0) {
      const CarvedSurface surface(before, vee(60));
      before.add_copy(made->path, i);
      const std::vector<Motion> cuts = motions(before);
      for (const double t : {0.1, 0.5, 0.9}) {
        if (cuts.empty() || cuts.back().rapid || cuts.back().arc) break;
        const Point3 at = cuts.back().from + t * (cuts.back().to - cuts.back().from);
        ASSERT_GE(at.z, std::min(surface.height(at.xy()), 0.0) - 2.0 - 0.01) << at.x << " " << at.y;
        ++checked;
      }
      continue;
    }
    before.add_copy(made->path, i);
  }
  EXPECT_GT(checked, 30);
}

TEST(VCarve, RapidsStayAboveTheSurface) {
  const Region region = region_of({rectangle(0, 0, 10, 6), rectangle(20, 0, 30, 6)});
  Diagnostics diagnostics;
  const auto made = v_carve(region, vee(90), usual(4, 0.7), diagnostics);
  ASSERT_TRUE(made) << all(diagnostics);
  for (const Motion& m : motions(made->path)) EXPECT_TRUE(!m.rapid || m.to.z >= 0.5);
}

TEST(VCarve, BallsAndFlatTipsKeepTheRegion) {
  const Region region = region_of({rectangle(0, 0, 12, 5)});
  for (const Tool& tool : {made(shape::Ball{mm(8), mm(20)}), vee(60, 12, 1.0)}) {
    Diagnostics diagnostics;
    const auto made = v_carve(region, tool, usual(), diagnostics);
    ASSERT_TRUE(made) << all(diagnostics);
    const CarvedSurface surface(made->path, tool);
    const RegionSearch search(region), rest(made->unreached);
    for (double x = -1; x < 13; x += 0.17)
      for (double y = -1; y < 6; y += 0.13) {
        const double clearance = search.clearance({x, y})->mm();
        const auto left = rest.clearance({x, y});
        if (clearance < -0.005) {
          ASSERT_GT(surface.height({x, y}), -1e-6) << x << " " << y;
        }
        if (clearance > 0.005 && !(left && left->mm() > -0.005)) {
          ASSERT_LT(surface.height({x, y}), 0.0) << x << " " << y;
        }
      }
  }
}

TEST(VCarve, ADiscIsAPlunge) {
  Diagnostics diagnostics;
  const Region region = region_of({as_outline({{5, 5}, mm(2)})});
  const auto made = v_carve(region, vee(90), usual(), diagnostics);
  ASSERT_TRUE(made) << all(diagnostics);
  EXPECT_EQ(wrong_depths(made->path, vee(90), region, 90, 100, 0.11), "");
}

TEST(VCarve, WhatTheTipIsTooWideForIsReported) {
  // A square with a channel 0.6 mm wide, and a tip of 1 mm.
  const Region region =
      region_of({polygon({{0, 0}, {8, 0}, {8, 3.7}, {16, 3.7}, {16, 4.3}, {8, 4.3}, {8, 8}, {0, 8}})});
  Diagnostics diagnostics;
  const auto made = v_carve(region, vee(60, 12, 1.0), usual(), diagnostics);
  ASSERT_TRUE(made) << all(diagnostics);
  ASSERT_EQ(made->narrow.size(), 1u);
  EXPECT_NEAR(made->narrow[0].diameter.mm(), 0.6, 0.02);
  EXPECT_EQ(diagnostics.warnings(), 1u);
  Diagnostics none;
  EXPECT_FALSE(v_carve(region_of({rectangle(0, 0, 9, 0.6)}), vee(60, 12, 1.0), usual(), none));
  ASSERT_EQ(none.errors(), 1u);
  EXPECT_EQ(none.list().front().code, codes::op_tool_wide);
}

TEST(VCarve, BadInputIsAnError) {
  const Region region = region_of({rectangle(0, 0, 10, 6)});
  const auto code = [&](const Region& r, const Tool& tool, const VCarveOptions& options) {
    Diagnostics diagnostics;
    EXPECT_FALSE(v_carve(r, tool, options, diagnostics));
    EXPECT_FALSE(v_carve_floor(r, tool, options, diagnostics));
    for (const Diagnostic& d : diagnostics.list())
      if (d.severity == Severity::error) return d.code;
    return Code{};
  };
  EXPECT_EQ(code({}, vee(60), usual()), codes::op_empty);
  Region open = region;
  open.loops[0].segments.pop_back();
  EXPECT_EQ(code(open, vee(60), usual()), codes::op_open);
  EXPECT_EQ(code(region, mill(6), usual()), codes::op_option);
  EXPECT_EQ(code(region, made(shape::Dovetail{mm(12), mm(9), degrees(14)}), usual()), codes::op_option);
  EXPECT_EQ(code(region, vee(90, 6), usual(3.5)), codes::op_option);  // its cone is 3 mm high
  for (const double number : {-1.0, std::nan(""), double{INFINITY}}) {
    VCarveOptions bad = usual();
    bad.cut.depth = mm(number);
    EXPECT_EQ(code(region, vee(60), bad), codes::op_option) << number;
    bad = usual();
    bad.start = mm(number);
    EXPECT_EQ(code(region, vee(60), bad), codes::op_option) << number;
    bad = usual();
    bad.cut.feed = mm_per_min(number);
    EXPECT_EQ(code(region, vee(60), bad), codes::op_option) << number;
  }
  VCarveOptions deep = usual(2);
  deep.start = mm(2);
  EXPECT_EQ(code(region, vee(60), deep), codes::op_option);
  VCarveOptions few = usual();
  few.cut.max_steps = 5;
  Diagnostics diagnostics;
  EXPECT_FALSE(v_carve(region, vee(60), few, diagnostics));
  EXPECT_EQ(diagnostics.list().front().code, codes::op_limit);
}

/// Random unions, with parts that touch, slots as wide as twice the limit, slivers and tiny parts.
Region hard_region(std::mt19937_64& random, double wall) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Region region = random_region(random);
  Diagnostics diagnostics;
  const Box2 box = bounds(region);
  std::vector<Region> parts{region};
  const double kind = in(0, 6), x = std::round(box.high.x), y = std::round(box.low.y);
  if (kind < 1) parts.push_back(region_of({rectangle(x, y, x + 20, y + 2 * wall)}));
  if (kind >= 1 && kind < 2) parts.push_back(region_of({rectangle(x + 1, y, x + 1.01, y + 10)}));
  if (kind >= 2 && kind < 3) parts.push_back(region_of({as_outline({{x + 5, y}, mm(in(0.01, 0.2))})}));
  if (kind >= 3 && kind < 4)  // two squares with a common corner
    for (const double k : {0.0, 6.0})
      parts.push_back(region_of({rectangle(x + k, y + k, x + k + 6, y + k + 6)}));
  if (kind >= 4 && kind < 5) parts.push_back(region_of({as_outline({{x + 9, y}, mm(wall)})}));
  return *unite(parts, {}, diagnostics);
}

TEST(VCarve, RandomRegionsAreExactAtTheSurface) {
  std::mt19937_64 random(20261123);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 24; ++i) {
    const double angle = std::vector{60.0, 90.0, 120.0}[static_cast<std::size_t>(i) % 3], depth = in(0.5, 4);
    const double wall = depth * std::tan(0.5 * degrees(angle).rad());
    const Region region = hard_region(random, wall);
    Diagnostics diagnostics;
    const Tool tool = vee(angle, 40);
    const auto made = v_carve(region, tool, usual(depth, i % 2 == 0 ? 0.0 : in(0.3, 2)), diagnostics);
    ASSERT_TRUE(made) << i << all(diagnostics);
    EXPECT_EQ(wrong_depths(made->path, tool, region, angle, wall - 0.01, 1.13, 0.02), "") << "case " << i;
  }
}

TEST(Inlay, ThePlugFitsThePocketWithTheGlueGap) {
  std::mt19937_64 random(7);
  std::vector<Region> regions{
      region_of({rectangle(0, 0, 20, 12)}),
      region_of({polygon({{0, 0}, {20, 0}, {6, 5}, {3, 16}}), as_outline({{5, 4}, mm(1.2)})})};
  for (int i = 0; i < 6; ++i) regions.push_back(random_region(random));
  for (const Region& region : regions) {
    const double depth = 3.0, gap = 0.5, base = 0.8;
    const Tool tool = vee(60, 20);
    Diagnostics diagnostics;
    const auto female = v_carve(region, tool, usual(depth), diagnostics);
    InlayOptions options{.cut = usual(depth).cut, .glue_gap = mm(gap), .base_gap = mm(base)};
    const auto male = inlay_plug(region, tool, options, diagnostics);
    const auto male_floor = inlay_plug_floor(region, tool, options, diagnostics);
    ASSERT_TRUE(female && male && male_floor) << all(diagnostics);
    EXPECT_NEAR(inlay_plug_depth(options).mm(), depth - gap + base, 1e-12);
    const CarvedSurface pocket_of(female->path, tool), plug_of(male->path, tool);
    const RegionSearch search(region), floor(*male_floor);
    const Box2 box = bounds(region);
    const double wall = depth * std::tan(degrees(30).rad());
    int in_contact = 0;
    for (double x = box.low.x - 1; x < box.high.x + 1; x += 0.61)
      for (double y = box.low.y - 1; y < box.high.y + 1; y += 0.57) {
        const double clearance = search.clearance({x, y})->mm();
        // The pocket below its surface, and the plug above the level at which it meets that surface.
        const double below = clearance > wall - 0.01 ? depth : -pocket_of.height({x, y});
        const double mirrored = box.low.x + box.high.x - x;
        double above = plug_of.height({mirrored, y}) + depth - gap;
        // The floor around the plug is another tool's.
        if (floor.clearance({mirrored, y})->mm() > -0.01) above = -base;
        ASSERT_LE(above, below + 0.02) << x << " " << y;
        if (clearance > 0.02 && clearance < wall - 0.3) {
          // On walls up to the face of the plug the two are in contact.
          ASSERT_NEAR(above, std::min(below, depth - gap), 0.02) << x << " " << y;
          ++in_contact;
        }
        if (clearance > wall + 0.01) {
          ASSERT_NEAR(below - above, gap, 0.02) << x << " " << y;
        }
        if (clearance < -1.0 && clearance > -1.2) {
          ASSERT_NEAR(above, -base, 0.02) << x << " " << y;
        }
      }
    EXPECT_GT(in_contact, 50);
  }
}

TEST(Inlay, BadGapsAreErrors) {
  const Region region = region_of({rectangle(0, 0, 10, 6)});
  for (const double number : {-1.0, std::nan(""), 3.0, double{INFINITY}}) {
    InlayOptions bad{.cut = usual(3).cut, .glue_gap = mm(number)};
    Diagnostics diagnostics;
    EXPECT_FALSE(inlay_plug(region, vee(60), bad, diagnostics));
    ASSERT_EQ(diagnostics.errors(), 1u) << number;
    EXPECT_EQ(diagnostics.list().front().code, codes::op_option);
  }
}

}  // namespace
}  // namespace kerf
