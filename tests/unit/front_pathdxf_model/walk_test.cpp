// The order of the elements of a path, and which element takes a text.
#include "front/pathdxf/model/walk.h"

#include <gtest/gtest.h>

#include "front/pathdxf/model/assign_texts.h"

namespace kerf::pathdxf {
namespace {

constexpr double kUnnumbered = 9998;

std::vector<std::size_t> order(const std::vector<Link>& links, Point2 from) {
  std::vector<std::size_t> list;
  for (const WalkStep& step : walk(links, from).steps) list.push_back(step.link);
  return list;
}

TEST(PathWalk, FollowsAndReverses) {
  const std::vector<Link> links{{{20, 0}, {10, 0}, kUnnumbered, 4}, {{0, 0}, {10, 0}, kUnnumbered, 4}};
  const Walk w = walk(links, {0, 0});
  ASSERT_EQ(w.steps.size(), 2u);
  EXPECT_EQ(w.steps[0].link, 1u);
  EXPECT_FALSE(w.steps[0].reversed);
  EXPECT_EQ(w.steps[1].link, 0u);
  EXPECT_TRUE(w.steps[1].reversed);
  EXPECT_EQ(w.end, (Point2{20, 0}));
  EXPECT_TRUE(w.unreached.empty());
}

TEST(PathWalk, PrefersOrderThenRankThenLengthThenTheFirst) {
  // Four ways from the origin and back, each of two links.
  std::vector<Link> links;
  const auto loop = [&](Point2 p, double n, int rank) {
    links.push_back({{0, 0}, p, n, rank});
    links.push_back({p, {0, 0}, n, rank});
  };
  loop({0, 5}, kUnnumbered, 5);
  loop({9, 0}, kUnnumbered, 4);
  loop({0, -3}, kUnnumbered, 4);
  loop({-3, 0}, kUnnumbered, 4);
  loop({50, 50}, 1, 5);
  EXPECT_EQ(order(links, {0, 0}), (std::vector<std::size_t>{8, 9, 4, 5, 6, 7, 2, 3, 0, 1}));
}

TEST(PathWalk, JoinsEndsWithinTheTolerance) {
  const auto joined = [](double gap) {
    return order({{{0, 0}, {10, 0}, 0, 4}, {{10 + gap, 0}, {20, 0}, 0, 4}}, {0, 0}).size() == 2;
  };
  EXPECT_TRUE(joined(3e-5));
  EXPECT_TRUE(joined(-3e-5));
  EXPECT_FALSE(joined(4e-5));
}

TEST(PathWalk, ReportsWhatItDoesNotReach) {
  const std::vector<Link> links{{{0, 0}, {10, 0}, 0, 4}, {{10.5, 0}, {20, 0}, 0, 4}};
  const Walk w = walk(links, {0, 0});
  EXPECT_EQ(w.unreached, (std::vector<std::size_t>{1}));
  const auto open = nearest_end(links, w.unreached, w.end);
  ASSERT_TRUE(open);
  EXPECT_EQ(open->at, (Point2{10.5, 0}));
  EXPECT_DOUBLE_EQ(open->distance, 0.5);
}

TEST(PathWalk, NamesTheNearestOfSeveralEnds) {
  const std::vector<Link> links{{{90, 0}, {50, 0}, 0, 4}, {{30, 3}, {34, 0}, 0, 4}, {{40, 0}, {70, 0}, 0, 4}};
  const auto open = nearest_end(links, {0, 1, 2}, {30, 0});
  ASSERT_TRUE(open);
  EXPECT_EQ(open->at, (Point2{30, 3}));
  EXPECT_DOUBLE_EQ(open->distance, 3.0);
  EXPECT_EQ(nearest_end(links, {0, 2}, {30, 0})->at, (Point2{40, 0}));
}

TEST(PathWalk, TakesTimeInProportionToTheElements) {
  std::vector<Link> links;  // a star: all at one point
  for (int i = 0; i < 100'000; ++i) links.push_back({{0, 0}, {0, 0}, double(i % 7), i % 3});
  EXPECT_EQ(walk(links, {0, 0}).steps.size(), links.size());
}

Element circle(Point2 centre, double radius) {
  Element e;
  e.shape = Shape::circle;
  e.centre = centre;
  e.radius = radius;
  return e;
}
Element line(Point2 from, Point2 to) {
  Element e;
  e.start = from;
  e.end = to;
  return e;
}
Element arc(Point2 centre, double radius, double start, double turn) {
  Element e = circle(centre, radius);
  e.shape = Shape::arc;
  e.start_angle = start;
  e.turn = turn;
  return e;
}

TEST(TextTargets, PreferCirclesThenArcsThenLines) {
  const std::vector<Element> elements{line({-5, 0}, {5, 0}), arc({0, -10}, 10, 0, 3.14), circle({2, 0}, 1.5)};
  TextTargets targets;
  for (std::size_t i = 0; i < elements.size(); ++i) targets.add(elements[i], i);
  const TextCircle text{{0, 0}, 1.0};
  EXPECT_EQ(targets.take(text), 2u);
  EXPECT_EQ(targets.take(text), 1u);
  EXPECT_EQ(targets.take(text), 0u);
  EXPECT_FALSE(targets.take(text));
}

TEST(TextTargets, TakeTheNearest) {
  const std::vector<Element> elements{line({-5, 1}, {5, 1}), line({-5, -0.5}, {5, -0.5}),
                                      line({6, 0}, {9, 0})};
  TextTargets targets;
  for (std::size_t i = 0; i < elements.size(); ++i) targets.add(elements[i], i);
  EXPECT_EQ(targets.take({{0, 0}, 2.0}), 1u);
  EXPECT_EQ(targets.take({{0, 0}, 2.0}), 0u);
  EXPECT_FALSE(targets.take({{5.5, 0}, 2.0}));  // before the start of the third line
  EXPECT_FALSE(targets.take({{9.5, 0}, 2.0}));  // beyond its end
  EXPECT_EQ(targets.take({{6.5, 0}, 2.0}), 2u);
}

TEST(TextTargets, NeedOverlap) {
  const Element e = circle({0, 0}, 1.0);
  TextTargets targets;
  targets.add(e, 0);
  EXPECT_FALSE(targets.take({{2.0, 0}, 1.0}));
  EXPECT_EQ(targets.take({{1.999, 0}, 1.0}), 0u);
  const Element quarter = arc({0, 0}, 10, 0, 1.5707);
  TextTargets arcs;
  arcs.add(quarter, 0);
  EXPECT_FALSE(arcs.take({{-10, 0}, 1.0}));  // outside its angles
  EXPECT_FALSE(arcs.take({{6, 6}, 1.0}));    // 8.485 from the centre
  EXPECT_EQ(arcs.take({{7, 7}, 1.0}), 0u);
}

}  // namespace
}  // namespace kerf::pathdxf
