// Motion figures: counts, lengths, bounds and times, in total and per tool.
#include "kerf/path/report.h"

#include <gtest/gtest.h>
#include <numbers>

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Report, CountsLengthsBoundsAndTimes) {
  Toolpath path;
  const OriginId none = OriginId::none;
  path.add(step::Rapid{{0, 0, 4}}, none);
  path.add(step::ToolChange{7}, none);
  path.add(step::Spindle{rpm(12000), SpindleTurn::cw}, none);
  path.add(step::Rapid{{3, 0, 4}}, none);
  path.add(step::Cut{{3, 0, -1}, mm_per_min(100)}, none);
  path.add(step::Arc{{3, 0, -1}, {2, 0}, Plane::xy, Turn::ccw, 1, mm_per_min(200)}, none);
  path.add(step::Dwell{seconds(3)}, none);
  path.add(step::Spindle{rpm(0), SpindleTurn::off}, none);
  path.add(step::ToolChange{8}, none);
  path.add(step::Cut{{3, 0, -1}, Feed{}}, none);
  path.add(step::Probe{{3, 0, -9}, mm_per_min(10), ProbeKind::contact}, none);
  path.add(step::ToolChange{7}, none);
  path.add(step::Cut{{3, 0, -3}, mm_per_min(60)}, none);

  const PathReport report = report_on(path, {.rapid_feed = mm_per_min(1400)});
  const MotionFigures& all = report.all;
  EXPECT_EQ(all.lines, 3u);
  EXPECT_EQ(all.arcs, 1u);
  EXPECT_EQ(all.rapids, 2u);
  EXPECT_NEAR(all.rapid_mm, 7, 1e-12);
  EXPECT_NEAR(all.cut_mm, 5 + 4 * kPi + 6, 1e-12);
  EXPECT_NEAR(all.cut_bounds.low.x, 1, 1e-12);
  EXPECT_NEAR(all.cut_bounds.high.y, 1, 1e-12);
  EXPECT_NEAR(all.cut_bounds.low.z, -3, 1e-12);
  EXPECT_EQ(all.cut_bounds.high.z, 4) << "where the plunge starts";
  EXPECT_EQ(all.cut_ends.high.z, -1);
  EXPECT_EQ(all.feed.low, 60);
  EXPECT_EQ(all.feed.high, 200);
  EXPECT_EQ(all.speed.low, 12000);
  EXPECT_NEAR(all.rapid.minutes(), 7.0 / 1400, 1e-12);
  EXPECT_NEAR(all.cutting.minutes(), 0.05 + 4 * kPi / 200 + 0.8 + 0.1, 1e-12) << "with 8 mm of probing";
  EXPECT_NEAR(all.dwell.seconds(), 3, 1e-12);

  ASSERT_EQ(report.tools.size(), 3u);
  EXPECT_FALSE(report.tools[0].tool);
  EXPECT_FALSE(report.tools[0].deepest);
  EXPECT_EQ(report.tools[1].tool, 7);
  EXPECT_EQ(report.tools[1].deepest, -3);
  EXPECT_EQ(report.tools[1].figures.lines, 2u);
  EXPECT_EQ(report.tools[2].tool, 8);
  EXPECT_NEAR(report.tools[2].figures.cut_mm, 0, 1e-12);

  const std::vector<float> seconds = reported_seconds(path, {.rapid_feed = mm_per_min(1400)});
  const std::vector<double> expected{
      60 * 4.0 / 1400, 0, 0, 60 * 3.0 / 1400, 3, 60 * 4 * kPi / 200, 3, 0, 0, 0, 48, 0, 6};
  ASSERT_EQ(seconds.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(seconds[i], expected[i], 1e-5) << i;
}

/// At 0,0,0: to these angles of A, B, C, all of them known.
void turn(Toolpath& path, std::array<double, 3> abc, double feed) {
  const std::size_t i = feed > 0.0 ? path.add(step::Cut{{0, 0, 0}, mm_per_min(feed)}, OriginId::none)
                                   : path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  path.set_extra(i, {.abc = abc});
}

TEST(Report, RotaryAxesAloneTakeDegreesPerMinute) {
  Toolpath path;
  turn(path, {0, 0, 0}, 0);
  turn(path, {3600, 0, 0}, 100);   // ten turns: 36 min
  turn(path, {3600, 30, 40}, 25);  // 50 degrees: 2 min
  path.set_extra(path.add(step::Cut{{7, 0, 0}, mm_per_min(70)}, OriginId::none),
                 {.abc = std::array<double, 3>{0, 30, 40}});  // of a motion that moves X, too, 0.1 min
  const PathReport report = report_on(path, {});
  EXPECT_NEAR(report.all.cutting.minutes(), 38.1, 1e-12);
  EXPECT_EQ(report.all.feed.high, 70) << "degrees are no mm";
  EXPECT_EQ(report.all.turn_feed.low, 25);
  EXPECT_EQ(report.all.turn_feed.high, 100);
  EXPECT_NEAR(report_on(path, {.first = 2, .end = 3}).all.cutting.minutes(), 2, 1e-12);
  EXPECT_NEAR(report_on(path, {.end = 2}).all.cutting.minutes(), 36, 1e-12);
}

TEST(Report, ATurnFromAnUnknownAngleTakesNoTime) {
  Toolpath path;
  turn(path, {360, 0, 0}, 100);
  turn(path, {0, 0, 0}, 100);
  EXPECT_NEAR(report_on(path, {}).all.cutting.minutes(), 3.6, 1e-12);
}

TEST(Report, OfAnEmptyPathIsEmpty) {
  const PathReport report = report_on(Toolpath{}, {});
  EXPECT_TRUE(report.tools.empty());
  EXPECT_TRUE(report.all.cut_bounds.empty());
  EXPECT_TRUE(report.all.feed.empty());
}

TEST(Report, ARapidTakesTheTimeOfItsSlowestAxis) {
  Toolpath path;
  path.add(step::Rapid{{30, 40, 0}}, OriginId::none);
  path.add(step::Rapid{{30, 40, -10}}, OriginId::none);
  ReportOptions options;
  options.axis_rates = {mm_per_min(3000), mm_per_min(2000), mm_per_min(500)};
  EXPECT_NEAR(report_on(path, options).all.rapid.seconds(), (40.0 / 2000 + 10.0 / 500) * 60, 1e-12);
  options.axis_rates[2] = Feed{};
  EXPECT_NEAR(report_on(path, options).all.rapid.seconds(), 60.0 / 3000 * 60, 1e-12);
}

TEST(Report, ARangeStartsWhereTheMotionBeforeItEnds) {
  Toolpath path;
  path.add(step::Rapid{{30, 0, 0}}, OriginId::none);
  path.add(step::Cut{{30, 40, 0}, mm_per_min(100)}, OriginId::none);
  path.add(step::Note{"between"}, OriginId::none);
  path.add(step::Cut{{30, 40, -7}, mm_per_min(100)}, OriginId::none);
  EXPECT_NEAR(report_on(path, {.first = 1}).all.cut_mm, 40 + 7, 1e-12) << "after a rapid";
  EXPECT_NEAR(report_on(path, {.first = 2}).all.cut_mm, 7, 1e-12) << "after a cut";
  EXPECT_NEAR(report_on(path, {.first = 1, .end = 2}).all.cut_mm, 40, 1e-12);
  EXPECT_NEAR(report_on(path, {.first = 0, .end = 1}).all.rapid_mm, 30, 1e-12);
}

TEST(Report, TheDeepestPointOfAnArcCountsAlsoBetweenItsEnds) {
  for (const Turn turn : {Turn::cw, Turn::ccw}) {
    Toolpath path;
    path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
    path.add(step::Arc{{10, 0, 0}, {5, 0}, Plane::xz, turn, 0, mm_per_min(100)}, OriginId::none);
    const PathReport report = report_on(path, {});
    ASSERT_EQ(report.tools.size(), 1u);
    // Seen from +Y, counterclockwise turns +Z to +X, so -X to +Z: clockwise runs below the chord.
    EXPECT_NEAR(*report.tools[0].deepest, turn == Turn::cw ? -5 : 0, 1e-12);
    EXPECT_NEAR(report.all.cut_bounds.high.z, turn == Turn::cw ? 0 : 5, 1e-12);
  }
}

}  // namespace
}  // namespace kerf
