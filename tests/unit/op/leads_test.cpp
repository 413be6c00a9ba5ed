// Leads, the finishing pass and helices over finished paths: coordinates by hand, and random parts whose cuts
// are compared point by point with what may be removed.
#include <gtest/gtest.h>
#include <random>

#include "random_regions.h"
#include "swept.h"

#include "kerf/op/mill.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

using namespace test;

/// Clockwise around a part of 40 x 20 mm from the midpoint of its left side, 3 mm outside of it.
Toolpath around_plate(double bottom = -4.0) {
  Toolpath path;
  path.add(step::Rapid{{-3, 10, 5}}, OriginId::none);
  path.add(step::Rapid{{-3, 10, 1}}, OriginId::none);
  path.add(step::Cut{{-3, 10, bottom}, mm_per_min(100)}, OriginId::none);
  for (const Point2 p : {Point2{-3, 23}, Point2{43, 23}, Point2{43, -3}, Point2{-3, -3}, Point2{-3, 10}})
    path.add(step::Cut{{p.x, p.y, bottom}, mm_per_min(500)}, OriginId::none);
  path.add(step::Rapid{{-3, 10, 5}}, OriginId::none);
  path.add(step::Rapid{{100, 100, 5}}, OriginId::none);
  return path;
}

std::size_t warnings(const Diagnostics& diagnostics) {
  return static_cast<std::size_t>(
      std::count_if(diagnostics.list().begin(), diagnostics.list().end(),
                    [](const Diagnostic& d) { return d.severity == Severity::warning; }));
}

TEST(Leads, AnArcStartsBesideThePathAndIsTangentToIt) {
  Diagnostics diagnostics;
  const auto made = add_leads(
      around_plate(), {.lead_in = {LeadKind::arc, mm(2)}, .lead_out = {LeadKind::arc, mm(4)}}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_TRUE(diagnostics.list().empty());
  const Toolpath& path = made->path;
  ASSERT_EQ(path.size(), 12u);
  EXPECT_EQ(path[0].to(), (Point3{-5, 8, 5}));
  EXPECT_EQ(path[1].to(), (Point3{-5, 8, 1}));
  EXPECT_EQ(path[2].to(), (Point3{-5, 8, -4}));
  EXPECT_EQ(path[2].feed(), mm_per_min(100));
  // The path goes up (+Y); the part is on its right, so the arc turns to the left around (-5, 10).
  ASSERT_EQ(path[3].kind(), StepKind::arc);
  EXPECT_EQ(path[3].to(), (Point3{-3, 10, -4}));
  EXPECT_EQ(path[3].arc().centre, (Point2{-5, 10}));
  EXPECT_EQ(path[3].arc().turn, Turn::ccw);
  EXPECT_EQ(path[8].to(), (Point3{-3, 10, -4}));
  ASSERT_EQ(path[9].kind(), StepKind::arc);
  EXPECT_EQ(path[9].to(), (Point3{-7, 14, -4}));
  EXPECT_EQ(path[10].to(), (Point3{-7, 14, 5}));
  EXPECT_EQ(path[11].to(), (Point3{100, 100, 5}));
}

TEST(Leads, ALineIsSquareToThePathAndOnTheSideWithoutThePart) {
  Diagnostics diagnostics;
  const auto made = add_leads(
      around_plate(), {.lead_in = {LeadKind::line, mm(2)}, .overlap = mm(1.5), .part = PartSide::left},
      diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->path[2].to(), (Point3{-1, 10, -4}));
  EXPECT_EQ(made->path[3].to(), (Point3{-3, 10, -4}));
  EXPECT_EQ(made->path[9].to(), (Point3{-3, 11.5, -4}));
  EXPECT_EQ(made->path[10].to(), (Point3{-3, 11.5, 5}));
}

TEST(Leads, WhatDoesNotFitIsLeftOutWithAWarning) {
  Diagnostics diagnostics;
  // Inside of the loop there are 26 mm: a circle with a radius of 13.1 mm does not fit, one of 12.9 mm does.
  for (const auto& [radius, fits] : {std::pair(12.9, true), {13.1, false}}) {
    Diagnostics found;
    const auto made =
        add_leads(around_plate(), {.lead_in = {LeadKind::arc, mm(radius)}, .part = PartSide::left}, found);
    ASSERT_TRUE(made);
    EXPECT_EQ(warnings(found), fits ? 0u : 1u) << radius;
    EXPECT_EQ(made->path.size(), around_plate().size() + (fits ? 1 : 0));
  }
}

TEST(Leads, PathsReachedOrLeftInTheMaterialAreKept) {
  for (const bool reached : {true, false}) {
    Toolpath path;
    path.add(step::Rapid{{-3, 10, reached ? -1.0 : 1.0}}, OriginId::none);
    path.add(step::Cut{{-3, 10, -4}, mm_per_min(100)}, OriginId::none);
    for (const Point2 p : {Point2{-3, 23}, Point2{43, 23}, Point2{-3, 10}})
      path.add(step::Cut{{p.x, p.y, -4}, mm_per_min(500)}, OriginId::none);
    path.add(step::Rapid{{reached ? -3.0 : 0.0, 10, 5}}, OriginId::none);
    Diagnostics diagnostics;
    const auto made = add_leads(path, {.lead_in = {LeadKind::arc, mm(2)}}, diagnostics);
    ASSERT_TRUE(made);
    EXPECT_EQ(made->path.size(), path.size());
    EXPECT_EQ(warnings(diagnostics), 1u);
  }
}

TEST(Leads, TheFinishingPassIsOnePassAtTheFullDepth) {
  Diagnostics diagnostics;
  ReworkOptions options;
  for (const auto& [name, text] : {std::pair("finish", "0.5"), {"step-down", "1"}})
    ASSERT_EQ(set_rework(options, name, text), "");
  const auto made = rework(around_plate(), {}, options, diagnostics);
  ASSERT_TRUE(made);
  double low = 0.0;
  std::vector<double> levels;  // on which the path itself is cut along X
  for (const Motion& m : motions(made->path)) {
    low = std::min(low, m.low());
    if (!m.rapid && m.from.y == 23 && m.to.y == 23) levels.push_back(m.to.z);
    // The roughing passes stay half a millimetre away.
    if (!m.rapid && m.to.z > -4 + 1e-9 && m.low() < -1e-9 && m.from.z == m.to.z) {
      EXPECT_GE(m.distance_to({20, 23}), 0.5 - 1e-9);
    }
  }
  EXPECT_EQ(low, -4.0);
  EXPECT_EQ(levels, std::vector<double>{-4.0});
}

TEST(Leads, ABayThatRoughingCannotReachIsCutInPasses) {
  // A channel of 1 mm between two parts: 0.6 mm from both sides there is no way in.
  Toolpath path;
  const std::vector<Point2> loop{{0, 20},    {0, 40},    {60, 40},  {60, 0}, {30.5, 0},
                                 {30.5, 30}, {29.5, 30}, {29.5, 0}, {0, 0},  {0, 20}};
  path.add(step::Rapid{{0, 20, 5}}, OriginId::none);
  path.add(step::Cut{{0, 20, -4}, mm_per_min(100)}, OriginId::none);
  for (std::size_t i = 1; i < loop.size(); ++i)
    path.add(step::Cut{{loop[i].x, loop[i].y, -4}, mm_per_min(500)}, OriginId::none);
  path.add(step::Rapid{{0, 20, 5}}, OriginId::none);
  Diagnostics diagnostics;
  const auto made = add_leads(path, {.finish = mm(0.6)}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->whole.empty());
  const auto open = add_leads(path, {.finish = mm(0.2)}, diagnostics);
  ASSERT_TRUE(open);
  EXPECT_EQ(open->whole.size(), 1u);
}

TEST(Leads, AHelixIsBesideThePath) {
  Diagnostics diagnostics;
  const auto made = step_down(
      around_plate(),
      {.stepdown = mm(2), .entry = EntryKind::helix, .entry_angle = degrees(10), .helix_radius = mm(2.5)},
      diagnostics);
  ASSERT_TRUE(made);
  int helices = 0;
  for (std::size_t i = 0; i < made->size(); ++i) {
    if ((*made)[i].kind() != StepKind::arc) continue;
    ++helices;
    EXPECT_EQ((*made)[i].arc().centre, (Point2{-5.5, 10}));
    // A turn may descend by 2 pi 2.5 mm tan 10 degrees = 2.77 mm: one turn for 2 mm.
    EXPECT_EQ((*made)[i].arc().extra_turns, 0);
  }
  EXPECT_EQ(helices, 2);
}

/// The boundary of parts as one-pass contours that start with a plunge.
Toolpath plain_contours(const Region& parts, const Tool& tool, double depth) {
  Diagnostics diagnostics;
  ContourOptions options;
  options.cut.depth = mm(depth), options.cut.feed = mm_per_min(600);
  options.cut.entry.kind = EntryKind::plunge;
  const auto made = contour(parts, tool, options, diagnostics);
  return made ? made->path : Toolpath();
}

TEST(Leads, RandomPartsStayWholeAndAllThatWasCutIsCut) {
  std::mt19937 random(20261124);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Tool tool = mill(6);
  int leads = 0, whole = 0;
  for (int k = 0; k < 60; ++k) {
    const double bay = std::floor(draw(0, 8));
    std::vector<Outline> outlines{rectangle(0, 0, 60, 40), rectangle(10, 10, 10 + bay + 4, 30)};
    if (k % 2 == 0) outlines.push_back(as_outline({{45, 20}, mm(draw(2, 9))}));
    if (k % 3 == 0) outlines.push_back(rectangle(60 + std::floor(draw(1, 9)), 0, 90, 40));
    const Region parts = region_of(outlines);
    const Toolpath path = plain_contours(parts, tool, 4);
    ASSERT_GT(path.size(), 0u);
    LeadOptions how{.lead_in = {k % 4 == 0 ? LeadKind::line : LeadKind::arc, mm(draw(0.1, 4))},
                    .lead_out = {k % 5 == 0 ? LeadKind::none : LeadKind::arc, mm(draw(0.1, 4))},
                    .overlap = mm(k % 3),
                    .finish = mm(k % 2 == 0 ? 0.0 : draw(0.05, 1))};
    Diagnostics diagnostics;
    const auto led = add_leads(path, how, diagnostics);
    ASSERT_TRUE(led);
    leads += led->path.size() > path.size() ? 1 : 0, whole += led->whole.empty() ? 0 : 1;
    const auto made = step_down(led->path,
                                {.stepdown = mm(1.5),
                                 .entry = k % 3 == 0 ? EntryKind::helix : EntryKind::ramp,
                                 .helix_radius = mm(2.7),
                                 .whole = led->whole},
                                diagnostics);
    ASSERT_TRUE(made);
    const std::vector<Motion> before = motions(path), after = motions(*made);
    const RegionSearch inside(parts);
    for (double y = -8; y < 48; y += 0.7)
      for (double x = -8; x < 98; x += 0.7) {
        const Point2 p{x, y};
        if (inside.nearest(p)->distance.mm() < 0.01) continue;
        const bool part = inside.locate(p, mm(1e-6)) == Location::inside;
        if (part) {
          ASSERT_FALSE(touched(after, p, 3 - 1e-4, 0)) << k << ": gouged at " << x << ", " << y;
        } else if (removed_to(before, p, 3 - 1e-3, -4)) {
          ASSERT_TRUE(removed_to(after, p, 3, -4)) << k << ": left at " << x << ", " << y;
        }
      }
    ASSERT_EQ(rapid_problem(*made, 3, 0), "") << k;
  }
  EXPECT_GT(leads, 50);
  EXPECT_GT(whole, 10);
}

}  // namespace
}  // namespace kerf
