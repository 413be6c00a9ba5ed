// Depth per pass, and resuming, over finished paths.
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/op.h"
#include "swept.h"

#include "kerf/op/mill.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

using namespace test;

Toolpath square_cut(double depth) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Rapid{{0, 0, 1}}, OriginId::none);
  path.add(step::Cut{{0, 0, -depth}, mm_per_min(100)}, OriginId::none);
  for (const Point2 p : {Point2{20, 0}, Point2{20, 20}, Point2{0, 20}, Point2{0, 0}})
    path.add(step::Cut{{p.x, p.y, -depth}, mm_per_min(500)}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  return path;
}

double length_at(const Toolpath& path, double z) {
  double sum = 0.0;
  for (const Motion& m : motions(path))
    if (!m.rapid && std::abs(m.from.z - z) < 1e-9 && std::abs(m.to.z - z) < 1e-9)
      sum += m.arc ? std::abs(m.sweep) * m.radius : distance(m.from, m.to);
  return sum;
}

TEST(StepDown, AClosedChainContinuesDownWhereItEnds) {
  Diagnostics diagnostics;
  const auto made = step_down(square_cut(6), {.top = 0, .stepdown = mm(2)}, diagnostics);
  ASSERT_TRUE(made);
  for (const double z : {-2.0, -4.0, -6.0}) EXPECT_NEAR(length_at(*made, z), 80, 1e-9) << z;
  int rapids = 0;
  for (const Motion& m : motions(*made)) rapids += m.rapid ? 1 : 0;
  EXPECT_EQ(rapids, 2);  // down at the start, and up at the end
  EXPECT_EQ(rapid_problem(*made, 2, 0), "");
}

TEST(StepDown, AShallowCutIsUnchanged) {
  Diagnostics diagnostics;
  const Toolpath path = square_cut(2);
  const auto made = step_down(path, {.top = 0, .stepdown = mm(2)}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->size(), path.size());
}

TEST(StepDown, AnOpenChainReturnsAtTheHeightOfItsRapid) {
  Toolpath path;
  path.add(step::Rapid{{50, 0, 8}}, OriginId::none);
  path.add(step::Rapid{{0, 0, 8}}, OriginId::none);
  path.add(step::Rapid{{0, 0, 0.5}}, OriginId::none);
  path.add(step::Cut{{0, 0, -3}, mm_per_min(100)}, OriginId::none);
  path.add(step::Note{"in the cut"}, OriginId::none);
  path.add(step::Cut{{30, 0, -3}, mm_per_min(500)}, OriginId::none);
  path.add(step::Arc{.to = {40, 10, -3}, .centre = {30, 10}, .turn = Turn::ccw, .feed = mm_per_min(500)},
           OriginId::none);
  path.add(step::Rapid{{40, 10, 8}}, OriginId::none);
  Diagnostics diagnostics;
  const auto made = step_down(path, {.top = 0, .stepdown = mm(1.5)}, diagnostics);
  ASSERT_TRUE(made);
  for (const double z : {-1.5, -3.0}) EXPECT_NEAR(length_at(*made, z), 30 + 5 * std::numbers::pi, 1e-9) << z;
  bool across = false;
  for (const Motion& m : motions(*made))
    if (m.rapid && m.from.x == 40 && m.to.x == 0) {
      EXPECT_EQ(m.from.z, 8);
      EXPECT_EQ(m.to.z, 8);
      across = true;
    }
  EXPECT_TRUE(across);
  EXPECT_EQ(rapid_problem(*made, 1, 0), "");
  std::size_t notes = 0;
  for (std::size_t i = 0; i < made->size(); ++i) notes += (*made)[i].kind() == StepKind::note ? 1 : 0;
  EXPECT_EQ(notes, 1u);
}

TEST(StepDown, SlopesAndArcsStayAboveTheLevelOfTheirPass) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Cut{{20, 0, -6}, mm_per_min(500)}, OriginId::none);
  path.add(step::Arc{.to = {40, 0, -6},
                     .centre = {30, -6},
                     .plane = Plane::xz,
                     .turn = Turn::cw,
                     .feed = mm_per_min(500)},
           OriginId::none);
  path.add(
      step::Arc{
          .to = {40, 0, 2}, .centre = {40, 10}, .turn = Turn::ccw, .extra_turns = 1, .feed = mm_per_min(500)},
      OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  Diagnostics diagnostics;
  const auto made = step_down(path, {.top = 0, .stepdown = mm(2)}, diagnostics);
  ASSERT_TRUE(made);
  // No cut goes more than a pass deeper than what was cut there before.
  std::vector<Motion> before;
  for (const Motion& m : motions(*made)) {
    if (!m.rapid && !m.arc && m.from.xy() != m.to.xy()) {
      const Point3 at = m.from + 0.5 * (m.to - m.from);
      if (at.z < -2.0 - 1e-6) {
        EXPECT_TRUE(removed_to(before, at.xy(), 0.2, at.z + 2.0 + 0.05))
            << at.x << " " << at.y << " " << at.z;
      }
    }
    before.push_back(m);
  }
}

TEST(StepDown, RampsReplacePlunges) {
  for (const double stepdown : {0.0, 2.0}) {
    Diagnostics diagnostics;
    const auto made =
        step_down(square_cut(6),
                  {.top = 0, .stepdown = mm(stepdown), .entry = EntryKind::ramp, .entry_angle = degrees(10)},
                  diagnostics);
    ASSERT_TRUE(made);
    double whole = 0.0;  // of descents
    for (const Motion& m : motions(*made)) {
      if (m.rapid || m.to.z > m.from.z - 1e-12 || m.from.z > 0) continue;
      EXPECT_LE(m.from.z - m.to.z, std::tan(degrees(10).rad()) * distance(m.from.xy(), m.to.xy()) + 1e-9);
      whole += m.from.z - m.to.z;
      // On the first side of the square.
      EXPECT_EQ(m.from.y, 0.0);
      EXPECT_EQ(m.to.y, 0.0);
    }
    EXPECT_NEAR(whole, 6, 1e-9);
    EXPECT_GE(length_at(*made, -6), 80 - 1e-9);
    EXPECT_EQ(rapid_problem(*made, 2, 0), "");
    // The feed downwards is at most that of the plunge.
    for_each_motion(*made, [](const Step& s, const MotionContext& c) {
      if (!s.is_cutting() || s.to().z >= c.from.z) return;
      const double drop = c.from.z - s.to().z;
      EXPECT_LE(s.feed().mm_per_min() * drop / std::hypot(drop, distance(s.to().xy(), c.from.xy())),
                100 + 1e-9);
    });
  }
  Diagnostics diagnostics;
  EXPECT_FALSE(step_down(square_cut(6), {.stepdown = mm(2), .entry = EntryKind::helix}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_option);
}

TEST(StepDown, WhatCannotBeDividedIsRefused) {
  Diagnostics diagnostics;
  EXPECT_FALSE(step_down(square_cut(6), {.top = 0, .stepdown = mm(0)}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_option);
  Toolpath path = square_cut(6);
  path.set_unknown_axes(4, 1);
  EXPECT_FALSE(step_down(path, {.top = 0, .stepdown = mm(1)}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_refused);
  EXPECT_FALSE(step_down(square_cut(6), {.top = 0, .stepdown = mm(1e-9)}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_refused);
}

/// The same steps with a line number each, from 1.
Toolpath numbered(const Toolpath& path) {
  Toolpath out;
  const std::uint32_t file = out.origins().file("part.nc");
  for (std::size_t i = 0; i < path.size(); ++i) {
    const OriginId line = out.origins().text(file, static_cast<std::uint32_t>(i) + 1, 1);
    const Step& s = path[i];
    switch (s.kind()) {
      case StepKind::rapid: {
        const std::size_t added = out.add(s.rapid(), line);
        if (s.unknown_axes() != 0) out.set_unknown_axes(added, s.unknown_axes());
        break;
      }
      case StepKind::cut: out.add(s.cut(), line); break;
      case StepKind::arc: out.add(s.arc(), line); break;
      case StepKind::tool_change: out.add(s.tool_change(), line); break;
      case StepKind::spindle: out.add(s.spindle(), line); break;
      default: break;
    }
  }
  return out;
}

TEST(Resume, TheRestRemovesWhatTheWholeRemoves) {
  Diagnostics diagnostics;
  const Region region = region_of({rectangle(0, 0, 30, 20)});
  CutOptions cut;
  cut.depth = mm(4), cut.stepdown = mm(2), cut.feed = mm_per_min(600);
  const auto pocketed = pocket(region, mill(6), {.cut = cut}, diagnostics);
  ASSERT_TRUE(pocketed);
  Toolpath whole;
  whole.add(step::ToolChange{1}, OriginId::none);
  whole.add(step::Spindle{rpm(12000), SpindleTurn::cw}, OriginId::none);
  append(whole, pocketed->path);
  whole = numbered(whole);
  for (std::uint32_t line = 4; line <= whole.size(); line += 3) {
    const auto rest = resume_from(whole, {.line = line, .safe_z = 5}, diagnostics);
    ASSERT_TRUE(rest) << line;
    EXPECT_EQ(rest->first, line - 1);
    // Tool and spindle first.
    EXPECT_EQ(rest->path[0].kind(), StepKind::tool_change);
    EXPECT_EQ(rest->path[1].spindle().speed, rpm(12000));
    // The part before the line, then the rest: the same as the whole.
    std::vector<Motion> cuts = motions(rest->path);
    Toolpath before;
    for (std::size_t i = 0; i + 1 < line; ++i) before.add_copy(whole, i);
    for (const Motion& m : motions(before)) cuts.push_back(m);
    const std::vector<Motion> all = motions(whole);
    for (double x = 0.3; x < 30; x += 1.1)
      for (double y = 0.3; y < 20; y += 1.1)
        ASSERT_EQ(removed_to(cuts, {x, y}, 3, -4), removed_to(all, {x, y}, 3, -4))
            << line << " " << x << " " << y;
    for (std::size_t i = 0; i < rest->path.size(); ++i) before.add_copy(rest->path, i);
    EXPECT_EQ(rapid_problem(before, 3, 0), "") << line;
  }
}

TEST(Resume, LinesWithoutMotionAndUnknownPositionsAreErrors) {
  Diagnostics diagnostics;
  Toolpath whole = numbered(square_cut(3));
  EXPECT_FALSE(resume_from(whole, {.line = 100, .safe_z = 5}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::resume_line);
  EXPECT_FALSE(resume_from(whole, {.line = 0, .safe_z = 5}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_option);
  whole.set_unknown_axes(2, 4);
  EXPECT_FALSE(resume_from(whole, {.line = 4, .safe_z = 5}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::resume_line);
  Toolpath print;
  print.add(step::Extrude{{1, 1, 1}, mm3(1), mm(0.4), mm(0.2), mm_per_min(1000)}, OriginId::none);
  EXPECT_FALSE(resume_from(print, {.line = 1, .safe_z = 5}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_refused);
}

TEST(Resume, CoordinatesSelectedBeforeStay) {
  Toolpath path;
  const std::uint32_t file = path.origins().file("part.nc");
  const auto line = [&](std::uint32_t n) { return path.origins().text(file, n, 1); };
  path.add(step::WorkZero{.kind = ZeroKind::select, .system = 2}, line(1));
  path.add(step::Rapid{{0, 0, 5}}, line(2));
  path.add(step::Cut{{0, 0, -1}, mm_per_min(100)}, line(3));
  path.add(step::Cut{{9, 0, -1}, mm_per_min(100)}, line(4));
  Diagnostics diagnostics;
  auto rest = resume_from(path, {.line = 4, .safe_z = 5}, diagnostics);
  ASSERT_TRUE(rest);
  ASSERT_TRUE(rest->path.has(StepKind::work_zero));
  Toolpath shifted;
  const std::uint32_t again = shifted.origins().file("part.nc");
  shifted.add(step::Rapid{{0, 0, 5}}, shifted.origins().text(again, 1, 1));
  shifted.add(step::WorkZero{.kind = ZeroKind::shift, .axes = 1}, shifted.origins().text(again, 2, 1));
  shifted.add(step::Cut{{9, 0, -1}, mm_per_min(100)}, shifted.origins().text(again, 3, 1));
  EXPECT_FALSE(resume_from(shifted, {.line = 3, .safe_z = 5}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::resume_line);
}

}  // namespace
}  // namespace kerf
