// Contours: what is cut on which side, order, leads, and bad input.
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/op.h"
#include "swept.h"

#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

CutOptions usual(double depth = 4.0, double stepdown = 2.0) {
  CutOptions cut = levels(depth, stepdown);
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
  const auto made = contour(region, mill(4),
                            {.cut = usual(),
                             .side = ContourSide::inside,
                             .lead_in = {LeadKind::arc, mm(2)},
                             .lead_out = {LeadKind::arc, mm(2)}},
                            diagnostics);
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

TEST(Contour, ALeadOutWhereARampHasEndedKeepsClearOfWalls) {
  // The lead-in does not fit at the start, so that a ramp moves the end, in a corner in this case.
  const Region region = region_of({polygon({{14.887903, 15.25236},
                                            {-2.597933, 13.035819},
                                            {-30.569721, 9.607015},
                                            {-10.619895, -11.384586},
                                            {21.024271, -24.641849}})});
  const RegionSearch inside(region);
  for (const CutDirection direction : {CutDirection::climb, CutDirection::conventional})
    for (double overlap = 0.0; overlap < 3.0; overlap += 0.2) {
      CutOptions cut = usual(4, 0);
      cut.direction = direction;
      Diagnostics diagnostics;
      const auto made = contour(region, mill(4),
                                {.cut = cut,
                                 .side = ContourSide::inside,
                                 .lead_in = {LeadKind::arc, mm(1)},
                                 .lead_out = {LeadKind::arc, mm(1)},
                                 .overlap = mm(overlap)},
                                diagnostics);
      ASSERT_TRUE(made);
      for (const Motion& m : motions(made->path))
        if (m.low() < -1e-9) {
          ASSERT_GT(inside.clearance(m.to.xy())->mm(), 2.0 - 1e-3) << m.to.x << " " << m.to.y;
        }
    }
}

TEST(Contour, AToolThatDoesNotPlungeDescendsAlongItsLeadIn) {
  Tool tool = mill(4);
  tool.plunges = false;
  for (const LeadKind kind : {LeadKind::line, LeadKind::arc})
    for (const EntryKind entry : {EntryKind::plunge, EntryKind::ramp}) {
      CutOptions cut = usual();
      cut.entry.kind = entry;
      Diagnostics diagnostics;
      const auto made =
          contour(region_of({rectangle(0, 0, 40, 30)}), tool,
                  {.cut = cut, .lead_in = {kind, mm(3)}, .lead_out = {kind, mm(3)}}, diagnostics);
      ASSERT_TRUE(made);
      for (const Motion& m : motions(made->path)) {
        if (m.rapid || m.to.z >= m.from.z) continue;
        const double along = m.arc ? std::abs(m.sweep) * m.radius : distance(m.from.xy(), m.to.xy());
        // No steeper than the angle of the entry; a helix may turn several times in one motion.
        EXPECT_GT(along, 1.0);
        if (!m.arc) {
          EXPECT_LE((m.from.z - m.to.z) / along, std::tan(degrees(3).rad()) + 1e-9);
        }
      }
      EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
    }
}

TEST(Contour, WithoutRoomForARampAToolThatDoesNotPlungeIsRefused) {
  Tool tool = mill(6);
  // The axis has a circle of 0.05 mm in a hole of 6.1: no ramp is that short.
  const Region hole = region_of({as_outline({{10, 20}, mm(3.05)})});
  for (const bool plunges : {true, false}) {
    tool.plunges = plunges;
    Diagnostics diagnostics;
    EXPECT_EQ(contour(hole, tool, {.cut = usual(), .side = ContourSide::inside}, diagnostics).has_value(),
              plunges);
    EXPECT_EQ(pocket(hole, tool, {.cut = usual()}, diagnostics).has_value(), plunges);
    ASSERT_EQ(diagnostics.list().size(), plunges ? 0u : 2u);
    for (const Diagnostic& d : diagnostics.list()) {
      EXPECT_EQ(d.code, codes::op_tool_kind);
      EXPECT_NE(d.message.find("there is no room for a ramp at 10.05, 20"), std::string::npos) << d.message;
    }
  }
}

TEST(Contour, ALeadIsTangentAndLeavesThePart) {
  const Region part = region_of({rectangle(0, 0, 40, 30)});
  Diagnostics diagnostics;
  const auto made = contour(
      part, mill(4), {.cut = usual(), .lead_in = {LeadKind::arc, mm(3)}, .lead_out = {LeadKind::arc, mm(3)}},
      diagnostics);
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
  EXPECT_EQ(diagnostics.list().front().code, codes::op_tool_wide);
}

TEST(Contour, OnFollowsOpenAndClosedPaths) {
  Outline open{
      {0, 0}, {{{30, 0}, {}}, {{40, 10}, Point2{40 - 10 * (1 - std::sqrt(0.5)), 10 * (1 - std::sqrt(0.5))}}}};
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
  EXPECT_FALSE(contour_on({Outline{{1, 1}, {{{1, 1}, {}}}}}, mill(3), usual(), diagnostics));
  ASSERT_EQ(diagnostics.errors(), 2u);
  for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, codes::op_empty);
  EXPECT_FALSE(contour_on({Outline{{1, 1}, {{{std::nan(""), 1}, {}}}}}, mill(3), usual(), diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
  // A path much shorter than the tool is cut by a plunge.
  EXPECT_TRUE(contour_on({Outline{{1, 1}, {{{1.001, 1}, {}}}}}, mill(3), usual(), diagnostics));
}

/// Parts, sides and leads: the part stays, all rapids are free, and the whole loop is cut to the bottom.
TEST(Contour, LeadsOfAllKinds) {
  const Region part = region_of({rectangle(0, 0, 40, 30), as_outline({{20, 15}, mm(9)})});
  for (const LeadKind in : {LeadKind::none, LeadKind::arc, LeadKind::line})
    for (const LeadKind out : {LeadKind::none, LeadKind::arc, LeadKind::line})
      for (const CutDirection direction : {CutDirection::climb, CutDirection::conventional})
        for (const EntryKind entry : {EntryKind::plunge, EntryKind::ramp, EntryKind::helix}) {
          ContourOptions options{.cut = usual(), .lead_in = {in, mm(3)}, .lead_out = {out, mm(2)}};
          options.overlap = mm(1.5);
          options.cut.direction = direction, options.cut.entry.kind = entry;
          Diagnostics diagnostics;
          const auto made = contour(part, mill(4), options, diagnostics);
          ASSERT_TRUE(made);
          const std::vector<Motion> cuts = motions(made->path);
          const RegionSearch inside(part);
          for (double x = 0.3; x < 40; x += 1.3)
            for (double y = 0.3; y < 30; y += 1.3)
              if (inside.locate({x, y}, mm(0.01)) == Location::inside) {
                ASSERT_FALSE(touched(cuts, {x, y}, 1.9998, 0)) << x << " " << y;
              }
          for (double t = 0; t < 2 * std::numbers::pi; t += 0.1) {
            const Point2 d{std::cos(t), std::sin(t)};
            ASSERT_TRUE(removed_to(cuts, Point2{20, 15} + 8.99 * d, 2.0001, -4)) << t;
          }
          for (double x = 0; x <= 40; x += 0.7) {
            ASSERT_TRUE(removed_to(cuts, {x, -0.01}, 2.0001, -4)) << x;
          }
          EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
        }
}

TEST(Contour, TheFinishingPassRemovesTheAllowance) {
  const Region part = region_of({rectangle(0, 0, 40, 30), as_outline({{20, 15}, mm(9)})});
  ContourOptions options{.cut = usual(6, 2), .lead_in = {LeadKind::arc, mm(2)}};
  options.finish = mm(0.4);
  Diagnostics diagnostics;
  const auto made = contour(part, mill(4), options, diagnostics);
  ASSERT_TRUE(made);
  // Around the part 2.4 mm away in three passes, and 2 mm away in one; so too in the hole.
  const double outside = 2 * (40 + 30), hole = 2 * std::numbers::pi * 9;
  const double rough = outside + 2 * std::numbers::pi * 2.4 + hole - 2 * std::numbers::pi * 2.4;
  const double last = outside + 2 * std::numbers::pi * 2 + hole - 2 * std::numbers::pi * 2;
  const double lead = 2 * std::numbers::pi * 2;  // at most, at each start and level
  EXPECT_NEAR(length_at(made->path, -2), rough, 2 * lead);
  EXPECT_NEAR(length_at(made->path, -4), rough, 2 * lead);
  EXPECT_NEAR(length_at(made->path, -6), rough + last, 4 * lead);
  const std::vector<Motion> cuts = motions(made->path);
  std::vector<Motion> before;
  bool finishing = false;
  for (const Motion& m : cuts) {
    if (!m.rapid && !m.arc && std::abs(m.from.y + 2) < 1e-6 && std::abs(m.to.y + 2) < 1e-6) finishing = true;
    if (finishing) break;
    before.push_back(m);
  }
  ASSERT_TRUE(finishing);
  EXPECT_FALSE(touched(before, {20, -0.39}, 2.0, 0));     // the allowance was left,
  EXPECT_TRUE(removed_to(before, {20, -0.41}, 2.0, -6));  // and no more,
  EXPECT_TRUE(removed_to(cuts, {20, -0.001}, 2.0, -6));   // and then removed
  EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
}

/// The depth to which the point is cut.
double depth_at(const std::vector<Motion>& cuts, Point2 p, double radius) {
  double low = 0.0;
  for (const Motion& m : cuts)
    if (!m.rapid && m.distance_to(p) <= radius) low = std::min(low, m.high());
  return low;
}

TEST(Contour, TabsHoldThePart) {
  const Region part = region_of({rectangle(0, 0, 80, 60)});
  for (const TabShape shape : {TabShape::rectangular, TabShape::triangular})
    for (const double finish : {0.0, 0.5}) {
      ContourOptions options{.cut = usual(6, 2)};
      options.finish = mm(finish);
      options.tabs = {.height = mm(1.5), .length = mm(5), .count = 4, .shape = shape};
      Diagnostics diagnostics;
      const auto made = contour(part, mill(4), options, diagnostics);
      ASSERT_TRUE(made);
      EXPECT_TRUE(diagnostics.list().empty());
      const std::vector<Motion> cuts = motions(made->path);
      // Along a line 1 mm outside of the part: 4 bridges, as long as given at their bottom.
      const std::vector<Point2> corners{{-1, -1}, {81, -1}, {81, 61}, {-1, 61}, {-1, -1}};
      int bridges = 0;
      double length = 0.0, highest = -6.0;
      bool on = false;
      for (std::size_t i = 0; i + 1 < corners.size(); ++i)
        for (double s = 0; s < distance(corners[i], corners[i + 1]); s += 0.05) {
          const Point2 p =
              corners[i] + (s / distance(corners[i], corners[i + 1])) * (corners[i + 1] - corners[i]);
          const double z = depth_at(cuts, p, 2.0);
          highest = std::max(highest, z);
          const bool now = z > -6 + 1e-6;
          if (now && !on) ++bridges;
          if (now) length += 0.05;
          on = now;
        }
      EXPECT_EQ(bridges, 4);
      EXPECT_NEAR(highest, -4.5, shape == TabShape::rectangular ? 1e-6 : 0.15);
      // 1 mm from the tool's path the disc is narrower than its diameter: the tab is a little longer there.
      EXPECT_NEAR(length / 4, 5 + 2 * (2 - std::sqrt(3.0)), 0.3);
    }
}

TEST(Tabs, AreAddedToAFinishedPath) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  for (const double z : {-2.0, -4.0}) {
    path.add(step::Cut{{0, 0, z}, mm_per_min(100)}, OriginId::none);
    path.add(step::Cut{{50, 0, z}, mm_per_min(500)}, OriginId::none);
    path.add(step::Arc{.to = {50, 40, z}, .centre = {50, 20}, .turn = Turn::ccw, .feed = mm_per_min(500)},
             OriginId::none);
    path.add(step::Cut{{0, 40, z}, mm_per_min(500)}, OriginId::none);
    path.add(step::Cut{{0, 0, z}, mm_per_min(500)}, OriginId::none);
  }
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  for (const TabShape shape : {TabShape::rectangular, TabShape::triangular}) {
    Diagnostics diagnostics;
    const auto made = add_tabs(path, {.height = mm(3), .length = mm(4), .spacing = mm(40), .shape = shape},
                               mm(4), diagnostics);
    ASSERT_TRUE(made);
    double below = 0.0, raised = 0.0;
    for (const Motion& m : motions(*made)) {
      if (m.rapid) continue;
      EXPECT_GE(m.low(), -4.0);
      const double along = m.arc ? std::abs(m.sweep) * m.radius : distance(m.from.xy(), m.to.xy());
      (m.low() > -2.0 + 1e-9 ? raised : below) += along;
    }
    // Both passes rise to -1 over five tabs of 4 mm and the tool's 4 mm.
    const double whole = 140 + 20 * std::numbers::pi;
    EXPECT_NEAR(below + raised, 2 * whole, 1e-6);
    if (shape == TabShape::rectangular) {
      EXPECT_NEAR(raised, 2 * 5 * 8, 0.2);
    }
  }
  Diagnostics diagnostics;
  EXPECT_TRUE(add_tabs(path, {.height = mm(1), .count = 500}, mm(4), diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_refused);
  EXPECT_FALSE(add_tabs(path, {.height = mm(-1)}, mm(4), diagnostics));
  EXPECT_FALSE(add_tabs(path, {.height = mm(1), .count = 0}, mm(4), diagnostics));
  EXPECT_FALSE(add_tabs(path, {.height = mm(1)}, mm(0), diagnostics));
  EXPECT_EQ(diagnostics.errors(), 3u);
}

}  // namespace
}  // namespace kerf
