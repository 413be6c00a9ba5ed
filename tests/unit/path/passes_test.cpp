// Passes: what is joined, what must stay, and deviations.
#include "kerf/path/passes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace kerf {
namespace {

const Feed kFeed = mm_per_min(500);

Toolpath started() {
  Toolpath path;
  path.add(step::Rapid{{0, 0, 0}}, OriginId::none);
  return path;
}

/// A fraction of a circle of chords about (-radius, 0) that starts at zero, rising to `rise`.
Toolpath chords(double radius, double fraction, int count, double rise = 0.0) {
  Toolpath path = started();
  for (int i = 1; i <= count; ++i) {
    const double t = static_cast<double>(i) / count, angle = 2.0 * std::numbers::pi * fraction * t;
    path.add(step::Cut{{radius * std::cos(angle) - radius, radius * std::sin(angle), rise * t}, kFeed},
             OriginId::none);
  }
  return path;
}

std::size_t count_of(const Toolpath& path, StepKind kind) {
  std::size_t count = 0;
  for (const Step& s : path.steps()) count += s.kind() == kind ? 1 : 0;
  return count;
}

TEST(ChordsToArcs, finds_the_arc_of_a_chain) {
  const PassResult result = chords_to_arcs(chords(10, 0.5, 90), {.tolerance = mm(0.01)});
  ASSERT_EQ(result.path.size(), 2u);
  const step::Arc arc = result.path[1].arc();
  EXPECT_NEAR(arc.centre.x, -10, 1e-6);
  EXPECT_NEAR(arc.centre.y, 0, 1e-6);
  EXPECT_EQ(arc.turn, Turn::ccw);
  EXPECT_NEAR(distance(arc.to, {-20, 0, 0}), 0, 1e-9);
  EXPECT_EQ(result.before.steps, 91u);
  EXPECT_EQ(result.after.steps, 2u);
  EXPECT_NEAR(result.after.cut_mm, 10 * std::numbers::pi, 1e-6);
}

TEST(ChordsToArcs, finds_helices_and_leaves_uneven_rises) {
  EXPECT_EQ(count_of(chords_to_arcs(chords(10, 0.5, 90, 3.0), {}).path, StepKind::arc), 1u);
  Toolpath uneven = started();
  for (int i = 1; i <= 40; ++i) {
    const double a = 0.05 * i;
    uneven.add(step::Cut{{10 * std::cos(a) - 10, 10 * std::sin(a), i % 2 == 0 ? 0.0 : 1.0}, kFeed},
               OriginId::none);
  }
  EXPECT_EQ(count_of(chords_to_arcs(uneven, {}).path, StepKind::arc), 0u);
}

TEST(ChordsToArcs, keeps_polygons_lines_and_changes_of_feed) {
  EXPECT_EQ(count_of(chords_to_arcs(chords(10, 1.0, 6), {}).path, StepKind::arc), 0u);
  Toolpath line = started();
  for (int i = 1; i < 20; ++i) line.add(step::Cut{{1.0 * i, 0, 0}, kFeed}, OriginId::none);
  EXPECT_EQ(count_of(chords_to_arcs(line, {}).path, StepKind::arc), 0u);
  Toolpath feeds = started();
  for (int i = 1; i <= 60; ++i) {
    const double a = 0.05 * i;
    feeds.add(step::Cut{{10 * std::cos(a) - 10, 10 * std::sin(a), 0}, i <= 30 ? kFeed : mm_per_min(100)},
              OriginId::none);
  }
  const PassResult result = chords_to_arcs(feeds, {});
  EXPECT_EQ(count_of(result.path, StepKind::arc), 2u);
}

TEST(ChordsToArcs, two_chords_are_no_arc) {
  for (const std::size_t fewest : {1u, 2u, 3u}) {
    EXPECT_EQ(count_of(chords_to_arcs(chords(10, 0.02, 2), {.tolerance = mm(0.01), .fewest = fewest}).path,
                       StepKind::arc),
              0u);
    EXPECT_EQ(count_of(chords_to_arcs(chords(10, 0.3, 30), {.tolerance = mm(0.01), .fewest = fewest}).path,
                       StepKind::arc),
              1u);
  }
  EXPECT_EQ(
      count_of(chords_to_arcs(chords(10, 0.1, 5), {.tolerance = mm(0.01), .fewest = 6}).path, StepKind::arc),
      0u);
}

TEST(ChordsToArcs, a_whole_circle_keeps_its_length) {
  const PassResult result = chords_to_arcs(chords(10, 1.0, 360), {.tolerance = mm(0.01)});
  EXPECT_NEAR(result.after.cut_mm, result.before.cut_mm, 0.01);
  EXPECT_LE(result.path.size(), 20u);
}

TEST(ArcsToChords, stay_on_the_arc_and_fit_again) {
  Toolpath path = started();
  path.add(step::Arc{.to = {-20, 0, 1}, .centre = {-10, 0}, .turn = Turn::ccw, .feed = kFeed},
           OriginId::none);
  const PassResult lines = arcs_to_chords(path, mm(0.01));
  EXPECT_EQ(count_of(lines.path, StepKind::arc), 0u);
  EXPECT_GT(lines.path.size(), 20u);
  EXPECT_EQ(count_of(chords_to_arcs(lines.path, {.tolerance = mm(0.011)}).path, StepKind::arc), 1u);
}

TEST(JoinStraight, joins_collinear_cuts_and_keeps_corners) {
  Toolpath path = started();
  for (int i = 1; i <= 10; ++i) path.add(step::Cut{{1.0 * i, 0, 0}, kFeed}, OriginId::none);
  path.add(step::Cut{{10, 5, 0}, kFeed}, OriginId::none);
  path.add(step::Cut{{10, 2, 0}, kFeed}, OriginId::none);  // back
  const PassResult result = join_straight(path, mm(0.001));
  ASSERT_EQ(result.path.size(), 4u);
  EXPECT_EQ(result.path[1].to(), (Point3{10, 0, 0}));
  EXPECT_NEAR(result.before.cut_mm, result.after.cut_mm, 1e-9);
}

TEST(JoinStraight, motions_back_and_forth_on_one_line_are_kept) {
  Toolpath path = started();
  for (const double x : {10.0, 4.0, 20.0}) path.add(step::Cut{{x, 0, 0}, kFeed}, OriginId::none);
  const PassResult result = join_straight(path, mm(0.001));
  EXPECT_NEAR(result.after.cut_mm, 10 + 6 + 16, 1e-9);
  Toolpath beyond = started();
  for (const double x : {5.0, 25.0, 20.0}) beyond.add(step::Cut{{x, 0, 0}, kFeed}, OriginId::none);
  EXPECT_NEAR(join_straight(beyond, mm(0.001)).after.cut_mm, 25 + 5, 1e-9);
  Toolpath within = started();  // back by less than the tolerance
  for (const double x : {10.0, 9.5, 20.0}) within.add(step::Cut{{x, 0, 0}, kFeed}, OriginId::none);
  EXPECT_NEAR(join_straight(within, mm(1)).after.cut_mm, 10 + 0.5 + 10.5, 1e-9);
}

TEST(JoinStraight, a_slow_curve_is_not_joined) {
  Toolpath path = started();
  for (int i = 1; i <= 100; ++i) {
    const double a = 0.01 * i;
    path.add(step::Cut{{100 * std::sin(a), 100 - 100 * std::cos(a), 0}, kFeed}, OriginId::none);
  }
  const PassResult result = join_straight(path, mm(0.02));
  EXPECT_LT(result.path.size(), 60u);
  EXPECT_NEAR(result.after.cut_mm, 100.0, 0.05);
}

TEST(ShortenRapids, removes_rapids_without_effect) {
  Toolpath path = started();
  path.add(step::Cut{{0, 0, -1}, kFeed}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Rapid{{0, 0, 0.5}}, OriginId::none);
  path.add(step::Rapid{{0, 0, 0.5}}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  path.add(step::Rapid{{9, 0, 5}}, OriginId::none);
  const PassResult result = shorten_rapids(path);
  ASSERT_EQ(result.path.size(), 5u);
  EXPECT_EQ(result.path[2].to().z, 0.5);
  EXPECT_LT(result.after.rapid_mm, result.before.rapid_mm);
}

TEST(ShortenRapids, keeps_a_way_down_and_up) {
  Toolpath path = started();
  path.add(step::Cut{{0, 0, -1}, kFeed}, OriginId::none);
  path.add(step::Rapid{{0, 0, -5}}, OriginId::none);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  const PassResult result = shorten_rapids(path);
  EXPECT_EQ(result.path.size(), 4u);
  EXPECT_EQ(result.after.rapid_mm, 4 + 10);
}

TEST(ShortenRapids, keeps_motions_at_unknown_positions) {
  Toolpath path;
  path.set_unknown_axes(path.add(step::Rapid{{0, 0, 5}}, OriginId::none), 3);
  path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
  EXPECT_EQ(shorten_rapids(path).path.size(), 2u);
}

TEST(UnusedFirstTool, IsLeftOutUnlessItCuts) {
  for (const bool cuts : {true, false}) {
    Toolpath path;
    path.add(step::ToolChange{102}, OriginId::none);
    path.add(step::Rapid{{0, 0, 5}}, OriginId::none);
    if (cuts) path.add(step::Cut{{0, 0, -1}, mm_per_min(100)}, OriginId::none);
    path.add(step::ToolChange{201}, OriginId::none);
    path.add(step::Cut{{9, 0, -1}, mm_per_min(100)}, OriginId::none);
    const Toolpath made = without_unused_first_tool(path);
    EXPECT_EQ(made.size(), path.size() - (cuts ? 0 : 1));
    EXPECT_EQ(made[0].kind(), cuts ? StepKind::tool_change : StepKind::rapid);
  }
  // A change that is not the first step was asked for.
  Toolpath path;
  path.add(step::Note{"Toolpath"}, OriginId::none);
  path.add(step::ToolChange{102}, OriginId::none);
  EXPECT_EQ(without_unused_first_tool(path).size(), 2u);
}

}  // namespace
}  // namespace kerf
