// Lines and arcs by themselves: directions, offsets, intersections, circles. Expectations are computed by
// hand.
#include "geom/base/line_arc.h"

#include <gtest/gtest.h>
#include <numbers>

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_point(Point2 found, Point2 wanted, double slack = 1e-12) {
  EXPECT_NEAR(found.x, wanted.x, slack);
  EXPECT_NEAR(found.y, wanted.y, slack);
}

/// A quarter circle of radius 2 about (1, 1), from its right to its top.
LineArc quarter() { return arc_about({1, 1}, {3, 1}, {1, 3}, Turn::ccw); }

TEST(LineArc, Directions) {
  expect_point(start_direction(line_between({1, 1}, {4, 5})), {0.6, 0.8});
  expect_point(end_direction(line_between({1, 1}, {4, 5})), {0.6, 0.8});
  expect_point(start_direction(quarter()), {0, 1});
  expect_point(end_direction(quarter()), {-1, 0});
  const LineArc back = arc_about({1, 1}, {1, 3}, {3, 1}, Turn::cw);
  expect_point(start_direction(back), {1, 0});
  expect_point(end_direction(back), {0, -1});
  EXPECT_EQ(start_direction(line_between({1, 1}, {1, 1})), Point2{});
}

TEST(LineArc, Sweep) {
  EXPECT_NEAR(sweep_to(quarter(), {1, 3}), 0.5 * kPi, 1e-12);
  EXPECT_NEAR(sweep_to(quarter(), {1, -1}), 1.5 * kPi, 1e-12);
  EXPECT_NEAR(sweep_to(quarter(), {3, 1}), 2 * kPi, 1e-12);
  EXPECT_NEAR(sweep_to(arc_about({0, 0}, {1, 0}, {0, 1}, Turn::cw), {0, 1}), 1.5 * kPi, 1e-12);
}

TEST(LineArc, Distance) {
  EXPECT_NEAR(distance_to(line_between({0, 0}, {4, 0}), {2, 3}), 3, 1e-12);
  EXPECT_NEAR(distance_to(line_between({0, 0}, {4, 0}), {7, 4}), 5, 1e-12);
  EXPECT_NEAR(distance_to(line_between({1, 1}, {1, 1}), {4, 5}), 5, 1e-12);
  EXPECT_NEAR(distance_to(quarter(), {1, 1}), 2, 1e-12);
  EXPECT_NEAR(distance_to(quarter(), {1 + 3 * std::sqrt(0.5), 1 + 3 * std::sqrt(0.5)}), 1, 1e-12);
  EXPECT_NEAR(distance_to(quarter(), {3, 0}), 1, 1e-12);  // beyond its start
}

TEST(LineArc, OffsetsOfLinesAndArcs) {
  const LineArc beside = *offset(line_between({0, 0}, {4, 0}), 1, 0);
  expect_point(beside.from, {0, 1});
  expect_point(beside.to, {4, 1});
  const LineArc inside = *offset(quarter(), 0.5, 0);  // the centre is on the left
  EXPECT_NEAR(inside.radius, 1.5, 1e-12);
  expect_point(inside.from, {2.5, 1});
  expect_point(inside.to, {1, 2.5});
  expect_point(inside.circle_centre(), {1, 1});
  const LineArc outside = *offset(quarter(), -0.5, 0);
  EXPECT_NEAR(outside.radius, 2.5, 1e-12);
  expect_point(outside.from, {3.5, 1});
  EXPECT_FALSE(offset(quarter(), 2, 0));
  EXPECT_FALSE(offset(quarter(), 1.9, 0.1 + 1e-9));
  EXPECT_TRUE(offset(arc_about({1, 1}, {1, 3}, {3, 1}, Turn::cw), 2, 0));
}

TEST(LineArc, CrossingsOfLines) {
  const Crossings found = carriers_cross(line_between({0, 0}, {1, 0}), line_between({3, 1}, {3, 2}), 0);
  ASSERT_EQ(found.count, 1);
  expect_point(found.at[0], {3, 0});
  EXPECT_EQ(carriers_cross(line_between({0, 0}, {1, 0}), line_between({0, 1}, {5, 1}), 0).count, 0);
}

TEST(LineArc, CrossingsWithCircles) {
  const LineArc level = line_between({-9, 2.2}, {-8, 2.2});  // 1.2 above the centre
  for (const Crossings& found : {carriers_cross(level, quarter(), 0), carriers_cross(quarter(), level, 0)}) {
    ASSERT_EQ(found.count, 2);
    const bool right_first = found.at[0].x > found.at[1].x;
    expect_point(found.at[right_first ? 0 : 1], {2.6, 2.2});
    expect_point(found.at[right_first ? 1 : 0], {-0.6, 2.2});
  }
  const LineArc other = arc_about({6, 1}, {9, 1}, {6, 4}, Turn::ccw);  // radius 3: touches at (3, 1)
  const Crossings touching = carriers_cross(quarter(), other, 1e-9);
  ASSERT_EQ(touching.count, 2);
  expect_point(touching.at[0], {3, 1}, 1e-6);
  const LineArc far = arc_about({7, 1}, {8, 1}, {7, 2}, Turn::ccw);
  EXPECT_EQ(carriers_cross(quarter(), far, 0).count, 0);
  EXPECT_EQ(carriers_cross(quarter(), quarter(), 0).count, 0);  // one circle
}

TEST(LineArc, TouchWithinTolerance) {
  const LineArc above = line_between({0, 3.000001}, {1, 3.000001});  // misses by 1e-6
  EXPECT_EQ(carriers_cross(quarter(), above, 0).count, 0);
  EXPECT_EQ(carriers_cross(quarter(), above, 0.9e-6).count, 0);
  const Crossings found = carriers_cross(quarter(), above, 1.1e-6);
  ASSERT_EQ(found.count, 2);
  expect_point(found.at[0], {1, 3}, 2e-6);
}

TEST(LineArc, CentreOverAChord) {
  expect_point(centre_over_chord({6, 0}, 5, 1), {3, 4});
  expect_point(centre_over_chord({6, 0}, 5, -1), {3, -4});
  expect_point(centre_over_chord({0, 6}, 5, 1), {-4, 3});
  expect_point(centre_over_chord({6, 0}, 2, 1), {3, 0});  // too small: half a turn
}

TEST(LineArc, CircleThroughThreePoints) {
  const CircleThrough left = circle_through({1, 1}, {0, 2}, 1e-9);
  expect_point(left.centre, {0, 1});
  EXPECT_EQ(left.turn, 1);
  EXPECT_EQ(circle_through({1, -1}, {0, -2}, 1e-9).turn, -1);
  EXPECT_EQ(circle_through({1, 0}, {2, 0}, 1e-9).turn, 0);
  EXPECT_EQ(circle_through({1, 1e-7}, {2, 0}, 1e-6).turn, 0);
  EXPECT_EQ(circle_through({0, 0}, {2, 0}, 1e-9).turn, 0);  // two points are one
}

TEST(LineArc, CircleOfABulge) {
  const Circle half = circle_of_bulge({0, 0}, {4, 0}, 1);
  expect_point(half.centre, {2, 0});
  EXPECT_NEAR(half.radius.mm(), 2, 1e-12);
  // A quarter turn counter-clockwise from (2, 0) to (0, 2) about the origin.
  const Circle quarter_turn = circle_of_bulge({2, 0}, {0, 2}, std::tan(kPi / 8));
  expect_point(quarter_turn.centre, {0, 0});
  EXPECT_NEAR(quarter_turn.radius.mm(), 2, 1e-12);
  expect_point(circle_of_bulge({0, 2}, {2, 0}, -std::tan(kPi / 8)).centre, {0, 0});
}

TEST(PlaneAxes, NameOrder) {
  EXPECT_EQ(named_axes_of(Plane::xy).u, 0);
  EXPECT_EQ(named_axes_of(Plane::xz).u, 0);
  EXPECT_EQ(named_axes_of(Plane::xz).v, 2);
  EXPECT_EQ(named_axes_of(Plane::xz).w, 1);
  EXPECT_EQ(named_axes_of(Plane::yz).u, 1);
  EXPECT_EQ(in_name_order(Plane::xy, {3, 4}), (Point2{3, 4}));
  EXPECT_EQ(in_name_order(Plane::xz, {3, 4}), (Point2{4, 3}));
}

}  // namespace
}  // namespace kerf
