// Canned cycles as motions. Expectations are computed by hand from the sequences of LinuxCNC's page
// "G-Codes".
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/codes/gcode.h"

#include "kerf/op/holes.h"

namespace kerf {
namespace {

/// "R x y z" rapid, "C x y z" cut, "D s" dwell, "S off|cw|ccw" spindle, "M0" pause.
class Recorder final : public DrillSink {
 public:
  void rapid(Point3 to) override { add_move("R", to); }
  void cut(Point3 to) override { add_move("C", to); }
  void dwell(Duration time) override { add(fmt::format("D {:g}", time.seconds())); }
  void spindle(SpindleTurn turn) override {
    add(turn == SpindleTurn::off ? "S off" : turn == SpindleTurn::cw ? "S cw" : "S ccw");
  }
  void pause() override { add("M0"); }
  bool is_full() const override { return steps_ >= limit; }

  std::string text;
  int limit = 1 << 30;
  int steps_ = 0;

 private:
  void add_move(const char* word, Point3 to) {
    add(fmt::format("{} {:g} {:g} {:g}", word, to.x, to.y, to.z));
  }
  void add(const std::string& step) {
    text += (text.empty() ? "" : "; ") + step;
    ++steps_;
  }
};

std::string moves_of(const DrillCycle& cycle, Point3 from = {0, 0, 5}) {
  Recorder recorder;
  expand(cycle, from, recorder);
  EXPECT_LE(min_steps(cycle), recorder.steps_);
  return recorder.text;
}

/// A hole at X10 from Z5 with its retract plane at Z2 and its bottom at Z-3.
DrillCycle hole(DrillKind kind) {
  DrillCycle cycle;
  cycle.kind = kind;
  cycle.at = {10, 0, 0};
  cycle.retract_plane = 2, cycle.bottom = -3, cycle.start_level = 5;
  cycle.peck = mm(2);
  cycle.dwell = seconds(0.5);
  cycle.turn = SpindleTurn::cw;
  return cycle;
}

TEST(DrillCycle, EachKindHasItsSequence) {
  const std::string in = "R 10 0 5; R 10 0 2; C 10 0 -3; ";
  EXPECT_EQ(moves_of(hole(DrillKind::plain)), in + "R 10 0 2");
  EXPECT_EQ(moves_of(hole(DrillKind::dwell)), in + "D 0.5; R 10 0 2");
  EXPECT_EQ(moves_of(hole(DrillKind::chip_break)),
            "R 10 0 5; R 10 0 2; C 10 0 0; R 10 0 0.254; C 10 0 -2; R 10 0 -1.746; C 10 0 -3; R 10 0 2");
  EXPECT_EQ(moves_of(hole(DrillKind::peck)),
            "R 10 0 5; R 10 0 2; C 10 0 0; R 10 0 2; R 10 0 0.254; C 10 0 -2; R 10 0 2; R 10 0 -1.746; "
            "C 10 0 -3; R 10 0 2");
  EXPECT_EQ(moves_of(hole(DrillKind::tap)), in + "S ccw; D 0.5; C 10 0 2; S cw");
  EXPECT_EQ(moves_of(hole(DrillKind::left_tap)), in + "S cw; D 0.5; C 10 0 2; S ccw");
  EXPECT_EQ(moves_of(hole(DrillKind::bore)), in + "C 10 0 2; R 10 0 2");
  EXPECT_EQ(moves_of(hole(DrillKind::stopped_bore)), in + "D 0.5; S off; R 10 0 2; S cw");
  EXPECT_EQ(moves_of(hole(DrillKind::manual_bore)), in + "D 0.5; S off; M0; R 10 0 2; S cw");
  EXPECT_EQ(moves_of(hole(DrillKind::dwell_bore)), in + "D 0.5; C 10 0 2");
}

TEST(DrillCycle, BackBoreEntersBesideTheHole) {
  DrillCycle cycle = hole(DrillKind::back_bore);
  cycle.back_level = -2;
  cycle.aside = {1, 1, 0};
  EXPECT_EQ(moves_of(cycle),
            "R 10 0 5; R 10 0 2; R 11 1 2; S off; R 11 1 -3; R 10 0 -3; S cw; C 10 0 -2; C 10 0 -3; S off; "
            "R 11 1 -3; R 11 1 2; R 10 0 2; S cw");
}

TEST(DrillCycle, RetractsToTheStartWhereThatIsHigher) {
  DrillCycle cycle = hole(DrillKind::plain);
  cycle.retract = DrillRetract::start;
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -3; R 10 0 5");
  // A boring cycle cuts to the retract plane only, G89 and taps all the way.
  cycle.kind = DrillKind::bore;
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -3; C 10 0 2; R 10 0 5");
  cycle.kind = DrillKind::dwell_bore;
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -3; D 0.5; C 10 0 5");
}

TEST(DrillCycle, RisesToTheRetractPlaneFirst) {
  DrillCycle cycle = hole(DrillKind::plain);
  cycle.start_level = 1;
  for (const DrillRetract retract : {DrillRetract::plane, DrillRetract::start}) {
    cycle.retract = retract;
    EXPECT_TRUE(rises_first(cycle));
    EXPECT_EQ(moves_of(cycle, {0, 0, 1}), "R 0 0 2; R 10 0 2; C 10 0 -3; R 10 0 2");
  }
  cycle.start_level = 2;
  EXPECT_EQ(moves_of(cycle, {0, 0, 2}), "R 10 0 2; C 10 0 -3; R 10 0 2");
}

TEST(DrillCycle, ALaterHoleOfASeriesStartsWhereTheLastOneEnded) {
  DrillCycle cycle = hole(DrillKind::plain);
  cycle.retract_plane = 3;  // that of the first hole was 2: the tool rises on the way
  EXPECT_EQ(moves_of(cycle, {1, 0, 2}), "R 10 0 3; C 10 0 -3; R 10 0 3");
  cycle.retract_plane = 1;
  EXPECT_EQ(moves_of(cycle, {1, 0, 2}), "R 10 0 2; R 10 0 1; C 10 0 -3; R 10 0 1");
  cycle.retract = DrillRetract::start;
  EXPECT_EQ(moves_of(cycle, {1, 0, 2}), "R 10 0 5; R 10 0 1; C 10 0 -3; R 10 0 5");
}

TEST(DrillCycle, RepeatsMoveByTheIncrement) {
  DrillCycle cycle = hole(DrillKind::plain);
  cycle.holes = 3;
  EXPECT_EQ(moves_of(cycle),
            "R 10 0 5; R 10 0 2; C 10 0 -3; R 10 0 2; R 10 0 2; C 10 0 -3; R 10 0 2; R 10 0 2; C 10 0 -3; "
            "R 10 0 2");
  cycle.holes = 2;
  cycle.increment = {10, 5, 0};
  cycle.retract = DrillRetract::start;
  EXPECT_EQ(moves_of(cycle),
            "R 10 0 5; R 10 0 2; C 10 0 -3; R 10 0 5; R 20 5 5; R 20 5 2; C 20 5 -3; R 20 5 5");
}

TEST(DrillCycle, HolesRunAlongTheThirdAxisOfThePlane) {
  DrillCycle cycle = hole(DrillKind::back_bore);
  cycle.plane = Plane::xz;
  cycle.at = {10, 0, 5};
  cycle.start_level = 0;
  cycle.back_level = -2;
  cycle.aside = {1, 0, 1};
  EXPECT_EQ(moves_of(cycle),
            "R 0 2 5; R 10 2 5; R 11 2 6; S off; R 11 -3 6; R 10 -3 5; S cw; C 10 -2 5; C 10 -3 5; S off; "
            "R 11 -3 6; R 11 2 6; R 10 2 5; S cw");
  cycle = hole(DrillKind::plain);
  cycle.plane = Plane::yz;
  cycle.at = {0, 3, 2};
  cycle.start_level = 0;
  EXPECT_EQ(moves_of(cycle), "R 2 0 5; R 2 3 2; C -3 3 2; R 2 3 2");
}

TEST(DrillCycle, DegeneratePecks) {
  DrillCycle cycle = hole(DrillKind::peck);
  cycle.peck = mm(20);  // deeper than the hole
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -3; R 10 0 2");
  cycle.peck = mm(5);  // exactly the hole
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -3; R 10 0 2");
  cycle.peck = mm(2.5);
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -0.5; R 10 0 2; R 10 0 -0.246; C 10 0 -3; R 10 0 2");
  cycle.peck = mm(5 - 1e-9);  // the rest is rounding
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -3; R 10 0 2");
  cycle.bottom = 2;  // no depth
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 2; R 10 0 2");
  cycle.bottom = 1.9;
  cycle.peck = mm(0.05);  // less than the clearance, which then ends above the retract plane
  cycle.kind = DrillKind::chip_break;
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 1.95; R 10 0 2.204; C 10 0 1.9; R 10 0 2");
}

TEST(DrillCycle, NoDwellOfZeroSeconds) {
  DrillCycle cycle = hole(DrillKind::dwell);
  cycle.dwell = {};
  EXPECT_EQ(moves_of(cycle), "R 10 0 5; R 10 0 2; C 10 0 -3; R 10 0 2");
}

TEST(DrillCycle, Faults) {
  DrillCycle cycle = hole(DrillKind::peck);
  EXPECT_FALSE(fault_of(cycle));
  cycle.peck = {};
  EXPECT_EQ(fault_of(cycle)->code, codes::word_missing);
  cycle.kind = DrillKind::plain;
  EXPECT_FALSE(fault_of(cycle));
  cycle.bottom = 2;
  EXPECT_FALSE(fault_of(cycle));
  cycle.bottom = 2.5;
  EXPECT_EQ(fault_of(cycle)->code, codes::cycle_upside_down);
  EXPECT_EQ(fault_of(cycle)->message, "the retract plane R is 0.5 mm below the bottom of the hole");
  cycle = hole(DrillKind::chip_break);
  cycle.peck = mm(5e-6);
  EXPECT_EQ(fault_of(cycle)->code, codes::word_out_of_range);
  EXPECT_FALSE(fault_of(cycle, 2e6));
  cycle.retract_plane = 1e7;  // here a peck is less than what a coordinate resolves
  cycle.bottom = 1e7 - 1e-8;
  cycle.peck = mm(1e-12);
  EXPECT_EQ(fault_of(cycle)->code, codes::word_out_of_range);
}

TEST(DrillCycle, AFullSinkEndsIt) {
  DrillCycle cycle = hole(DrillKind::peck);
  cycle.peck = mm(1e-3);
  cycle.holes = 1000;
  Recorder recorder;
  recorder.limit = 10;
  expand(cycle, {0, 0, 5}, recorder);
  EXPECT_LT(recorder.steps_, 20);
}

TEST(DrillCycle, StepsOfAToolpath) {
  Toolpath path;
  const OriginId origin = path.origins().text(path.origins().file("a.nc"), 3, 1);
  add_cycle(path, hole(DrillKind::stopped_bore), {0, 0, 5}, {mm_per_min(100), rpm(3000)}, origin);
  ASSERT_EQ(path.size(), 7u);
  EXPECT_EQ(path[2].kind(), StepKind::cut);
  EXPECT_EQ(path[2].to(), (Point3{10, 0, -3}));
  EXPECT_EQ(path[2].feed(), mm_per_min(100));
  EXPECT_EQ(path[3].dwell().time, seconds(0.5));
  EXPECT_EQ(path[4].spindle().turn, SpindleTurn::off);
  EXPECT_EQ(path[4].spindle().speed, rpm(0));
  EXPECT_EQ(path[6].spindle().speed, rpm(3000));
  for (const Step& s : path.steps()) EXPECT_EQ(s.origin(), origin);
}

}  // namespace
}  // namespace kerf
