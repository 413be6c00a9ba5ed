// Planned times: against hand-computed values, and the rules of corners, look-ahead and stops.
#include "kerf/path/estimate.h"

#include <chrono>
#include <cmath>
#include <gtest/gtest.h>

namespace kerf {
namespace {

constexpr double kExact = 1e-4;  // s; times are kept in single precision

struct Job {
  Toolpath path;
  OriginId here = path.origins().text(path.origins().file("job.nc"), 1, 1);
  template <class S>
  Job& add(const S& s) {
    path.add(s, here);
    return *this;
  }
  Job& cut(Point3 to, double feed) { return add(step::Cut{to, mm_per_min(feed)}); }
  double motion(const Machine& machine = {}) const {
    return estimate_time(path, machine).all.motion.seconds();
  }
};

/// Ramps up and down at `a` with `v` in between.
double trapezoid(double length, double v, double a) { return length / v + v / a; }

TEST(EstimateTime, LinesAreTrapezoidsAlongTheirDirection) {
  EXPECT_NEAR(Job().add(step::Rapid{{100, 0, 0}}).motion(), 2.25, kExact);
  EXPECT_NEAR(Job().add(step::Rapid{{100, 100, 0}}).motion(), 2.25, kExact);  // each axis at its limit
  EXPECT_NEAR(Job().add(step::Rapid{{0, 0, 10}}).motion(), trapezoid(10, 1000 / 60.0, 50), kExact);
  EXPECT_NEAR(Job().cut({100, 0, 0}, 1000).motion(), trapezoid(100, 1000 / 60.0, 200), kExact);
  EXPECT_NEAR(Job().cut({100, 0, 0}, 9000).motion(), 2.25, kExact);  // no faster than the axis
  EXPECT_NEAR(Job().cut({0.5, 0, 0}, 3000).motion(), 2 * std::sqrt(0.5 / 200), kExact);  // never at speed
  EXPECT_NEAR(Job().cut({1, 0, 0}, 0.1).motion(), 60, 0.1);  // the slowest feed is 1 mm/min
}

TEST(EstimateTime, ACornersSpeedComesFromTheJunctionDeviation) {
  const Job corner = Job().cut({50, 0, 0}, 1000).cut({50, 50, 0}, 1000);
  const double s = std::sqrt(0.5), a = 200 * std::sqrt(2.0), v = 1000 / 60.0;
  const double u = std::sqrt(a * 0.01 * s / (1 - s));
  const double one_leg = 50 / v + v / 400 + (v - u) * (v - u) / (2 * v * 200);
  EXPECT_NEAR(corner.motion(), 2 * one_leg, kExact);
  Machine stiff;
  stiff.junction_deviation = mm(0);
  EXPECT_NEAR(corner.motion(stiff), 2 * trapezoid(50, v, 200), kExact);
}

TEST(EstimateTime, ReversalsStopAndStraightJointsDoNot) {
  EXPECT_NEAR(Job().cut({20, 0, 0}, 1500).cut({0, 0, 0}, 1500).motion(), 2 * trapezoid(20, 25, 200), kExact);
  EXPECT_NEAR(Job().cut({20, 0, 0}, 1500).cut({40, 0, 0}, 1500).motion(), trapezoid(40, 25, 200), kExact);
}

TEST(EstimateTime, ShortMovesAreSlowWhereTheLookAheadIsShort) {
  Job job;
  for (int i = 1; i <= 1000; ++i) job.cut({0.1 * i, 0, 0}, 3000);
  Machine machine;
  EXPECT_NEAR(job.motion(machine), 4.3, 0.05);  // near sqrt(2 a 14 moves), not 50 mm/s
  machine.look_ahead = 1000;
  EXPECT_NEAR(job.motion(machine), 2.25, 1e-3);
  machine.look_ahead = 1;  // every move from rest to rest
  EXPECT_NEAR(job.motion(machine), 1000 * 2 * std::sqrt(0.1 / 200), 1e-2);
}

TEST(EstimateTime, ChangesOfStateStop) {
  const double whole = trapezoid(20, 1000 / 60.0, 200);
  const double stopped = 2 * trapezoid(10, 1000 / 60.0, 200);
  auto with = [](auto step) { return Job().cut({10, 0, 0}, 1000).add(step).cut({20, 0, 0}, 1000); };
  EXPECT_NEAR(with(step::Coolant{false, true}).motion(), stopped, kExact);
  EXPECT_NEAR(with(step::Coolant{}).motion(), whole, kExact);
  EXPECT_NEAR(with(step::Spindle{rpm(500), SpindleTurn::cw}).motion(), stopped, kExact);
  EXPECT_NEAR(with(step::Spindle{}).motion(), whole, kExact);
  EXPECT_NEAR(with(step::ToolChange{2}).motion(), stopped, kExact);
  EXPECT_NEAR(with(step::Pause{}).motion(), stopped, kExact);
  EXPECT_NEAR(with(step::Pause{PauseKind::pallet_change}).motion(), stopped, kExact);
  EXPECT_NEAR(with(step::Pause{PauseKind::optional}).motion(), whole, kExact);
  EXPECT_NEAR(with(step::End{}).motion(), stopped, kExact);
  EXPECT_NEAR(with(step::Verbatim{"M0"}).motion(), whole, kExact);  // text has no meaning
  EXPECT_NEAR(with(step::Note{"M0"}).motion(), whole, kExact);
  EXPECT_NEAR(with(step::PathMode{PathModeKind::exact_stop, {}}).motion(), whole, kExact);  // only after it
  Job shifted = Job().cut({10, 0, 0}, 1000).cut({20, 0, 0}, 1000);
  shifted.path.set_rests_before(1);
  EXPECT_NEAR(shifted.motion(), stopped, kExact);
}

TEST(EstimateTime, ALasersPowerFollowsOnlyInLaserMode) {
  Job job;
  job.add(step::Spindle{rpm(500), SpindleTurn::cw}).cut({10, 0, 0}, 1000);
  job.add(step::Spindle{rpm(600), SpindleTurn::cw}).cut({20, 0, 0}, 1000);
  Machine machine;
  EXPECT_NEAR(job.motion(machine), 2 * trapezoid(10, 1000 / 60.0, 200), kExact);
  machine.laser = LaserDrive::follows;
  EXPECT_NEAR(job.motion(machine), trapezoid(20, 1000 / 60.0, 200), kExact);
}

TEST(EstimateTime, DwellsAndHaltsAreSeparateFromMotion) {
  Machine machine;
  machine.stop_time = seconds(0.025);
  const Job job = Job().cut({10, 0, 0}, 1000).add(step::Dwell{seconds(1.5)}).cut({20, 0, 0}, 1000);
  const TimeFigures all = estimate_time(job.path, machine).all;
  EXPECT_NEAR(all.dwell.seconds(), 1.5, 1e-6);
  EXPECT_EQ(all.stops, 1u);
  EXPECT_NEAR(all.halts.seconds(), 0.025, 1e-9);
  EXPECT_NEAR(all.total().seconds(), all.motion.seconds() + 1.525, 1e-6);
}

TEST(EstimateTime, ArcsAreChords) {
  Job job;
  job.add(step::Arc{.to = {0, 0, 0}, .centre = {10, 0}, .turn = Turn::cw, .feed = mm_per_min(600)});
  const double length = 20 * std::acos(-1.0);
  EXPECT_NEAR(job.motion(), trapezoid(length, 10, 200), 0.004 * length / 10);
  const TimeEstimate time = estimate_time(job.path, {});
  const double chords = std::floor(0.5 * 2 * std::acos(-1.0) * 10 / std::sqrt(0.002 * (20 - 0.002)));
  EXPECT_EQ(time.moves, static_cast<std::size_t>(chords));
  Machine coarse;
  coarse.arc_tolerance = mm(50);  // more than the arc is wide: one chord, here of no length
  EXPECT_EQ(estimate_time(job.path, coarse).moves, 0u);
}

TEST(EstimateTime, ToolsAndOperationsAddUpToAll) {
  Job job;
  job.add(step::Rapid{{0, 0, 5}}).add(step::ToolChange{1}).cut({10, 0, 0}, 500).add(step::Note{"pocket"});
  job.cut({20, 0, 0}, 500).add(step::ToolChange{2}).cut({30, 0, 0}, 500).add(step::ToolChange{1});
  job.cut({40, 0, 0}, 500).add(step::Dwell{seconds(2)});
  const TimeEstimate time = estimate_time(job.path, {});
  ASSERT_EQ(time.tools.size(), 3u);
  EXPECT_EQ(time.tools[0].tool, std::nullopt);
  EXPECT_EQ(time.tools[1].tool, 1);
  double tools = 0, operations = 0;
  for (const ToolTime& t : time.tools) tools += t.time.total().seconds();
  for (const OperationTime& o : time.operations) operations += o.time.total().seconds();
  EXPECT_NEAR(tools, time.all.total().seconds(), 1e-9);
  EXPECT_NEAR(operations, time.all.total().seconds(), 1e-9);
  ASSERT_EQ(time.operations.size(), 5u);
  EXPECT_EQ(time.operations[2].name, "pocket");
  EXPECT_EQ(time.operations[3].tool, 2);
}

TEST(EstimateTime, StepSecondsAreThoseOfTheWhole) {
  const Job job = Job().cut({10, 0, 0}, 1000).add(step::Dwell{seconds(1)}).cut({20, 5, 0}, 1000);
  const std::vector<float> each = step_seconds(job.path, {});
  ASSERT_EQ(each.size(), 3u);
  EXPECT_FLOAT_EQ(each[1], 1.0f);
  EXPECT_NEAR(static_cast<double>(each[0] + each[2]), job.motion(), kExact);
}

TEST(EstimateTime, MovesWithoutAFeedAreNotTimed) {
  const Job job = Job().cut({10, 0, 0}, 0).cut({20, 0, 0}, 1000);
  const TimeEstimate time = estimate_time(job.path, {});
  EXPECT_EQ(time.not_timed, 1u);
  EXPECT_NEAR(time.all.motion.seconds(), trapezoid(10, 1000 / 60.0, 200), kExact);
}

TEST(EstimateTime, RotaryAxesAloneTakeDegreesPerMinuteFromRestToRest) {
  Job job = Job().cut({10, 0, 0}, 1000);
  for (const double a : {0.0, 360.0, 400.0}) {
    job.cut({10, 0, 0}, 100);
    job.path.set_extra(job.path.size() - 1, {.abc = std::array<double, 3>{a, 0, 0}});
  }
  job.cut({20, 0, 0}, 1000);
  const TimeEstimate time = estimate_time(job.path, {});
  const double line = trapezoid(10, 1000 / 60.0, 200);
  EXPECT_NEAR(time.all.motion.seconds(), 2 * line + 4.0 * 60.0, kExact);  // 400 degrees
  EXPECT_EQ(time.not_timed, 1u) << "the first angle is unknown before";
}

TEST(EstimateTime, AMillionMovesTakeLessThanFiveSeconds) {
  Job job;
  for (int i = 1; i <= 1'000'000; ++i) job.cut({0.1 * i, 0.01 * (i % 7), -0.01 * (i % 3)}, 2000);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GT(job.motion(), 1000.0);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(took.count()));
  EXPECT_LT(took.count(), 5.0);  // 1 s on an idle machine; tests run in parallel
}

TEST(EstimateTime, ExactStopsHoldUntilThePathModeChanges) {
  const double leg = trapezoid(10, 1000 / 60.0, 200);
  Job job;
  job.add(step::PathMode{PathModeKind::exact_stop, {}}).cut({10, 0, 0}, 1000).cut({20, 0, 0}, 1000);
  EXPECT_NEAR(job.motion(), 2 * leg, kExact);
  job.add(step::PathMode{PathModeKind::exact_path, {}}).cut({30, 0, 0}, 1000).cut({40, 0, 0}, 1000);
  EXPECT_NEAR(job.motion(), 2 * leg + trapezoid(20, 1000 / 60.0, 200), kExact);
}

TEST(EstimateTime, WhatPrecedesTheFirstMotionOfAnOperationBelongsToItAlone) {
  Job job;
  for (const int tool : {1, 2, 3})
    job.add(step::ToolChange{tool})
        .add(step::Dwell{seconds(tool)})
        .cut({10.0 * tool, 0, 0}, 1000)
        .add(step::Dwell{seconds(10)});
  const TimeEstimate time = estimate_time(job.path, {});
  ASSERT_EQ(time.operations.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(time.operations[i].time.dwell.seconds(), static_cast<double>(i + 1) + 10, 1e-9) << i;
    EXPECT_NEAR(time.operations[i].time.motion.seconds(), trapezoid(10, 1000 / 60.0, 200), kExact) << i;
  }
}

TEST(EstimateTime, AJointIsPassedAtTheSlowerFeed) {
  const double fast = 25, slow = 10, a = 200;  // mm/s and mm/s2
  // 20 mm up to the fast feed and down to the slow one, and 20 mm at the slow one down to a stop.
  const double ramps = fast * fast / (2 * a) + (fast * fast - slow * slow) / (2 * a);
  const double first = fast / a + (fast - slow) / a + (20 - ramps) / fast;
  const double second = slow / a + (20 - slow * slow / (2 * a)) / slow;
  EXPECT_NEAR(Job().cut({20, 0, 0}, 60 * fast).cut({40, 0, 0}, 60 * slow).motion(), first + second, kExact);
  EXPECT_NEAR(Job().cut({20, 0, 0}, 60 * slow).cut({40, 0, 0}, 60 * fast).motion(), first + second, kExact);
}

}  // namespace
}  // namespace kerf
