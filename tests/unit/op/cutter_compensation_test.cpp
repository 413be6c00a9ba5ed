// Cutter compensation element by element. Expectations are computed by hand; whole programs are compared with
// LinuxCNC's interpreter in tests/data/gcode/moves.txt and tests/conformance.
#include "op/mill/cutter_compensation.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

constexpr double kFar = 1e7;

void expect_point(Point2 found, Point2 wanted) {
  EXPECT_NEAR(found.x, wanted.x, 1e-9);
  EXPECT_NEAR(found.y, wanted.y, 1e-9);
}

TEST(CutterCompensation, LeadsInToTheOffsetOfTheFirstEnd) {
  CutterCompensation cutter(2, kFar);
  EXPECT_FALSE(cutter.entered());
  const auto made = cutter.add(line_between({-10, 0}, {0, 0}));
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->short_entry);
  EXPECT_FALSE(made->corner || made->previous_end);
  expect_point(made->axis.from, {-10, 0});
  expect_point(made->axis.to, {0, 2});
  EXPECT_TRUE(cutter.entered());
  expect_point(cutter.tool(), {0, 2});
}

TEST(CutterCompensation, RoundsOutsideCorners) {
  CutterCompensation cutter(2, kFar);
  cutter.add(line_between({-10, 0}, {0, 0}));
  const auto made = cutter.add(line_between({0, 0}, {0, -10}));  // turns right, the tool is on the left
  ASSERT_TRUE(made && made->corner);
  expect_point(made->corner->from, {0, 2});
  expect_point(made->corner->to, {2, 0});
  expect_point(made->corner->circle_centre(), {0, 0});
  EXPECT_EQ(made->corner->turn, -1);
  expect_point(made->axis.from, {2, 0});
  expect_point(made->axis.to, {2, -10});
  EXPECT_FALSE(made->gouges);
}

TEST(CutterCompensation, InsideCornersEndWhereTheOffsetsIntersect) {
  CutterCompensation cutter(-2, kFar);
  EXPECT_FALSE(cutter.is_left());
  cutter.add(line_between({-10, 0}, {-9, 0}));
  cutter.add(line_between({-9, 0}, {0, 0}));
  const auto made = cutter.add(line_between({0, 0}, {0, -10}));  // turns right, to the tool's side
  ASSERT_TRUE(made && made->previous_end);
  expect_point(*made->previous_end, {-2, -2});
  expect_point(made->axis.from, {-2, -2});
  expect_point(made->axis.to, {-2, -10});
  EXPECT_TRUE(cutter.ends_forward());
}

TEST(CutterCompensation, ATooNarrowCornerGouges) {
  CutterCompensation cutter(2, kFar);
  cutter.add(line_between({-10, 0}, {-3, 0}));
  cutter.add(line_between({-3, 0}, {-2, 0}));
  const auto made = cutter.add(line_between({-2, 0}, {-2, 9}));  // a tool of radius 2 does not fit into 1 mm
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->gouges);
  EXPECT_FALSE(made->previous_end);
}

TEST(CutterCompensation, SmallCornersAreSmooth) {
  CutterCompensation cutter(2, kFar);
  cutter.add(line_between({-10, 0}, {0, 0}));
  const auto made = cutter.add(line_between({0, 0}, {10, 0.4}));
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->corner || made->previous_end);
  expect_point(made->axis.from, {0, 2});
}

TEST(CutterCompensation, ArcsKeepTheirCentre) {
  CutterCompensation cutter(-2, kFar);
  cutter.add(line_between({-10, 0}, {0, 0}));
  const auto made = cutter.add(arc_about({0, 5}, {0, 0}, {5, 5}, Turn::ccw));
  ASSERT_TRUE(made);
  expect_point(made->axis.from, {0, -2});
  expect_point(made->axis.to, {7, 5});
  expect_point(made->axis.circle_centre(), {0, 5});
  EXPECT_NEAR(made->axis.radius, 7, 1e-9);
}

TEST(CutterCompensation, RefusesArcsThatAreTooSmall) {
  CutterCompensation cutter(2, kFar);
  cutter.add(line_between({-10, 0}, {0, 0}));
  EXPECT_FALSE(
      cutter.add(arc_about({0, 2}, {0, 0}, {2, 2}, Turn::ccw)));  // from inside, of the tool's radius
  EXPECT_TRUE(cutter.add(arc_about({0, -2}, {0, 0}, {2, -2}, Turn::cw)));
}

TEST(CutterCompensation, AFirstArcIsTangentToTheOffsetAtItsEnd) {
  CutterCompensation cutter(-1, kFar);
  const auto made = cutter.add(arc_about({0, 5}, {0, 0}, {5, 5}, Turn::ccw));
  ASSERT_TRUE(made);
  expect_point(made->axis.from, {0, 0});
  expect_point(made->axis.to, {6, 5});
  expect_point(end_direction(made->axis), {0, 1});
  // The centre (x, 5) is as far from (0, 0) as from (6, 5): x^2 + 25 = (6 - x)^2.
  expect_point(made->axis.circle_centre(), {11.0 / 12, 5});
}

TEST(CutterCompensation, ShortEntries) {
  CutterCompensation line(2, kFar), arc(2, kFar);
  const auto made = line.add(line_between({0, 0}, {2, 0}));
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->short_entry);
  EXPECT_FALSE(arc.add(arc_about({9, 0}, {0, 0}, {9 - std::sqrt(80.0), 1}, Turn::cw)));
}

TEST(CutterCompensation, SpikesTurnOutsideUnlessTheirSidesCurveAway) {
  CutterCompensation cutter(1, kFar);
  cutter.add(line_between({-10, 0}, {0, 0}));
  const auto back = cutter.add(line_between({0, 0}, {-10, 0}));
  ASSERT_TRUE(back && back->corner);
  expect_point(back->corner->to, {0, -1});
}

TEST(CutterCompensation, ChangesItsSideWithTheNextElement) {
  CutterCompensation cutter(1, kFar);
  cutter.add(line_between({-10, 0}, {0, 0}));
  cutter.change(-3);
  const auto made = cutter.add(line_between({0, 0}, {10, 0}));
  ASSERT_TRUE(made);
  expect_point(made->axis.from, {0, 1});
  expect_point(made->axis.to, {10, -3});
}

TEST(CutterCompensation, IntersectionsOutOfReachCountAsNone) {
  CutterCompensation cutter(2, 5);
  cutter.add(line_between({-90, 0}, {-80, 0}));
  const auto made = cutter.add(line_between({-80, 0}, {-80, 40}));
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->gouges);
}

}  // namespace
}  // namespace kerf
