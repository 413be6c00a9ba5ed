// Contours: what is cut on which side, order, leads, and bad input.
#include "kerf/op/contour.h"

#include <gtest/gtest.h>
#include <numbers>

#include "swept.h"

namespace kerf {
namespace {

using namespace test;

CutOptions usual(double depth = 4.0, double stepdown = 2.0) {
  CutOptions cut;
  cut.depth = mm(depth), cut.stepdown = mm(stepdown);
  cut.feed = mm_per_min(600), cut.plunge = mm_per_min(200);
  cut.entry.kind = EntryKind::ramp;
  return cut;
}

/// The length of cuts on the level `z`.
double length_at(const Toolpath& path, double z) {
  double sum = 0.0;
  for (const Motion& m : motions(path))
    if (!m.rapid && std::abs(m.from.z - z) < 1e-9 && std::abs(m.to.z - z) < 1e-9)
      sum += m.arc ? std::abs(m.sweep) * m.radius : distance(m.from, m.to);
  return sum;
}

TEST(Contour, OutsideGoesAroundThePartAndInsideItsHoles) {
  const Region part = region_of({rectangle(0, 0, 40, 30), as_outline({{20, 15}, mm(6)})});
  Diagnostics diagnostics;
  const auto made = contour(part, mill(4), {.cut = usual()}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_TRUE(diagnostics.list().empty());
  // The axis is 2 mm outside of the rectangle, around its corners, and 2 mm inside the hole.
  const double expected = 2 * (40 + 30) + 2 * std::numbers::pi * 2 + 2 * std::numbers::pi * 4;
  EXPECT_NEAR(length_at(made->path, -2), expected, 1e-4);
  EXPECT_NEAR(length_at(made->path, -4), expected, 1e-4);
  // The part remains.
  const std::vector<Motion> cuts = motions(made->path);
  for (double x = 0.2; x < 40; x += 0.9)
    for (double y = 0.2; y < 30; y += 0.9)
      if (distance(Point2{x, y}, Point2{20, 15}) > 6.01) {
        ASSERT_FALSE(touched(cuts, {x, y}, 1.9999, 0)) << x << " " << y;
      }
  // The hole first: its circle lies inside.
  const auto first = std::find_if(cuts.begin(), cuts.end(), [](const Motion& m) { return !m.rapid; });
  EXPECT_LT(distance(first->from.xy(), {20, 15}), 4.1);
}

TEST(Contour, ClimbAroundAPartIsClockwise) {
  for (const CutDirection direction : {CutDirection::climb, CutDirection::conventional}) {
    CutOptions cut = usual(1, 0);
    cut.direction = direction;
    Diagnostics diagnostics;
    const auto made = contour(region_of({rectangle(0, 0, 40, 30)}), mill(4), {.cut = cut}, diagnostics);
    ASSERT_TRUE(made);
    double along = 0.0;  // the upper side, at y = 32
    for (const Motion& m : motions(made->path))
      if (!m.rapid && m.high() < -0.9 && std::abs(m.from.y - 32) < 1e-6 && std::abs(m.to.y - 32) < 1e-6)
        along += m.to.x - m.from.x;
    EXPECT_GT(direction == CutDirection::climb ? along : -along, 30);
  }
}

TEST(Contour, InsideStaysInside) {
  const Region region = region_of({polygon({{0, 0}, {50, 0}, {40, 30}, {25, 12}, {5, 35}})});
  Diagnostics diagnostics;
  const auto made =
      contour(region, mill(4), {.cut = usual(), .side = ContourSide::inside, .lead = {mm(2)}}, diagnostics);
  ASSERT_TRUE(made);
  const std::vector<Motion> cuts = motions(made->path);
  const RegionSearch inside(region);
  for (double x = -3; x < 53; x += 0.7)
    for (double y = -3; y < 38; y += 0.7)
      if (inside.locate({x, y}, mm(1e-6)) == Location::outside) {
        ASSERT_FALSE(touched(cuts, {x, y}, 1.9995, 0)) << x << " " << y;
      }
  EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
}

TEST(Contour, ALeadIsTangentAndLeavesThePart) {
  const Region part = region_of({rectangle(0, 0, 40, 30)});
  Diagnostics diagnostics;
  const auto made = contour(part, mill(4), {.cut = usual(), .lead = {mm(3)}}, diagnostics);
  ASSERT_TRUE(made);
  const std::vector<Motion> cuts = motions(made->path);
  const RegionSearch walls(part);
  // Every descent is 3 mm clear of the wall on average of its circle: its nearest point touches at most.
  for (const Motion& m : cuts)
    if (!m.rapid && m.to.z < m.from.z - 1e-9)
      for (double t = 0; t < 1; t += 0.05) {
        const Point2 p = m.arc ? m.centre + m.radius * Point2{std::cos(m.start + t * m.sweep),
                                                              std::sin(m.start + t * m.sweep)}
                               : m.from.xy();
        EXPECT_GE(walls.nearest(p)->distance.mm(), 2.0 - 2e-4);
      }
  EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
}

TEST(Contour, AHoleTooNarrowIsReportedAndTheOutsideIsCut) {
  const Region part = region_of({rectangle(0, 0, 40, 30), as_outline({{20, 15}, mm(2)})});
  Diagnostics diagnostics;
  const auto made = contour(part, mill(6), {.cut = usual()}, diagnostics);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->narrow.size(), 1u);
  EXPECT_NEAR(made->narrow[0].at.x, 20, 0.05);
  EXPECT_NEAR(made->narrow[0].at.y, 15, 0.05);
  EXPECT_NEAR(made->narrow[0].diameter.mm(), 4, 0.05);
  EXPECT_EQ(diagnostics.warnings(), 1u);
  EXPECT_EQ(diagnostics.list().front().code, Code::op_tool_wide);
}

TEST(Contour, OnFollowsOpenAndClosedPaths) {
  Outline open{
      {0, 0},
      {},
      {{{30, 0}, {}, {}}, {{40, 10}, Point2{40 - 10 * (1 - std::sqrt(0.5)), 10 * (1 - std::sqrt(0.5))}, {}}}};
  CutOptions cut = usual(3, 1);
  cut.entry.kind = EntryKind::plunge;
  Diagnostics diagnostics;
  auto made = contour_on({open, rectangle(50, 0, 60, 10)}, mill(3), cut, diagnostics);
  ASSERT_TRUE(made);
  for (const double z : {-1.0, -2.0, -3.0})
    EXPECT_NEAR(length_at(made->path, z), 30 + 5 * std::numbers::pi + 40, 1e-4);
  EXPECT_EQ(rapid_problem(made->path, 1.5, 0), "");
  cut.entry.kind = EntryKind::ramp;
  made = contour_on({open}, mill(3), cut, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_GE(length_at(made->path, -3), 30 + 5 * std::numbers::pi - 1e-4);
  // Nothing but the path is cut.
  for (const Motion& m : motions(made->path))
    if (!m.rapid && m.to.x <= 30 && m.from.x <= 30) {
      EXPECT_NEAR(m.to.y, 0, 1e-9);
    }
}

TEST(Contour, DegeneratePathsAreIgnoredOrErrors) {
  Diagnostics diagnostics;
  EXPECT_FALSE(contour_on({}, mill(3), usual(), diagnostics));
  EXPECT_FALSE(contour_on({Outline{{1, 1}, {}, {{{1, 1}, {}, {}}}}}, mill(3), usual(), diagnostics));
  ASSERT_EQ(diagnostics.errors(), 2u);
  for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, Code::op_empty);
  EXPECT_FALSE(
      contour_on({Outline{{1, 1}, {}, {{{std::nan(""), 1}, {}, {}}}}}, mill(3), usual(), diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, Code::op_option);
  // A path much shorter than the tool is cut by a plunge.
  EXPECT_TRUE(contour_on({Outline{{1, 1}, {}, {{{1.001, 1}, {}, {}}}}}, mill(3), usual(), diagnostics));
}

}  // namespace
}  // namespace kerf
