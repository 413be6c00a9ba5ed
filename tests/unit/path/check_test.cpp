// The checks of a toolpath by itself: every code provoked, and none for valid paths.
#include "kerf/path/check.h"

#include <gtest/gtest.h>

#include "base/codes/path.h"

namespace kerf {
namespace {

/// A valid small job: tool, spindle, plunge, line, half circle.
struct Job {
  Toolpath path;
  std::uint32_t file = path.origins().file("job.nc");
  std::uint32_t line = 0;
  OriginId next() { return path.origins().text(file, ++line, 1); }
  template <class S>
  Job& add(const S& s) {
    path.add(s, next());
    return *this;
  }
};

Job started() {
  Job job;
  job.add(step::ToolChange{1}).add(step::Spindle{rpm(10000), SpindleTurn::cw}).add(step::Rapid{{0, 0, 5}});
  return job;
}

std::vector<std::string> kinds(const Job& job, const CheckOptions& options = {}) {
  std::vector<std::string> names;
  for (const PathHazard& h : check_path(job.path, options)) names.emplace_back(kind_of(h));
  return names;
}

using Kinds = std::vector<std::string>;

TEST(CheckPath, AValidJobHasNoHazards) {
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, mm_per_min(100)});
  job.add(step::Arc{.to = {10, 0, -1}, .centre = {5, 0}, .turn = Turn::cw, .feed = mm_per_min(400)});
  EXPECT_EQ(kinds(job, {.end = ProgramEnd::seen}), Kinds{});
}

TEST(CheckPath, EmptyPathHasNoHazards) { EXPECT_EQ(kinds(Job{}, {.end = ProgramEnd::missing}), Kinds{}); }

TEST(CheckPath, CutsWithoutFeedAreOneRunWithTheFirstStep) {
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, Feed{}}).add(step::Rapid{{0, 0, 5}}).add(step::Cut{{1, 0, -1}, Feed{}});
  const auto found = check_path(job.path, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_no_feed);
  EXPECT_EQ(found[0].step, 3u);
  EXPECT_EQ(found[0].steps, 2u);
  EXPECT_EQ(found[0].at, (Point3{0, 0, -1}));
}

TEST(CheckPath, AValidCutEndsARun) {
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, Feed{}})
      .add(step::Cut{{1, 0, -1}, mm_per_min(5)})
      .add(step::Cut{{2, 0, -1}, Feed{}});
  EXPECT_EQ(kinds(job), (Kinds{"no_feed", "no_feed"}));
}

TEST(CheckPath, ProbesNeedAFeedButNeitherToolNorSpindle) {
  Job job;
  job.add(step::Probe{{0, 0, -1}, Feed{}});
  EXPECT_EQ(kinds(job), Kinds{"no_feed"});
}

TEST(CheckPath, ANegativeFeedIsReportedWithItsValue) {
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, mm_per_min(-12.5)});
  const auto found = check_path(job.path, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_negative_feed);
  EXPECT_NE(found[0].message.find("-12.5"), std::string::npos);
}

TEST(CheckPath, CutBeforeAToolChange) {
  Job job;
  job.add(step::Spindle{rpm(1000), SpindleTurn::cw}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(job), Kinds{"no_tool"});
}

TEST(CheckPath, KindsAreTheCodesNamesWithoutTheirArea) {
  EXPECT_EQ(kind_of(PathHazard{codes::path_no_tool, 0, 1, {}, {}}), "no_tool");
  EXPECT_EQ(kind_of(PathHazard{codes::path_arc_radii, 0, 1, {}, {}}), "arc_radii");
  EXPECT_EQ(kind_of(PathHazard{codes::path_spindle_off, 0, 1, {}, {}}), "spindle_off");
}

TEST(CheckPath, SpindleNeverStartedOrStopped) {
  Job never;
  never.add(step::ToolChange{1}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(never), Kinds{"spindle_off"});
  Job stopped = started();
  stopped.add(step::Spindle{}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(stopped), Kinds{"spindle_off"});
  Job by_hand = started();  // it turns at an unknown speed
  by_hand.add(step::Spindle{rpm(0), SpindleTurn::cw}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(by_hand), Kinds{});
}

TEST(CheckPath, ALaserNeedsNoSpindle) {
  Job job;
  job.add(step::ToolChange{1}).add(step::LaserPower{LaserMode::dynamic, 255.0});
  job.add(step::Cut{{1, 0, 0}, mm_per_min(10)}).add(step::LaserPower{});
  EXPECT_EQ(kinds(job), Kinds{});
}

/// A rotary axis moves the work under the beam while the tool moves in Z alone.
TEST(CheckPath, TheBeamIsOnWhereARotaryAxisTurnsTheWork) {
  const auto found = [](std::optional<double> angle, unsigned unknown) {
    Toolpath path;
    path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
    path.add(step::LaserPower{LaserMode::dynamic, 300}, OriginId::none);
    const std::size_t cut = path.add(step::Cut{{0, 0, 4}, mm_per_min(100)}, OriginId::none);
    MotionExtra extra;
    if (angle) extra.abc = {*angle, 0, 0};
    extra.unknown_abc = unknown;
    if (angle || unknown != 0) path.set_extra(cut, extra);
    path.add(step::LaserPower{}, OriginId::none);
    path.add(step::End{}, OriginId::none);
    std::vector<Code> codes;
    for (const PathHazard& hazard : check_path(path, {})) codes.push_back(hazard.code);
    return codes;
  };
  EXPECT_EQ(found(std::nullopt, 0), std::vector<Code>{codes::path_beam_standing});
  EXPECT_EQ(found(90.0, 0), std::vector<Code>{});
  EXPECT_EQ(found(std::nullopt, 1), std::vector<Code>{});
}

/// Codes of a cut of 10 mm with a tool of 6 mm, after these steps.
std::vector<Code> codes_of_cut(step::Spindle spindle, double feed, SpindleLock lock = SpindleLock::none) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(spindle, OriginId::none);
  path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  path.add(step::Cut{{10, 0, 0}, mm_per_min(feed)}, OriginId::none);
  if (lock != SpindleLock::none) {
    MotionExtra extra;
    extra.lock = lock;
    path.set_extra(3, extra);
  }
  path.add(step::End{}, OriginId::none);
  Tool tool;
  tool.diameter = mm(6);
  ToolTable tools;
  tools.set(1, tool);
  std::vector<Code> found;
  for (const PathHazard& hazard : check_path(path, {.tools = &tools})) found.push_back(hazard.code);
  return found;
}

TEST(CheckPath, MillsTurnClockwise) {
  const step::Spindle back{rpm(1000), SpindleTurn::ccw};
  EXPECT_EQ(codes_of_cut({rpm(1000), SpindleTurn::cw}, 600), std::vector<Code>{});
  EXPECT_EQ(codes_of_cut(back, 600), std::vector<Code>{codes::path_wrong_turn});
  EXPECT_EQ(codes_of_cut(back, 600, SpindleLock::tap), std::vector<Code>{});
}

TEST(CheckPath, NoToolAdvancesByItsDiameterInATurn) {
  const step::Spindle spindle{rpm(100), SpindleTurn::cw};
  EXPECT_EQ(codes_of_cut(spindle, 600), std::vector<Code>{});  // 6 mm in a turn
  EXPECT_EQ(codes_of_cut(spindle, 601), std::vector<Code>{codes::path_feed_per_turn});
  EXPECT_EQ(codes_of_cut(spindle, 601, SpindleLock::thread), std::vector<Code>{});
  EXPECT_EQ(codes_of_cut({rpm(0), SpindleTurn::cw}, 601), std::vector<Code>{});  // set by hand
}

TEST(CheckPath, AProbeIsRaisedBeforeItMovesOn) {
  const auto found = [](double rise, Point3 to) {
    Toolpath path;
    path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
    path.add(step::Probe{{0, 0, -5}, mm_per_min(50), ProbeKind::contact}, OriginId::none);
    if (rise > 0.0) path.add(step::Rapid{{0, 0, -5 + rise}}, OriginId::none);
    path.add(step::Rapid{to}, OriginId::none);
    path.add(step::End{}, OriginId::none);
    std::vector<Code> codes;
    for (const PathHazard& hazard : check_path(path, {})) codes.push_back(hazard.code);
    return codes;
  };
  const std::vector<Code> wanted{codes::path_sideways_in_contact};
  EXPECT_EQ(found(0.0, {9, 0, -5}), wanted);
  EXPECT_EQ(found(0.0, {9, 0, -6}), wanted);
  EXPECT_EQ(found(2.0, {9, 0, -3}), std::vector<Code>{});
  EXPECT_EQ(found(0.0, {0, 0, 5}), std::vector<Code>{});
}

TEST(CheckPath, TheBeamOfALaser) {
  const auto found = [](LaserMode mode, std::optional<LaserDrive> drive) {
    Job job;
    job.add(step::Rapid{{0, 0, 0}})
        .add(step::LaserPower{mode, 300})
        .add(step::Cut{{9, 0, 0}, mm_per_min(600)});
    job.add(step::Dwell{seconds(1)}).add(step::Rapid{{0, 5, 0}}).add(step::Rapid{{5, 5, 0}});
    job.add(step::Dwell{seconds(1)}).add(step::Cut{{9, 5, 0}, mm_per_min(600)});
    Machine machine;
    if (drive) machine.laser = *drive;
    return kinds(job, {.machine = drive ? &machine : nullptr});
  };
  const Kinds all{"beam_standing", "beam_in_rapid", "beam_standing", "beam_left_on"};
  EXPECT_EQ(found(LaserMode::constant, std::nullopt), all);
  EXPECT_EQ(found(LaserMode::dynamic, std::nullopt), Kinds{"beam_left_on"});
  EXPECT_EQ(found(LaserMode::constant, LaserDrive::follows), (Kinds{"beam_standing", "beam_left_on"}));
  EXPECT_EQ(found(LaserMode::dynamic, LaserDrive::follows), Kinds{"beam_left_on"});
  EXPECT_EQ(found(LaserMode::constant, LaserDrive::stops), all);
  EXPECT_EQ(found(LaserMode::dynamic, LaserDrive::stops), all);
}

TEST(CheckPath, ABeamInRapidsIsOneEntryAndARestAnother) {
  Job job;
  job.add(step::LaserPower{LaserMode::constant, 300}).add(step::Cut{{9, 0, 0}, mm_per_min(600)});
  job.add(step::Rapid{{0, 5, 0}}).add(step::Rapid{{5, 5, 0}}).add(step::Pause{}).add(step::LaserPower{});
  const auto found = check_path(job.path, {});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].code, codes::path_beam_in_rapid);
  EXPECT_EQ(found[0].step, 2u);
  EXPECT_EQ(found[0].steps, 2u);
  EXPECT_EQ(found[0].at, (Point3{0, 5, 0}));
  EXPECT_EQ(found[1].code, codes::path_beam_standing);
  EXPECT_EQ(found[1].step, 4u);
  EXPECT_EQ(found[1].at, (Point3{5, 5, 0}));
}

TEST(CheckPath, APrinterNeedsNeitherToolNorSpindle) {
  Job job;
  job.add(step::Extrude{{1, 0, 0}, mm3(1), mm(0.4), mm(0.2), mm_per_min(10)});
  job.add(step::Cut{{2, 0, 0}, mm_per_min(10)});
  EXPECT_EQ(kinds(job), Kinds{});
}

TEST(CheckPath, ArcRadiiFollowGrblsRule) {
  auto with_end = [](double x) {
    Job job = started();
    job.add(step::Cut{{0, 0, -1}, mm_per_min(100)});
    job.add(step::Arc{.to = {x, 0, -1}, .centre = {5, 0}, .feed = mm_per_min(400)});
    return kinds(job);
  };
  EXPECT_EQ(with_end(10.004), Kinds{});             // within 5 micrometres
  EXPECT_EQ(with_end(10.006), Kinds{"arc_radii"});  // beyond them and beyond a thousandth of the radius
  Job large = started();
  large.add(step::Cut{{0, 0, -1}, mm_per_min(100)});
  large.add(step::Arc{.to = {200.09, 0, -1}, .centre = {100, 0}, .feed = mm_per_min(400)});
  EXPECT_EQ(kinds(large), Kinds{});  // within a thousandth of 100 mm
  Job huge = started();
  huge.add(step::Cut{{0, 0, -1}, mm_per_min(100)});
  huge.add(step::Arc{.to = {20000.6, 0, -1}, .centre = {10000, 0}, .feed = mm_per_min(400)});
  EXPECT_EQ(kinds(huge), Kinds{"arc_radii"});  // beyond half a millimetre
}

TEST(CheckPath, AMissingEndIsReportedAtTheLastStep) {
  Job job = started();
  job.add(step::Cut{{3, 0, -1}, mm_per_min(100)}).add(step::Dwell{seconds(1)});
  const auto found = check_path(job.path, {.end = ProgramEnd::missing});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_no_program_end);
  EXPECT_EQ(found[0].step, 4u);
  EXPECT_EQ(found[0].at, (Point3{3, 0, -1}));
}

Machine table_of(double x, double y, double z) {
  Machine machine;
  machine.travel = {AxisTravel{0, x}, AxisTravel{0, y}, AxisTravel{-z, 0}};
  return machine;
}

TEST(CheckPath, AMotionBeyondTheTravelOfAKnownWorkZero) {
  Machine machine = table_of(100, 100, 50);
  machine.work_zero = Point3{10, 10, -40};
  Job job = started();
  job.add(step::Cut{{90, 0, -1}, mm_per_min(100)}).add(step::Cut{{90.5, 0, -1}, mm_per_min(100)});
  const auto found = check_path(job.path, {.machine = &machine});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_outside_machine);
  EXPECT_EQ(found[0].step, 4u);
  EXPECT_NE(found[0].message.find("X100.5 in machine coordinates, above the end of the axis at 100"),
            std::string::npos)
      << found[0].message;
  EXPECT_FALSE(found[0].hint.empty());
}

TEST(CheckPath, AMotionBelowTheTravelNamesThatEnd) {
  Machine machine = table_of(100, 100, 50);
  machine.work_zero = Point3{10, 10, -40};
  Job job = started();
  job.add(step::Cut{{0, 0, -11}, mm_per_min(100)});
  const auto found = check_path(job.path, {.machine = &machine});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("Z-51 in machine coordinates, below the end of the axis at -50"),
            std::string::npos)
      << found[0].message;
}

TEST(CheckPath, OnlyTheLengthOfTheTravelCountsWithoutAWorkZero) {
  const Machine machine = table_of(100, 100, 50);
  Job far = started();
  far.add(step::Cut{{1000, 0, -1}, mm_per_min(100)});
  EXPECT_EQ(kinds(far, {.machine = &machine}), Kinds{"outside_machine"});
  Job elsewhere;
  elsewhere.add(step::ToolChange{1}).add(step::Spindle{rpm(1), SpindleTurn::cw});
  elsewhere.add(step::Cut{{1000, 0, -1}, mm_per_min(100)}).add(step::Cut{{1100, 0, -1}, mm_per_min(100)});
  EXPECT_EQ(kinds(elsewhere, {.machine = &machine}), Kinds{});
}

TEST(CheckPath, TheBulgeOfAnArcExceedsTheTravel) {
  const Machine machine = table_of(100, 8, 50);
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, mm_per_min(100)});
  job.add(step::Arc{.to = {20, 0, -1}, .centre = {10, 0}, .turn = Turn::cw, .feed = mm_per_min(400)});
  EXPECT_EQ(kinds(job, {.machine = &machine}), Kinds{"outside_machine"});
}

TEST(CheckPath, SpeedsThatTheSpindleDoesNotHave) {
  Machine machine;
  machine.slowest_spindle = rpm(8000);
  machine.fastest_spindle = rpm(9000);
  const auto found = check_path(started().path, {.machine = &machine});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_spindle_range);
  machine.fastest_spindle = rpm(24000);
  EXPECT_EQ(kinds(started(), {.machine = &machine}), Kinds{});
}

ToolTable table_with(int teeth, bool plunges) {
  Tool tool;
  tool.number = 1;
  tool.diameter = mm(3);
  tool.teeth = teeth;
  tool.teeth_assumed = false;
  tool.plunges = plunges;
  ToolTable table;
  table.set(1, tool);
  return table;
}

TEST(CheckPath, APlungeWithAToolThatCannot) {
  const ToolTable cannot = table_with(2, false), can = table_with(2, true);
  Box3 stock;
  stock.add(Point3{0, 0, -10});
  stock.add(Point3{100, 100, 0});
  Job job = started();
  job.add(step::Cut{{0, 0, 1}, mm_per_min(100)}).add(step::Cut{{0, 0, -1}, mm_per_min(100)});
  job.add(step::Rapid{{0, 0, 5}});
  const auto found = check_path(job.path, {.tools = &cannot, .stock = stock});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_plunge);
  EXPECT_EQ(found[0].step, 4u);
  EXPECT_EQ(kinds(job, {.tools = &can, .stock = stock}), Kinds{});
  Job ramp = started();
  ramp.add(step::Cut{{5, 0, -1}, mm_per_min(100)});
  ramp.add(step::Rapid{{50, 0, 5}});
  EXPECT_EQ(kinds(ramp, {.tools = &cannot, .stock = stock}), Kinds{});
}

/// Two holes; `up` is 1 where Z counts upwards, -1 where it counts downwards.
Job drilled(double up) {
  Job job;
  job.add(step::ToolChange{1})
      .add(step::Spindle{rpm(10000), SpindleTurn::cw})
      .add(step::Rapid{{0, 0, 5 * up}});
  for (const double x : {1.0, 2.0})
    job.add(step::Rapid{{x, 0, 5 * up}})
        .add(step::Cut{{x, 0, -3 * up}, mm_per_min(100)})
        .add(step::Rapid{{x, 0, 5 * up}});
  return job;
}

TEST(CheckPath, ZThatCountsDownwards) {
  EXPECT_EQ(kinds(drilled(1)), Kinds{});
  const auto found = check_path(drilled(-1).path, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_z_downwards);
  EXPECT_NE(found[0].message.find("rapids run at Z -5, its cuts at Z 3;"), std::string::npos)
      << found[0].message;
  EXPECT_FALSE(found[0].hint.empty());
  Job one_level;  // a laser or plotter: the direction of Z is unknown
  one_level.add(step::ToolChange{1}).add(step::Spindle{rpm(1), SpindleTurn::cw});
  one_level.add(step::Rapid{{0, 0, 0}}).add(step::Rapid{{1, 0, 0}}).add(step::Cut{{5, 0, 0}, mm_per_min(9)});
  EXPECT_EQ(kinds(one_level), Kinds{});
}

TEST(CheckPath, AToolChangeBelowTheStocksTop) {
  Box3 stock;
  stock.add(Point3{0, 0, -10});
  stock.add(Point3{100, 100, 0});
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, mm_per_min(100)}).add(step::ToolChange{2}).add(step::Rapid{{0, 0, 5}});
  job.add(step::ToolChange{1});
  const auto found = check_path(job.path, {.stock = stock});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_tool_change_low);
  EXPECT_EQ(found[0].step, 4u);
}

TEST(CheckPath, ALowToolWithUnknownXAndYMayBeInTheStock) {
  constexpr unsigned kXY = 3;
  Box3 stock;
  stock.add(Point3{0, 0, -10});
  stock.add(Point3{100, 100, 0});
  Job job;
  job.add(step::ToolChange{1}).add(step::Spindle{rpm(10000), SpindleTurn::cw}).add(step::Rapid{{0, 0, -1}});
  job.path.set_unknown_axes(2, kXY);
  job.add(step::ToolChange{2}).add(step::Spindle{rpm(0), SpindleTurn::off});
  EXPECT_EQ(kinds(job, {.stock = stock}), (Kinds{"rapid_unknown", "tool_change_low", "stop_low"}));
}

TEST(CheckPath, AMotionToAMachinePositionOutOfTheStock) {
  constexpr unsigned kX = 1, kZ = 4, kAll = 7;
  const auto found_from = [&](double height, unsigned axes) {
    Box3 stock;
    stock.add(Point3{0, 0, -10});
    stock.add(Point3{100, 100, 0});
    Job job = started();
    job.add(step::Cut{{50, 50, height}, mm_per_min(100)}).add(step::Rapid{{0, 0, 0}});
    job.path.set_unknown_axes(4, axes);
    job.path.set_reference(4, Reference::home, axes);
    const auto found = check_path(job.path, {.stock = stock});
    return found.empty() ? Code{} : found[0].code;
  };
  EXPECT_EQ(found_from(-1, kAll), codes::path_machine_move_low);
  EXPECT_EQ(found_from(-1, kX), codes::path_machine_move_low);
  EXPECT_EQ(found_from(-1, kZ), Code{});
  EXPECT_EQ(found_from(1, kAll), Code{});
}

TEST(CheckPath, ARapidDownAtAnUnknownPosition) {
  constexpr unsigned kXY = 3;
  Box3 stock;
  stock.add(Point3{0, 0, -10});
  stock.add(Point3{100, 100, 0});
  for (const double height : {-1.0, 1.0}) {
    Job job;
    job.add(step::ToolChange{1}).add(step::Rapid{{0, 0, height}});
    job.path.set_unknown_axes(1, kXY);
    const auto found = check_path(job.path, {.stock = stock});
    ASSERT_EQ(found.size(), height < 0 ? 1u : 0u);
    if (height < 0) {
      EXPECT_EQ(found[0].code, codes::path_rapid_unknown);
    }
  }
}

TEST(CheckPath, BesideTheStockAToolMayBeLow) {
  Box3 stock;
  stock.add(Point3{0, 0, -10});
  stock.add(Point3{100, 100, 0});
  Job job = started();
  job.add(step::Rapid{{200, 0, 5}}).add(step::Rapid{{200, 0, -1}}).add(step::ToolChange{2});
  job.add(step::Spindle{rpm(0), SpindleTurn::off});
  EXPECT_TRUE(check_path(job.path, {.stock = stock}).empty());
}

TEST(CheckPath, ASpindleThatStopsInTheStock) {
  Box3 stock;
  stock.add(Point3{0, 0, -10});
  stock.add(Point3{100, 100, 0});
  Job job = started();
  job.add(step::Cut{{5, 5, -1}, mm_per_min(100)}).add(step::Spindle{rpm(0), SpindleTurn::off});
  const auto found = check_path(job.path, {.stock = stock});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_stop_low);
  EXPECT_NE(found[0].message.find("the spindle stops at Z -1, with the tool 1 mm deep"), std::string::npos);
  Job running = started();
  running.add(step::Cut{{5, 5, -1}, mm_per_min(100)});
  const auto at_end = check_path(running.path, {.stock = stock});
  ASSERT_EQ(at_end.size(), 1u);
  EXPECT_NE(at_end[0].message.find("the program ends at Z -1"), std::string::npos);
}

TEST(CheckPath, AFeedThroughTheAirNeedsNoSpindle) {
  Box3 stock;
  stock.add(Point3{0, 0, -10});
  stock.add(Point3{100, 100, 0});
  Job job = started();
  job.add(step::Rapid{{0, 0, 5}}).add(step::Spindle{rpm(0), SpindleTurn::off});
  job.add(step::Cut{{50, 50, 1}, mm_per_min(100)}).add(step::Cut{{300, 50, 0}, mm_per_min(100)});
  EXPECT_TRUE(check_path(job.path, {.stock = stock}).empty());
  job.add(step::Cut{{50, 50, -0.1}, mm_per_min(100)}).add(step::Rapid{{50, 50, 5}});
  ASSERT_EQ(check_path(job.path, {.stock = stock}).size(), 1u);
  EXPECT_EQ(check_path(job.path, {.stock = stock})[0].code, codes::path_spindle_off);
}

TEST(CheckPath, AFeedBeyondTheChipLoad) {
  const ToolTable tools = table_with(2, true);
  const Material wood{"wood", {}, {{mm(3), mm(0.1)}}};
  Job job = started();  // 10000 rpm, 2 teeth: 2000 mm/min is 0.1 mm per tooth
  job.add(step::Cut{{5, 0, -1}, mm_per_min(1999)}).add(step::Cut{{9, 0, -1}, mm_per_min(2100)});
  const auto found = check_path(job.path, {.tools = &tools, .material = &wood});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, codes::path_chip_load);
  EXPECT_EQ(found[0].step, 4u);
  EXPECT_NE(found[0].message.find("0.105 mm per tooth"), std::string::npos);
}

Box3 box_between(Point3 low, Point3 high) {
  Box3 box;
  box.add(low);
  box.add(high);
  return box;
}

TEST(CheckPath, UnknownAxesAreNotComparedWithTheTravel) {
  const Machine machine = table_of(100, 100, 50);
  for (int axis = 0; axis < 3; ++axis) {
    Job job = started();
    Point3 to{1, 1, 1};
    to[axis] = 5000.0;  // means nothing where the axis is unknown
    job.add(step::Rapid{to});
    EXPECT_EQ(kinds(job, {.machine = &machine}), Kinds{"outside_machine"}) << axis;
    job.path.set_unknown_axes(job.path.size() - 1, 1u << axis);
    EXPECT_EQ(kinds(job, {.machine = &machine}), Kinds{}) << axis;
  }
}

TEST(CheckPath, EverySideOfTheStockCounts) {
  const ToolTable tools = table_with(2, true);  // 3 mm
  const Box3 stock = box_between({10, 100, -10}, {40, 180, 0});
  const auto cut_at = [&](double x, double y, double z) {
    Job job = started();
    job.add(step::Rapid{{x, y, 5}}).add(step::Spindle{}).add(step::Cut{{x, y, z}, mm_per_min(100)});
    job.add(step::Rapid{{x, y, 5}});
    return kinds(job, {.tools = &tools, .stock = stock});
  };
  const Kinds cuts{"spindle_off"}, passes{};
  EXPECT_EQ(cut_at(25, 140, -1), cuts);
  EXPECT_EQ(cut_at(25, 140, 0), passes);
  EXPECT_EQ(cut_at(8.6, 140, -1), cuts);
  EXPECT_EQ(cut_at(8.4, 140, -1), passes);
  EXPECT_EQ(cut_at(41.4, 140, -1), cuts);
  EXPECT_EQ(cut_at(41.6, 140, -1), passes);
  EXPECT_EQ(cut_at(25, 98.6, -1), cuts);
  EXPECT_EQ(cut_at(25, 98.4, -1), passes);
  EXPECT_EQ(cut_at(25, 181.4, -1), cuts);
  EXPECT_EQ(cut_at(25, 181.6, -1), passes);
}

TEST(CheckPath, TheSpindlesLimitsBelongToItsRange) {
  Machine machine;
  machine.slowest_spindle = rpm(8000);
  machine.fastest_spindle = rpm(24000);
  const auto at = [&](double speed) {
    Job job;
    job.add(step::Spindle{rpm(speed), SpindleTurn::cw});
    return kinds(job, {.machine = &machine});
  };
  const Kinds outside{"spindle_range"}, inside{};
  EXPECT_EQ(at(7999), outside);
  EXPECT_EQ(at(8000), inside);
  EXPECT_EQ(at(24000), inside);
  EXPECT_EQ(at(24001), outside);
}

TEST(CheckPath, MessagesWithOtherValuesAreSeparate) {
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, mm_per_min(-12)}).add(step::Cut{{1, 0, -1}, mm_per_min(-12)});
  job.add(step::Cut{{2, 0, -1}, mm_per_min(-30)});
  const auto found = check_path(job.path, {});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].steps, 2u);
  EXPECT_EQ(found[1].steps, 1u);
  EXPECT_EQ(found[1].step, 5u);
  EXPECT_NE(found[0].message.find("-12"), std::string::npos);
  EXPECT_NE(found[1].message.find("-30"), std::string::npos);
}

}  // namespace
}  // namespace kerf
