// Chamfers: the height that remains at every point of a grid against the cone at its distance from the edge.
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

Tool vee(double angle, double diameter = 12.0, double tip = 0.0) {
  return made(shape::Vee{mm(diameter), {}, degrees(angle), mm(tip), {}});
}
ChamferOptions usual(double width, ContourSide side = ContourSide::outside) {
  ChamferOptions options;
  options.cut.feed = mm_per_min(600), options.cut.plunge = mm_per_min(200);
  options.width = mm(width), options.side = side;
  return options;
}

/// Points of a grid on the side of the material where the height is not that of a chamfer. In inner corners,
/// which `exact` excludes, it may be higher.
std::string wrong_heights(const Operation& made, const Tool& tool, const Region& region, ContourSide side,
                          double width, double angle, bool exact, double pitch) {
  const CarvedSurface surface(made.path, tool);
  const RegionSearch search(region);
  const double slope = 1.0 / std::tan(0.5 * degrees(angle).rad());
  const Box2 box = bounds(region).grown(2.0 * width);
  std::string wrong;
  for (double y = box.low.y; y < box.high.y; y += pitch)
    for (double x = box.low.x; x < box.high.x && wrong.size() < 300; x += pitch) {
      const double clear = search.clearance({x, y})->mm();
      const double inwards = side == ContourSide::outside ? clear : -clear;
      if (inwards <= 0.0) continue;
      const double expected = -std::max(width - inwards, 0.0) * slope, found = surface.height({x, y});
      if (found < expected - 0.004 || (exact && found > expected + 0.004))
        wrong += std::to_string(x) + ", " + std::to_string(y) + ": " + std::to_string(found) +
                 " instead of " + std::to_string(expected) + "; ";
    }
  return wrong;
}

TEST(Chamfer, HasItsWidthAndAngleAlongAllEdges) {
  // Convex corners outside, and holes without inner corners: the cone comes to all of the edge.
  const Region part =
      region_of({polygon({{0, 0}, {40, 0}, {48, 20}, {20, 34}, {-4, 18}}), as_outline({{20, 15}, mm(6)})});
  for (const double angle : {60.0, 90.0})
    for (const double tip : {0.0, 0.5})
      for (const double stepdown : {0.0, 0.6}) {
        ChamferOptions options = usual(1.2);
        options.cut.stepdown = mm(stepdown);
        const Tool tool = vee(angle, 12, tip);
        Diagnostics diagnostics;
        const auto made = chamfer(part, tool, options, diagnostics);
        ASSERT_TRUE(made);
        EXPECT_TRUE(diagnostics.list().empty());
        EXPECT_EQ(wrong_heights(*made, tool, part, ContourSide::outside, 1.2, angle, true, 0.47), "");
      }
}

TEST(Chamfer, OfAnOpeningIsAroundIt) {
  const Region opening = region_of({as_outline({{0, 0}, mm(9)})});
  ChamferOptions options = usual(0.8, ContourSide::inside);
  options.lead_in = options.lead_out = {LeadKind::arc, mm(2)};
  const Tool tool = vee(90);
  Diagnostics diagnostics;
  const auto made = chamfer(opening, tool, options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(wrong_heights(*made, tool, opening, ContourSide::inside, 0.8, 90, true, 0.17), "");
}

TEST(Chamfer, ItsDepthIsThatBelowTheSurfaceAndTheTipIsLower) {
  ChamferOptions options = usual(0);
  options.cut.depth = mm(1), options.cut.top = -2, options.tip_offset = mm(0.3);
  Diagnostics diagnostics;
  const auto made = chamfer(region_of({rectangle(0, 0, 40, 30)}), vee(60), options, diagnostics);
  ASSERT_TRUE(made);
  double low = 0.0, nearest = INFINITY;
  for (const Motion& m : motions(made->path)) {
    low = std::min(low, m.low());
    if (m.low() < -3) nearest = std::min(nearest, m.distance_to({20, 0}));
  }
  EXPECT_NEAR(low, -3.3, 1e-9);
  EXPECT_NEAR(nearest, 0.3 * std::tan(std::numbers::pi / 6), 1e-6);
}

TEST(Chamfer, IsNowhereWiderOnRandomRegions) {
  std::mt19937_64 random(11);
  int cut = 0;
  for (int i = 0; i < 24; ++i) {
    const Region region = random_region(random);
    const ContourSide side = i % 2 == 0 ? ContourSide::outside : ContourSide::inside;
    ChamferOptions options = usual(0.7, side);
    if (i % 3 == 0) options.lead_in = options.lead_out = {LeadKind::arc, mm(1)};
    if (i % 4 == 0) options.cut.direction = CutDirection::conventional;
    const Tool tool = vee(90);
    Diagnostics diagnostics;
    const auto made = chamfer(region, tool, options, diagnostics);
    if (!made) continue;
    ++cut;
    EXPECT_EQ(wrong_heights(*made, tool, region, side, 0.7, 90, false, 0.83), "") << i;
  }
  EXPECT_GT(cut, 20);
}

TEST(Chamfer, RefusesToolsWithoutACone) {
  const Region part = region_of({rectangle(0, 0, 40, 30)});
  const auto refused = [&](const Tool& tool, const ChamferOptions& options) {
    Diagnostics diagnostics;
    EXPECT_FALSE(chamfer(part, tool, options, diagnostics));
    EXPECT_EQ(diagnostics.list().size(), 1u);
    EXPECT_EQ(diagnostics.list().at(0).code, codes::op_option);
    return diagnostics.list().at(0).message;
  };
  EXPECT_NE(refused(mill(6), usual(1)).find("needs a V tool"), std::string::npos);
  EXPECT_NE(refused(made(shape::Ball{mm(6), mm(20)}), usual(1)).find("needs a V tool"), std::string::npos);
  EXPECT_NE(refused(vee(90, 3), usual(2)).find("too large"), std::string::npos);
  ChamferOptions both = usual(1);
  both.cut.depth = mm(1);
  EXPECT_NE(refused(vee(90), both).find("either a width or a depth"), std::string::npos);
  EXPECT_NE(refused(vee(90), usual(0)).find("either a width or a depth"), std::string::npos);
  ChamferOptions no_offset = usual(1);
  no_offset.tip_offset = {};
  EXPECT_NE(refused(vee(90), no_offset).find("tip offset"), std::string::npos);
}

}  // namespace
}  // namespace kerf
