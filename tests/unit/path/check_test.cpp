// The checks of a toolpath by itself: every code provoked, and sound paths left in peace.
#include "kerf/check.h"

#include <gtest/gtest.h>

namespace kerf {
namespace {

/// A sound little job: tool, spindle, plunge, line, half circle.
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

TEST(CheckPath, SoundJobHasNoHazards) {
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
  EXPECT_EQ(found[0].code, Code::path_no_feed);
  EXPECT_EQ(found[0].step, 3u);
  EXPECT_EQ(found[0].steps, 2u);
  EXPECT_EQ(found[0].at, (Point3{0, 0, -1}));
}

TEST(CheckPath, ASoundCutEndsARun) {
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

TEST(CheckPath, NegativeFeedSaysItsValue) {
  Job job = started();
  job.add(step::Cut{{0, 0, -1}, mm_per_min(-12.5)});
  const auto found = check_path(job.path, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, Code::path_negative_feed);
  EXPECT_NE(found[0].message.find("-12.5"), std::string::npos);
}

TEST(CheckPath, CutBeforeAToolChange) {
  Job job;
  job.add(step::Spindle{rpm(1000), SpindleTurn::ccw}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(job), Kinds{"no_tool"});
}

TEST(CheckPath, KindsAreTheCodesNamesWithoutTheirArea) {
  EXPECT_EQ(kind_of(PathHazard{Code::path_no_tool, 0, 1, {}, {}}), "no_tool");
  EXPECT_EQ(kind_of(PathHazard{Code::path_arc_radii, 0, 1, {}, {}}), "arc_radii");
  EXPECT_EQ(kind_of(PathHazard{Code::path_spindle_off, 0, 1, {}, {}}), "spindle_off");
}

TEST(CheckPath, SpindleNeverStartedOrStopped) {
  Job never;
  never.add(step::ToolChange{1}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(never), Kinds{"spindle_off"});
  Job stopped = started();
  stopped.add(step::Spindle{}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(stopped), Kinds{"spindle_off"});
  Job by_hand = started();  // it turns, at a speed that nobody told
  by_hand.add(step::Spindle{rpm(0), SpindleTurn::cw}).add(step::Cut{{0, 0, -1}, mm_per_min(10)});
  EXPECT_EQ(kinds(by_hand), Kinds{});
}

TEST(CheckPath, ALaserNeedsNoSpindle) {
  Job job;
  job.add(step::ToolChange{1}).add(step::LaserPower{LaserMode::dynamic, 255.0});
  job.add(step::Cut{{1, 0, 0}, mm_per_min(10)});
  EXPECT_EQ(kinds(job), Kinds{});
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

TEST(CheckPath, AMissingEndIsToldAtTheLastStep) {
  Job job = started();
  job.add(step::Cut{{3, 0, -1}, mm_per_min(100)}).add(step::Dwell{seconds(1)});
  const auto found = check_path(job.path, {.end = ProgramEnd::missing});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].code, Code::path_no_program_end);
  EXPECT_EQ(found[0].step, 4u);
  EXPECT_EQ(found[0].at, (Point3{3, 0, -1}));
}

}  // namespace
}  // namespace kerf
