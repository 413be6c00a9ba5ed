// Transforms, copies and order of finished paths.
#include <array>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "base/codes/op.h"
#include "swept.h"

#include "kerf/op/mill.h"
#include "kerf/op/rework.h"

namespace kerf {
namespace {

using namespace test;

CutOptions usual(double depth = 2.0) {
  CutOptions cut;
  cut.depth = mm(depth), cut.stepdown = mm(1.5), cut.feed = mm_per_min(600),
  cut.entry.kind = EntryKind::plunge;
  return cut;
}
Toolpath cut_part() {
  Diagnostics diagnostics;
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  const Region part =
      region_of({polygon({{0, 0}, {30, 0}, {30, 20}, {10, 12}}), as_outline({{22, 8}, mm(4)})});
  append(path, contour(part, mill(3), {.cut = usual()}, diagnostics)->path);
  path.add(step::End{}, OriginId::none);
  return path;
}

/// Samples of all cuts with Z.
std::vector<Point3> samples(const Toolpath& path) {
  std::vector<Point3> points;
  for (const Motion& m : motions(path)) {
    if (m.rapid) continue;
    for (double t = 0.1; t < 1.0; t += 0.4) {
      const double z = m.from.z + t * (m.to.z - m.from.z);
      if (m.arc) {
        const double a = m.start + t * m.sweep;
        points.push_back({m.centre.x + m.radius * std::cos(a), m.centre.y + m.radius * std::sin(a), z});
      } else {
        const Point3 p = m.from + t * (m.to - m.from);
        points.push_back(p);
      }
    }
  }
  return points;
}

TEST(Transform, EveryPointOfTheCutIsMapped) {
  const Toolpath path = cut_part();
  std::mt19937_64 random(7);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int k = 0; k < 40; ++k) {
    PathTransform t;
    if (k % 2 == 0) t.scale = in(0.3, 3);
    if (k % 3 == 0) t.mirror = k % 6 == 0 ? Mirror::x : Mirror::y;
    t.rotate = degrees(k % 4 == 0 ? 90.0 * (k % 5) : in(-400, 400));
    t.move = {in(-50, 50), in(-50, 50), in(-2, 2)}, t.centre = {in(-9, 9), in(-9, 9)};
    Diagnostics diagnostics;
    const auto made = transformed(path, t, diagnostics);
    ASSERT_TRUE(made);
    const std::vector<Point3> before = samples(path), after = samples(*made);
    ASSERT_EQ(before.size(), after.size());
    const double c = std::cos(t.rotate.rad()), s = std::sin(t.rotate.rad());
    for (std::size_t i = 0; i < before.size(); ++i) {
      Point2 d = t.scale * (before[i].xy() - t.centre);
      if (t.mirror == Mirror::x) d.x = -d.x;
      if (t.mirror == Mirror::y) d.y = -d.y;
      const Point3 expected{t.centre.x + c * d.x - s * d.y + t.move.x,
                            t.centre.y + s * d.x + c * d.y + t.move.y, before[i].z + t.move.z};
      ASSERT_NEAR(after[i].x, expected.x, 1e-6);
      ASSERT_NEAR(after[i].y, expected.y, 1e-6);
      ASSERT_NEAR(after[i].z, expected.z, 1e-9);
    }
  }
}

/// The signed area that the cuts on level `z` go around: above 0 counter-clockwise.
double turned_area(const Toolpath& path, double z) {
  double sum = 0.0;
  for (const Motion& m : motions(path)) {
    if (m.rapid || m.from.z != z || m.to.z != z) continue;
    sum += 0.5 * cross(m.from.xy(), m.to.xy());
    if (m.arc) sum += 0.5 * m.radius * m.radius * (m.sweep - std::sin(m.sweep));
  }
  return sum;
}

TEST(Transform, AMirroredProgramWithReversedLoopsCutsAsBefore) {
  Diagnostics diagnostics;
  Toolpath path;
  append(path, contour(region_of({rectangle(0, 0, 30, 20)}), mill(4), {.cut = usual(1)}, diagnostics)->path);
  EXPECT_LT(turned_area(path, -1), 0.0);  // climb around a part is clockwise
  const auto mirrored = transformed(path, {.mirror = Mirror::x}, diagnostics);
  ASSERT_TRUE(mirrored);
  EXPECT_GT(turned_area(*mirrored, -1), 0.0);
  const Toolpath again = reversed_loops(*mirrored);
  EXPECT_NEAR(turned_area(again, -1), turned_area(path, -1), 1e-9);
  EXPECT_EQ(rapid_problem(again, 2, 0), "");
  EXPECT_EQ(again.size(), path.size());
}

/// A quarter turn makes X of Y; another angle needs both axes.
TEST(Transform, AQuarterTurnExchangesTheNamedAxes) {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  const unsigned x = 1, y = 2, z = 4;
  for (const auto& [to, named] :
       {std::pair(Point3{9, 0, 5}, x), std::pair(Point3{9, 7, 5}, y), std::pair(Point3{2, 7, 3}, x | z)})
    path.set_named_axes(path.add(step::Cut{to, mm_per_min(100)}, OriginId::none), named);
  Diagnostics diagnostics;
  for (const auto& [degree, first, second, third] :
       {std::array{90u, y, x, y | z}, std::array{180u, x, y, x | z}, std::array{270u, y, x, y | z},
        std::array{30u, x | y, x | y, x | y | z}}) {
    const auto made = transformed(path, {.rotate = degrees(degree)}, diagnostics);
    ASSERT_TRUE(made);
    EXPECT_EQ((*made)[1].named_axes(), first) << degree;
    EXPECT_EQ((*made)[2].named_axes(), second) << degree;
    EXPECT_EQ((*made)[3].named_axes(), third) << degree;
  }
}

/// A turn about Z and a mirror in X or Y change no height: an arc that goes over its ends still does.
TEST(Transform, UprightArcsStayAboveOrBelowTheirEnds) {
  for (const Plane plane : {Plane::xz, Plane::yz})
    for (const Turn turn : {Turn::cw, Turn::ccw})
      for (const Mirror mirror : {Mirror::none, Mirror::x, Mirror::y})
        for (const double degree : {0.0, 90.0, 180.0, 270.0}) {
          Toolpath path;
          path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
          path.add(step::Arc{.to = plane == Plane::xz ? Point3{10, 0, 0} : Point3{0, 10, 0},
                             .centre = {5, 0},
                             .plane = plane,
                             .turn = turn,
                             .feed = mm_per_min(100)},
                   OriginId::none);
          Diagnostics diagnostics;
          const auto made = transformed(path, {.mirror = mirror, .rotate = degrees(degree)}, diagnostics);
          ASSERT_TRUE(made);
          const Box3 before = walk_of(path[1], path[0].to()).bounds();
          const Box3 after = walk_of((*made)[1], (*made)[0].to()).bounds();
          EXPECT_NEAR(after.low.z, before.low.z, 1e-9) << degree;
          EXPECT_NEAR(after.high.z, before.high.z, 1e-9) << degree;
          EXPECT_NEAR(after.high.z - after.low.z, 5.0, 1e-9);
        }
}

/// G53 G0 X-100 leads to a position of the machine, which does not turn with the part: a motion of Z alone
/// leaves X there, and Y known.
TEST(Transform, AnAxisAtAPositionOfTheMachineStaysThere) {
  Toolpath path;
  path.add(step::Rapid{{10, 0, 5}}, OriginId::none);
  const std::size_t machine = path.add(step::Rapid{{-100, 0, 5}}, OriginId::none);
  path.set_unknown_axes(machine, 1);
  path.set_reference(machine, Reference::machine, 1);
  path.set_unknown_axes(path.add(step::Rapid{{-100, 0, 8}}, OriginId::none), 1);
  for (const double degree : {90.0, 30.0, 180.0}) {
    Diagnostics diagnostics;
    const auto made = transformed(path, {.rotate = degrees(degree)}, diagnostics);
    ASSERT_TRUE(made);
    for (const std::size_t i : {1u, 2u}) {
      EXPECT_EQ((*made)[i].unknown_axes(), 1u) << degree;
      EXPECT_EQ((*made)[i].to().x, -100.0) << degree;
      EXPECT_NEAR((*made)[i].to().y, 10 * std::sin(degrees(degree).rad()), 1e-9) << degree;
    }
    EXPECT_EQ((*made)[2].to().z, 8.0);
  }
}

TEST(Transform, WhatCannotBeMovedIsRefused) {
  Diagnostics diagnostics;
  Toolpath path = cut_part();
  EXPECT_FALSE(transformed(path, {.scale = 0.0}, diagnostics));
  EXPECT_FALSE(transformed(path, {.scale = std::nan("")}, diagnostics));
  EXPECT_FALSE(transformed(path, {.rotate = degrees(INFINITY)}, diagnostics));
  EXPECT_FALSE(repeated(path, {.columns = 0}, diagnostics));
  EXPECT_FALSE(repeated(path, {.columns = 2}, diagnostics));
  for (const Diagnostic& d : diagnostics.list()) EXPECT_EQ(d.code, codes::pass_option);
  EXPECT_EQ(diagnostics.errors(), 5u);
  path.add(step::Probe{{0, 0, -5}, mm_per_min(10)}, OriginId::none);
  EXPECT_FALSE(transformed(path, {.rotate = degrees(1)}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_refused);
  EXPECT_FALSE(repeated(path, {.columns = 2, .pitch = {5, 5}}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_refused);
}

TEST(Repeat, CopiesAreCutWithOneToolAndLinkedAtTheHeightOfRapids) {
  Diagnostics diagnostics;
  Toolpath path;
  for (const int tool : {1, 2}) {
    path.add(step::ToolChange{tool}, OriginId::none);
    path.add(step::Spindle{rpm(9000), SpindleTurn::cw}, OriginId::none);
    append(path, contour(region_of({rectangle(0, 0, 10, 8)}), mill(2), {.cut = usual()}, diagnostics)->path);
  }
  path.add(step::End{}, OriginId::none);
  const auto made = repeated(path, {.columns = 3, .rows = 2, .pitch = {20, 15}}, diagnostics);
  ASSERT_TRUE(made);
  std::size_t changes = 0;
  for (const Step& s : made->steps()) changes += s.kind() == StepKind::tool_change ? 1 : 0;
  EXPECT_EQ(changes, 2u);
  EXPECT_EQ(rapid_problem(*made, 1, 0), "");
  const std::vector<Motion> cuts = motions(*made);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 2; ++row) {
      EXPECT_TRUE(removed_to(cuts, {20.0 * column + 5, 15.0 * row - 0.5}, 1.0, -2));
      EXPECT_FALSE(touched(cuts, {20.0 * column + 5, 15.0 * row + 4}, 1.0, 0));
    }
  EXPECT_EQ(samples(*made).size(), 6 * samples(path).size());
}

/// The centre of an arc goes with its copy; in XZ it is X and Z, in YZ Y and Z.
TEST(Repeat, CentresOfArcsGoWithTheirCopies) {
  Toolpath path;
  const Feed feed = mm_per_min(100);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Arc{.to = {10, 0, 5}, .centre = {5, 0}, .feed = feed}, OriginId::none);
  path.add(step::Arc{.to = {20, 0, 5}, .centre = {15, 5}, .plane = Plane::xz, .feed = feed}, OriginId::none);
  path.add(step::Arc{.to = {20, 8, 5}, .centre = {4, 5}, .plane = Plane::yz, .feed = feed}, OriginId::none);
  path.add(step::Rapid{{20, 8, 9}}, OriginId::none);
  Diagnostics diagnostics;
  const auto made = repeated(path, {.columns = 2, .rows = 2, .pitch = {100, 50}}, diagnostics);
  ASSERT_TRUE(made);
  std::vector<Point2> xy, xz, yz;
  for (const Step& s : made->steps())
    if (s.kind() == StepKind::arc)
      (s.arc().plane == Plane::xy ? xy : s.arc().plane == Plane::xz ? xz : yz).push_back(s.arc().centre);
  // Every other row is cut from its end.
  EXPECT_EQ(xy, (std::vector<Point2>{{5, 0}, {105, 0}, {105, 50}, {5, 50}}));
  EXPECT_EQ(xz, (std::vector<Point2>{{15, 5}, {115, 5}, {115, 5}, {15, 5}}));
  EXPECT_EQ(yz, (std::vector<Point2>{{4, 5}, {4, 5}, {54, 5}, {54, 5}}));
}

/// Contours of parts with holes in a row, in an order that goes back and forth, each part before its hole.
Toolpath scattered(int count) {
  Diagnostics diagnostics;
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  for (int i = 0; i < count; ++i) {
    const double x = 40.0 * ((i * 7) % count);
    const Circle outer{{x, 0}, mm(12)}, hole{{x, 0}, mm(4)};
    path.add(step::Note{"part"}, OriginId::none);
    append(path, contour(region_of({as_outline(outer)}), mill(3), {.cut = usual()}, diagnostics)->path);
    append(path, contour(region_of({as_outline(hole)}), mill(3),
                         {.cut = usual(), .side = ContourSide::inside}, diagnostics)
                     ->path);
  }
  path.add(step::Spindle{}, OriginId::none);
  path.add(step::End{}, OriginId::none);
  return path;
}

TEST(Order, RapidsGetShortAndInnerContoursComeFirst) {
  const int count = 11;
  const Toolpath path = scattered(count);
  const Ordered made = order_cuts(path, {{1, mm(3)}});
  EXPECT_EQ(made.blocks, 22u);
  // Along the row once, and within each part from the hole to the outside.
  EXPECT_LE(made.rapid_after, 40.0 * count + 14.0 * count + 40);
  EXPECT_GT(made.rapid_before, 2 * made.rapid_after);
  std::vector<double> first_cut(2 * static_cast<std::size_t>(count), -1.0);
  double index = 0.0;
  for (const Motion& m : motions(made.path)) {
    index += 1.0;
    if (m.rapid || m.to.z >= 0) continue;
    const auto part = static_cast<std::size_t>(std::lround(m.to.x / 40.0));
    const bool hole = distance(m.to.xy(), {40.0 * static_cast<double>(part), 0}) < 4;
    double& first = first_cut[2 * part + (hole ? 0 : 1)];
    if (first < 0) first = index;
  }
  for (std::size_t part = 0; part < static_cast<std::size_t>(count); ++part)
    EXPECT_LT(first_cut[2 * part], first_cut[2 * part + 1]) << part;
  // The same cuts, all notes, and the end.
  EXPECT_EQ(samples(made.path).size(), samples(path).size());
  std::size_t notes = 0;
  for (const Step& s : made.path.steps()) notes += s.kind() == StepKind::note ? 1 : 0;
  EXPECT_EQ(notes, static_cast<std::size_t>(count));
  EXPECT_EQ(made.path.steps().back().kind(), StepKind::end);
  EXPECT_EQ(rapid_problem(made.path, 1.5, 0), "");
}

TEST(Order, CutsNearEachOtherKeepTheirOrder) {
  // Passes of a slot, each a block of its own, and a deeper pocket in a pocket.
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Rapid{{100, 100, 5}}, OriginId::none);
  for (const double z : {-1.0, -2.0, -3.0})
    for (const double x : {0.0, 50.0}) {
      path.add(step::Rapid{{x, 0, 5}}, OriginId::none);
      path.add(step::Cut{{x, 0, z}, mm_per_min(100)}, OriginId::none);
      path.add(step::Cut{{x + 20, 0, z}, mm_per_min(500)}, OriginId::none);
      path.add(step::Rapid{{x + 20, 0, 5}}, OriginId::none);
    }
  const Ordered made = order_cuts(path, {{1, mm(3)}});
  EXPECT_EQ(made.blocks, 6u);
  EXPECT_LT(made.rapid_after, made.rapid_before);
  double left = 0.0, right = 0.0;
  for (const Motion& m : motions(made.path)) {
    if (m.rapid || m.from.xy() == m.to.xy()) continue;
    double& last = m.to.x < 40 ? left : right;
    EXPECT_EQ(m.to.z, last - 1.0);
    last = m.to.z;
  }
}

TEST(Rework, KeysSetWhatTheySay) {
  ReworkOptions options;
  EXPECT_EQ(set_rework(options, "step-down", "2.5"), "");
  EXPECT_EQ(options.passes.stepdown, mm(2.5));
  EXPECT_EQ(set_rework(options, "move", "1, -2,3"), "");
  EXPECT_EQ(options.transform.move, (Point3{1, -2, 3}));
  EXPECT_EQ(set_rework(options, "mirror", "Y"), "");
  EXPECT_EQ(options.transform.mirror, Mirror::y);
  EXPECT_EQ(set_rework(options, "pitch", "5,6"), "");
  EXPECT_EQ(set_rework(options, "order", ""), "");
  EXPECT_TRUE(options.order);
  for (const auto& [name, text] : std::vector<std::pair<const char*, const char*>>{{"step-down", "0"},
                                                                                   {"step-down", "deep"},
                                                                                   {"move", "1"},
                                                                                   {"move", "1,2,3,4"},
                                                                                   {"move", "1,nan"},
                                                                                   {"mirror", "z"},
                                                                                   {"tabs", "1.5"},
                                                                                   {"entry", "spiral"},
                                                                                   {"lead", "-1"},
                                                                                   {"part", "up"},
                                                                                   {"lead-kind", "none"},
                                                                                   {"finish", "0"},
                                                                                   {"columns", "0"},
                                                                                   {"pitch", "5"},
                                                                                   {"none", "1"}})
    EXPECT_NE(set_rework(options, name, text), "") << name << " " << text;
  // Tabs need the diameter of the tool.
  ReworkOptions tabs;
  ASSERT_EQ(set_rework(tabs, "tab-height", "1"), "");
  Diagnostics diagnostics;
  EXPECT_FALSE(rework(cut_part(), {}, tabs, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::pass_option);
  EXPECT_TRUE(rework(cut_part(), {{1, mill(3)}}, tabs, diagnostics));
}

}  // namespace
}  // namespace kerf
