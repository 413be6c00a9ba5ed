// Keyholes, slots, threads and countersinks: where the axis goes, from the geometry of each.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/op.h"
#include "geom/base/line_arc.h"
#include "swept.h"

#include "kerf/base/limits.h"
#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

Tool keyhole_bit() { return made(shape::Keyhole{mm(9.5), mm(4), mm(4.8), mm(12)}); }
Tool dovetail() { return made(shape::Dovetail{mm(12), mm(9), degrees(14)}); }
Tool thread_mill() { return made(shape::ThreadMill{mm(4), mm(6), mm(1.5), mm(20)}); }
Tool ball(double d) { return made(shape::Ball{mm(d), mm(30)}); }

CutOptions usual(double depth) {
  CutOptions cut;
  cut.depth = mm(depth), cut.feed = mm_per_min(500), cut.plunge = mm_per_min(100);
  return cut;
}

TEST(Keyhole, TheToolComesUpWhereItWentDown) {
  for (const double clearance : {0.0, 0.6}) {
    KeyholeOptions options{.cut = usual(6), .length = mm(12), .angle = degrees(90)};
    options.clearance = mm(clearance);
    Diagnostics diagnostics;
    const auto op = keyhole({{10, 20}, {40, 20}}, keyhole_bit(), options, diagnostics);
    ASSERT_TRUE(op);
    const std::vector<Motion> cuts = motions(op->path);
    for (const Motion& m : cuts) {
      if (m.from.z != m.to.z) {
        EXPECT_TRUE(m.from.xy() == Point2(10, 20) || m.from.xy() == Point2(40, 20));
      }
      if (!m.rapid && m.from.z == -6 && m.to.z == -6) {
        const double x = m.to.x < 25 ? 10 : 40;
        EXPECT_LE(std::abs(m.to.x - x), 0.5 * clearance + 1e-9);
        EXPECT_LE(m.to.y, 32 + 0.5 * clearance + 1e-9);
      }
    }
    // The slot is as wide as requested, between its ends.
    const double half = 0.5 * (9.5 + clearance);
    EXPECT_TRUE(removed_to(cuts, {10 - half + 0.01, 26}, 4.75, -6));
    EXPECT_TRUE(removed_to(cuts, {10 + half - 0.01, 26}, 4.75, -6));
    EXPECT_FALSE(touched(cuts, {10 + half + 0.01, 26}, 4.75, 0));
    EXPECT_TRUE(removed_to(cuts, {10, 32 + half - 0.01}, 4.75, -6));
  }
}

TEST(Keyhole, IsRefusedForToolsThatDoNotCutAtTheirCentre) {
  Tool bit = keyhole_bit();
  bit.plunges = false;
  for (const Tool& tool : {bit, dovetail()}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(keyhole({{10, 20}}, tool, {.cut = usual(6), .length = mm(12)}, diagnostics));
    ASSERT_EQ(diagnostics.list().size(), 1u);
    EXPECT_EQ(diagnostics.list()[0].code, codes::op_tool_kind);
    EXPECT_NE(diagnostics.list()[0].message.find("cannot go down where a keyhole starts"), std::string::npos);
  }
}

TEST(Slot, ADovetailEntersAndLeavesOutsideAndIsAsWideAsRequested) {
  const Outline line{{0, 0}, {{{50, 0}, {}}}};
  for (const double width : {0.0, 15.0, 30.0}) {
    SlotOptions options{.cut = usual(6), .width = mm(width)};
    Diagnostics diagnostics;
    const auto op = slot({line}, dovetail(), options, diagnostics);
    ASSERT_TRUE(op);
    const std::vector<Motion> cuts = motions(op->path);
    for (const Motion& m : cuts)
      if (m.from.z != m.to.z && m.low() < 0) {
        EXPECT_TRUE(m.from.x <= -6 || m.from.x >= 56) << m.from.x;
      }
    const double half = 0.5 * std::max(width, 12.0);
    for (double y = -half + 0.05; y < half; y += 0.5)
      for (const double x : {0.1, 20.0, 49.9}) {
        EXPECT_TRUE(removed_to(cuts, {x, y}, 6, -6)) << x << " " << y;
      }
    EXPECT_FALSE(touched(cuts, {20, half + 0.01}, 6, 0));
    EXPECT_FALSE(touched(cuts, {20, -half - 0.01}, 6, 0));
  }
}

/// Compared with the distance from the line, at points all over.
void expect_cleared(const Outline& line, const Tool& tool, const SlotOptions& options) {
  SCOPED_TRACE(testing::Message() << "width " << options.width.mm() << ", stepover " << options.stepover);
  Diagnostics diagnostics;
  const auto op = slot({line}, tool, options, diagnostics);
  ASSERT_TRUE(op);
  const std::vector<Motion> cuts = motions(op->path);
  const double radius = 0.5 * tool.diameter.mm(), half = 0.5 * options.width.mm(), pitch = 0.4;
  const std::vector<Point2> points = flattened(line, mm(0.001));
  const auto away = [&](Point2 p) {
    double least = INFINITY;
    for (std::size_t i = 1; i < points.size(); ++i)
      least = std::min(least, distance_to(line_between(points[i - 1], points[i]), p));
    return least;
  };
  const Point2 ends[] = {points.front(), points.back()};
  for (const Motion& m : cuts)
    if (m.from.z != m.to.z && m.low() < 0) {
      EXPECT_LT(std::min(distance(m.to.xy(), ends[0]), distance(m.to.xy(), ends[1])), 1.5 * half + 6);
    }
  const Box2 box = bounds(line);
  for (double x = box.low.x - half; x < box.high.x + half; x += pitch)
    for (double y = box.low.y - half; y < box.high.y + half; y += pitch) {
      const double d = away({x, y});
      if (d < half - 0.01) {
        EXPECT_TRUE(removed_to(cuts, {x, y}, radius, -6)) << x << " " << y;
      } else if (d > half + 0.01 && distance(ends[0], {x, y}) > 2 * half + 12 &&
                 distance(ends[1], {x, y}) > 2 * half + 12) {
        EXPECT_FALSE(touched(cuts, {x, y}, radius, 0)) << x << " " << y;
      }
    }
}

TEST(Slot, IsClearedWholeWhereItCrossesItselfAndInArcsSmallerThanItsWidth) {
  const Outline crossing{
      {0, 0}, {{{60, 0}, {}}, {{60, 12}, Point2{66, 6}}, {{23, 12}, {}}, {{20, 15}, {}}, {{20, -40}, {}}}};
  const Outline winding{{0, 0},
                        {{{40, 0}, {}},
                         {{44, 4}, Point2{42.828, 1.172}},
                         {{44, 20}, {}},
                         {{38, 20}, Point2{41, 23}},
                         {{38, 9}, {}},
                         {{-30, 40}, {}}}};
  for (const Outline& line : {crossing, reversed(winding)})
    for (const double width : {7.0, 12.0, 27.0})
      for (const double stepover : {0.4, 0.95})
        for (const CutDirection direction : {CutDirection::climb, CutDirection::conventional}) {
          SlotOptions options{.cut = usual(6), .stepover = stepover, .width = mm(width)};
          options.cut.direction = direction;
          expect_cleared(line, mill(6), options);
        }
}

/// The turns counter-clockwise that all arcs with a rise or fall make, and their sum of rises.
std::pair<double, double> helices(const Toolpath& path, Point2 centre) {
  double turns = 0.0, rise = 0.0;
  for_each_motion(path, [&](const Step& s, const MotionContext& c) {
    if (s.kind() != StepKind::arc || distance(s.arc().centre, centre) > 1e-9 || s.to().z == c.from.z) return;
    turns += walk_of(s, c.from).sweep / (2 * std::numbers::pi);
    rise += s.to().z - c.from.z;
  });
  return {turns, rise};
}

TEST(Thread, PitchAndHandOfAllKinds) {
  const Circle circle{{10, 20}, mm(6)};
  for (const ThreadSide side : {ThreadSide::inside, ThreadSide::outside})
    for (const ThreadHand hand : {ThreadHand::right, ThreadHand::left})
      for (const CutDirection direction : {CutDirection::climb, CutDirection::conventional})
        for (const int teeth : {1, 4}) {
          ThreadOptions options{
              .cut = usual(10), .pitch = mm(1.25), .hand = hand, .side = side, .teeth = teeth};
          options.cut.direction = direction;
          Diagnostics diagnostics;
          const auto op = thread({circle}, thread_mill(), options, diagnostics);
          ASSERT_TRUE(op);
          const auto [turns, rise] = helices(op->path, circle.centre);
          // One pitch per turn; a right-hand thread rises counter-clockwise.
          EXPECT_NEAR(rise / turns, hand == ThreadHand::right ? 1.25 : -1.25, 1e-9);
          EXPECT_NEAR(std::abs(turns), teeth == 1 ? 8 : 2, 1e-9);
          // Inside, climb is counter-clockwise, outside clockwise.
          EXPECT_EQ(turns > 0, (direction == CutDirection::climb) == (side == ThreadSide::inside));
          double reach = 0.0, nearest = 1e9, low = 0.0;
          for (const Motion& m : motions(op->path))
            if (m.arc && distance(m.centre, circle.centre) < 1e-9)
              reach = std::max(reach, m.radius), nearest = std::min(nearest, m.radius),
              low = std::min(low, m.low());
          EXPECT_NEAR(low, -10, 1e-9);
          // The tips reach the major diameter of a hole, and 0.6134 pitches into a rod.
          if (side == ThreadSide::inside) {
            EXPECT_NEAR(reach + 3, 6, 1e-9);
          } else {
            EXPECT_NEAR(nearest - 3, 6 - 0.6134 * 1.25, 1e-9);
          }
          // Down and up beside the thread only.
          for (const Motion& m : motions(op->path))
            if (!m.arc && m.from.z != m.to.z && m.low() < 0) {
              const double d = distance(m.from.xy(), circle.centre);
              EXPECT_TRUE(side == ThreadSide::inside ? d < 1e-9 : d > 9) << d;
            }
        }
}

TEST(Thread, PassesGetDeeper) {
  ThreadOptions options{.cut = usual(5), .pitch = mm(1), .passes = 3};
  Diagnostics diagnostics;
  const auto op = thread({{{0, 0}, mm(6)}}, thread_mill(), options, diagnostics);
  ASSERT_TRUE(op);
  std::vector<double> radii;
  for (const Motion& m : motions(op->path))
    if (m.arc && distance(m.centre, {0, 0}) < 1e-9) radii.push_back(m.radius);
  ASSERT_EQ(radii.size(), 3u);
  EXPECT_LT(radii[0], radii[1]);
  EXPECT_LT(radii[1], radii[2]);
  EXPECT_NEAR(radii[2], 3, 1e-9);
}

TEST(Countersink, TheBallTouchesTheConeAndLeavesLittle) {
  const Circle circle{{5, 5}, mm(10)};
  for (const double angle : {60.0, 90.0, 120.0}) {
    CountersinkOptions options{.cut = usual(4), .angle = degrees(angle)};
    options.scallop = mm(0.05);
    Diagnostics diagnostics;
    const auto op = countersink({circle}, ball(6), options, diagnostics);
    ASSERT_TRUE(op);
    const double half = 0.5 * degrees(angle).rad();
    double last = -1.0;
    std::vector<std::pair<double, double>> balls;  // distance of the centre from the axis, height
    for (const Motion& m : motions(op->path)) {
      if (!m.arc) continue;
      EXPECT_GT(m.radius, last);  // from the inside out
      last = m.radius;
      // Distance of the ball's centre from the cone through the circle.
      const double depth = -(m.to.z + 3),
                   from_wall = (10 - m.radius - depth * std::tan(half)) * std::cos(half);
      EXPECT_NEAR(from_wall, 3, 1e-9);
      balls.emplace_back(m.radius, m.to.z + 3);
    }
    ASSERT_GT(balls.size(), 3u);
    // Points of the cone are within the scallop of a ball.
    const double lowest = std::max(10 - 4 * std::tan(half), 3 * std::cos(half)) + 0.01;
    for (double r = lowest; r < 10; r += 0.05) {
      const double z = -(10 - r) / std::tan(half);
      double left = 1e9;
      for (const auto& [at, height] : balls) left = std::min(left, std::hypot(r - at, z - height) - 3);
      EXPECT_LE(left, 0.05 + 1e-3) << r;
      EXPECT_GE(left, -1e-9) << r;
    }
  }
}

TEST(Special, BadInputIsAnError) {
  const auto code = [](auto&& call) {
    Diagnostics diagnostics;
    EXPECT_FALSE(call(diagnostics));
    return diagnostics.list().empty() ? Code{} : diagnostics.list().back().code;
  };
  const Outline line{{0, 0}, {{{50, 0}, {}}}};
  const KeyholeOptions key{.cut = usual(6), .length = mm(12)};
  EXPECT_EQ(code([&](auto& d) { return keyhole({}, keyhole_bit(), key, d); }), codes::op_empty);
  EXPECT_EQ(code([&](auto& d) {
              return keyhole({{0, 0}}, keyhole_bit(), {.cut = usual(6)}, d);
            }),
            codes::op_option);
  EXPECT_EQ(code([&](auto& d) { return keyhole({{NAN, 0}}, keyhole_bit(), key, d); }), codes::op_option);
  EXPECT_EQ(code([&](auto& d) { return slot({}, dovetail(), {.cut = usual(6)}, d); }), codes::op_empty);
  EXPECT_EQ(code([&](auto& d) { return slot({rectangle(0, 0, 9, 9)}, dovetail(), {.cut = usual(6)}, d); }),
            codes::op_option);
  const Outline far{{0, 0}, {{{2 * limits::kMaxCoordinate, 0}, {}}}};
  EXPECT_EQ(code([&](auto& d) { return slot({far}, dovetail(), {.cut = usual(6)}, d); }), codes::op_option);
  EXPECT_EQ(code([&](auto& d) { return slot({line}, dovetail(), {.cut = usual(6), .width = mm(5)}, d); }),
            codes::op_tool_wide);
  EXPECT_EQ(code([&](auto& d) { return thread({}, thread_mill(), {.cut = usual(6), .pitch = mm(1)}, d); }),
            codes::op_empty);
  EXPECT_EQ(code([&](auto& d) {
              return thread({{{0, 0}, mm(6)}}, thread_mill(), {.cut = usual(6)}, d);
            }),
            codes::op_option);
  EXPECT_EQ(code([&](auto& d) {
              return thread({{{0, 0}, mm(3.2)}}, thread_mill(), {.cut = usual(6), .pitch = mm(1)}, d);
            }),
            codes::op_tool_wide);
  EXPECT_EQ(code([&](auto& d) { return countersink({}, ball(6), {.cut = usual(3)}, d); }), codes::op_empty);
  EXPECT_EQ(code([&](auto& d) {
              return countersink({{{0, 0}, mm(5)}}, mill(6), {.cut = usual(3)}, d);
            }),
            codes::op_option);
  EXPECT_EQ(code([&](auto& d) {
              return countersink({{{0, 0}, mm(1)}}, ball(6), {.cut = usual(0.5)}, d);
            }),
            codes::op_tool_wide);
}

}  // namespace
}  // namespace kerf
