// Printing times computed by hand: ramps, corners by each firmware's rule, limits in the program.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "kerf/path/estimate.h"

namespace kerf {
namespace {

const Feed kFast = mm_per_min(6000);  // 100 mm/s

PrintPlanner planner(CornerRule corners) {
  PrintPlanner p;
  p.corners = corners;
  p.axis_speed = {200, 200, 10, 50};
  p.axis_acceleration = {1000, 1000, 100, 5000};
  p.jerk = {10, 10, 0.4, 5};
  p.acceleration = {1000, 1000, 1000};
  p.corner_speed = 5;
  p.junction_deviation = 0.01;
  return p;
}

/// Travel through these points at 100 mm/s.
Toolpath travel(const std::vector<Point3>& points) {
  Toolpath path;
  path.add(step::Rapid{points.front()}, OriginId::none);
  for (std::size_t i = 1; i < points.size(); ++i) path.add(step::Cut{points[i], kFast}, OriginId::none);
  return path;
}

/// Without the first motion, which is from an unknown position.
double time(const Toolpath& path, const PrintPlanner& p) {
  return estimate_print_time(path, p).total().seconds();
}

TEST(PrintTime, a_motion_has_two_ramps) {
  // From rest at 1000 mm/s2: 0.1 s and 5 mm to 100 mm/s, and the same to brake; 90 mm at speed.
  EXPECT_NEAR(time(travel({{0, 0, 0}, {100, 0, 0}}), planner(CornerRule::junction_deviation)), 0.2 + 0.9,
              1e-5);
  // With a jerk of 10 mm/s: ramps of 0.09 s and 4.95 mm.
  EXPECT_NEAR(time(travel({{0, 0, 0}, {100, 0, 0}}), planner(CornerRule::jerk)), 0.18 + 0.901, 1e-5);
  // Too short for the speed: 4 mm in two ramps of 2 mm.
  EXPECT_NEAR(time(travel({{0, 0, 0}, {4, 0, 0}}), planner(CornerRule::junction_deviation)),
              2 * std::sqrt(2 * 2.0 / 1000), 1e-5);
}

TEST(PrintTime, straight_on_is_one_motion) {
  for (const CornerRule rule : {CornerRule::jerk, CornerRule::junction_deviation, CornerRule::square_corner})
    EXPECT_NEAR(time(travel({{0, 0, 0}, {30, 0, 0}, {100, 0, 0}}), planner(rule)),
                time(travel({{0, 0, 0}, {100, 0, 0}}), planner(rule)), 1e-5);
}

/// From rest over 50 mm to `v` at the corner, and over 50 mm to rest.
double with_corner(double v) {
  const double ramp = (100 - v) / 1000, way = (100 * 100 - v * v) / 2000;
  return 2 * (0.1 + ramp + (50 - 5 - way) / 100);
}

TEST(PrintTime, corners_follow_the_rule_of_the_firmware) {
  const Toolpath right = travel({{0, 0, 0}, {50, 0, 0}, {50, 50, 0}});
  // Klipper: 5 mm/s at a right angle, by definition.
  EXPECT_NEAR(time(right, planner(CornerRule::square_corner)), with_corner(5), 1e-5);
  // Junction deviation: v^2 = 1000 * 0.01 * s / (1 - s), s = sqrt(1/2).
  const double s = std::sqrt(0.5);
  EXPECT_NEAR(time(right, planner(CornerRule::junction_deviation)), with_corner(std::sqrt(10 * s / (1 - s))),
              1e-5);
  // Jerk: each axis changes by the whole speed, so 10 mm/s; rest to 10 mm/s needs no time.
  const double ramp = 0.09, way = 4.95;
  EXPECT_NEAR(time(right, planner(CornerRule::jerk)), 2 * (2 * ramp + (50 - 2 * way) / 100), 1e-5);
}

TEST(PrintTime, turning_round_counts_once) {
  const Toolpath back = travel({{0, 0, 0}, {50, 0, 0}, {0, 0, 0}});
  EXPECT_NEAR(time(back, planner(CornerRule::jerk)), 2 * (2 * 0.09 + (50 - 9.9) / 100), 1e-5);
  EXPECT_NEAR(time(back, planner(CornerRule::square_corner)), with_corner(0), 1e-5);
}

TEST(PrintTime, axes_have_their_own_limits) {
  // Z: 10 mm/s at 100 mm/s2: 0.1 s and 0.5 mm for each ramp.
  EXPECT_NEAR(time(travel({{0, 0, 0}, {0, 0, 20}}), planner(CornerRule::junction_deviation)), 0.2 + 1.9,
              1e-5);
}

TEST(PrintTime, limits_of_the_program_hold_from_there_on) {
  Toolpath path = travel({{0, 0, 0}, {100, 0, 0}});
  path.add(step::MotionLimits{LimitKind::acceleration, {0, 0, 500, 0}, 4}, OriginId::none);
  path.add(step::Dwell{seconds(2)}, OriginId::none);
  path.add(step::Cut{{0, 0, 0}, kFast}, OriginId::none);
  // 500 mm/s2: ramps of 0.2 s and 10 mm.
  EXPECT_NEAR(time(path, planner(CornerRule::square_corner)), 1.1 + 2 + 0.4 + 0.8, 1e-5);
  const PrintTime parts = estimate_print_time(path, planner(CornerRule::square_corner));
  EXPECT_NEAR(parts.dwell.seconds(), 2, 1e-9);
  EXPECT_NEAR(parts.travel.seconds(), 1.1 + 1.2, 1e-5);
}

TEST(PrintTime, filament_alone_moves_at_its_own_limits) {
  Toolpath path = travel({{0, 0, 0}, {0.001, 0, 0}});
  const double area = std::numbers::pi * 0.875 * 0.875;
  path.add(step::Extrude{{0.001, 0, 0}, mm3(-10 * area), {}, {}, kFast}, OriginId::none);
  const PrintTime parts = estimate_print_time(path, planner(CornerRule::junction_deviation));
  // 50 mm/s at 1000 mm/s2: 0.05 s and 1.25 mm for each ramp, 7.5 mm at speed.
  EXPECT_NEAR(parts.retraction.seconds(), 0.1 + 0.15, 1e-4);
}

TEST(PrintTime, beads_are_counted_by_kind) {
  Toolpath path = travel({{0, 0, 0}});
  path.add(step::Extrude{{100, 0, 0}, mm3(8), {}, {}, kFast, BeadKind::outer_wall}, OriginId::none);
  path.add(step::Extrude{{200, 0, 0}, mm3(8), {}, {}, kFast, BeadKind::wall}, OriginId::none);
  const PrintTime parts = estimate_print_time(path, planner(CornerRule::junction_deviation));
  EXPECT_NEAR(parts.beads[static_cast<std::size_t>(BeadKind::outer_wall)].seconds(), 0.1 + 0.95, 1e-5);
  EXPECT_NEAR(parts.beads[static_cast<std::size_t>(BeadKind::wall)].seconds(), 0.1 + 0.95, 1e-5);
  EXPECT_EQ(parts.travel.seconds(), 0);
}

/// Klipper's "minimum cruise ratio" r: with the whole acceleration a for rises and falls, the highest speed
/// is that of a plan with (1 - r) a.
TEST(PrintTime, klipper_slows_short_motions) {
  PrintPlanner p = planner(CornerRule::square_corner);
  // 4 mm from rest to rest: v^2 = 0.5 * 1000 * 4; ramps of 1 mm each, 2 mm at this speed.
  const double v = std::sqrt(0.5 * 1000 * 4);
  const Toolpath path = travel({{0, 0, 0}, {4, 0, 0}});
  EXPECT_NEAR(time(path, p), 2 * v / 1000 + 2 / v, 1e-5);
  // The same as two motions: one rises and one falls.
  EXPECT_NEAR(time(travel({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}}), p), 2 * v / 1000 + 2 / v, 1e-5);
  p.cruise_ratio = 0;
  EXPECT_NEAR(time(path, p), 2 * std::sqrt(2 * 2.0 / 1000), 1e-5);
  for (const char* line :
       {"SET_VELOCITY_LIMIT ACCEL_TO_DECEL=500", "SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0.5"}) {
    Toolpath own;
    own.add(step::Verbatim{line}, OriginId::none);
    for (std::size_t i = 0; i < path.size(); ++i) own.add_copy(path, i);
    EXPECT_NEAR(time(own, p), 2 * v / 1000 + 2 / v, 1e-5) << line;
  }
}

/// The filament jumps by 1 mm/s: from 0 to 0.05 mm per mm at 20 mm/s.
TEST(PrintTime, klipper_slows_where_the_flow_changes) {
  const double area = std::numbers::pi * 0.875 * 0.875;
  Toolpath path = travel({{0, 0, 0}, {50, 0, 0}});
  path.add(step::Extrude{{100, 0, 0}, mm3(50 * 0.05 * area), {}, {}, kFast}, OriginId::none);
  EXPECT_NEAR(time(path, planner(CornerRule::square_corner)), with_corner(20), 1e-5);
}

TEST(PrintTime, limits_of_a_slicer_are_those_of_the_time) {
  Toolpath path;
  for (const char* note :
       {"machine_max_acceleration_x = 500,100", "machine_max_feedrate_x = 50", "machine_max_jerk_x = 5",
        "machine_max_acceleration_travel = 0", "machine_max_jerk_y = abc"})
    path.add(step::Note{note}, OriginId::none);
  path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  path.add(step::Cut{{100, 0, 0}, kFast}, OriginId::none);
  // From 5 to 50 mm/s at 500 mm/s2: 0.09 s and 2.475 mm.
  EXPECT_NEAR(time(path, default_planner(path)), 0.18 + (100 - 4.95) / 50, 1e-5);
  path.add(step::MotionLimits{LimitKind::corner_speed, {5, 0, 0, 0}, 1}, OriginId::none);
  EXPECT_EQ(default_planner(path).corners, CornerRule::jerk);
  Toolpath klipper;
  klipper.add(step::Note{"gcode_flavor = klipper"}, OriginId::none);
  EXPECT_EQ(default_planner(klipper).corners, CornerRule::square_corner);
}

TEST(PrintTime, the_planner_is_that_of_the_program) {
  Toolpath path;
  EXPECT_EQ(default_planner(path).corners, CornerRule::jerk);
  path.add(step::MotionLimits{LimitKind::corner_speed, {8, 0, 0, 0}, 1}, OriginId::none);
  EXPECT_EQ(default_planner(path).corners, CornerRule::square_corner);
}

TEST(PrintTime, limits_of_zero_and_motions_without_a_feed_end) {
  Toolpath path = travel({{0, 0, 0}, {10, 0, 0}});
  path.add(step::MotionLimits{LimitKind::acceleration, {0, 0, 0, 0}, 7}, OriginId::none);
  path.add(step::MotionLimits{LimitKind::jerk, {0, 0, 0, 0}, 15}, OriginId::none);
  path.add(step::Cut{{20, 0, 0}, kFast}, OriginId::none);
  path.add(step::Cut{{30, 0, 0}, Feed{}}, OriginId::none);
  const PrintTime t = estimate_print_time(path, planner(CornerRule::jerk));
  EXPECT_TRUE(std::isfinite(t.total().seconds()));
  EXPECT_EQ(t.not_timed, 1u);
}

}  // namespace
}  // namespace kerf
