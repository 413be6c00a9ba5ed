// Volumes at walls: against exact formulas, and against a much finer run.
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "cut_jobs.h"

namespace kerf::test {
namespace {

constexpr double kPi = std::numbers::pi;
/// Permitted error of the removed volume, in pitches times the length of the outline times the depth.
constexpr double kMaxOff = 0.2;

/// An end mill number 1 of the given radius.
ToolTable end_mill(double radius) {
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {radius, 0, 0}, {radius, 15, 0}})));
  return tools;
}

Simulation simulated(const Toolpath& path, const ToolTable& tools, const Stock& stock, double pitch,
                     unsigned threads = 2) {
  Diagnostics diagnostics;
  auto result = run(path, tools, stock, pitch, diagnostics, threads);
  EXPECT_TRUE(result);
  EXPECT_NEAR(result->stock.mm3() - result->removed.mm3(), result->workpiece.volume().mm3(),
              2e-6 * result->stock.mm3());
  double sum = 0.0;
  for (const float v : result->removed_by_step) {
    EXPECT_GE(v, -1e-3f);
    sum += static_cast<double>(v);
  }
  EXPECT_NEAR(sum, result->removed.mm3(), 1e-6 * result->stock.mm3());
  return std::move(*result);
}

/// Random positions and angles, the same in every run.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() % 1000003) / 1000003;
  }

 private:
  std::mt19937 engine_;
};

class Walls : public testing::TestWithParam<double> {};  // the pitch, mm

TEST_P(Walls, SlotsOfManyWidthsPositionsAndAngles) {
  const double pitch = GetParam();
  Random random(11);
  for (int n = 0; n < 24; ++n) {
    const double r = random.between(0.8, 3.0), length = random.between(2, 9), depth = random.between(0.1, 6);
    // Along X, along Y, at 45 degrees, and at any angle.
    const double angles[] = {0, kPi / 2, kPi / 4, random.between(0, 2 * kPi)};
    const double angle = angles[n % 4];
    const Point3 from{random.between(14, 16), random.between(14, 16), -depth};
    const Point3 to = from + Point3{length * std::cos(angle), length * std::sin(angle), 0.0};
    Path path;
    path.tool(1).rapid({from.x, from.y, 5}).cut(from).cut(to);
    const Simulation result = simulated(path.path(), end_mill(r), block({0, 0, -10}, {30, 30, 0}), pitch);
    const double exact = (2 * r * length + kPi * r * r) * depth;
    const double outline = 2 * length + 2 * kPi * r;
    EXPECT_NEAR(result.removed.mm3(), exact, kMaxOff * pitch * outline * depth)
        << "radius " << r << ", " << length << " mm at " << angle << ", depth " << depth;
  }
}

TEST_P(Walls, PlungesAndRings) {
  const double pitch = GetParam();
  Random random(12);
  for (int n = 0; n < 12; ++n) {
    const double r = random.between(0.8, 2.5), ring = random.between(3, 8), depth = random.between(0.5, 12);
    const Point3 centre{random.between(14, 16), random.between(14, 16), -depth};
    const Point3 start = centre + Point3{ring, 0.0, 0.0};
    Path plunge, circle;
    plunge.tool(1).rapid({centre.x, centre.y, 5}).cut(centre);
    circle.tool(1)
        .rapid({start.x, start.y, 5})
        .cut(start)
        .arc({.to = start, .centre = {centre.x, centre.y}, .turn = Turn::ccw, .feed = mm_per_min(100)});
    const Stock stock = block({0, 0, -10}, {30, 30, 0});
    const double deep = std::min(depth, 10.0);  // some reach through the floor
    EXPECT_NEAR(simulated(plunge.path(), end_mill(r), stock, pitch).removed.mm3(), kPi * r * r * deep,
                kMaxOff * pitch * 2 * kPi * r * deep);
    EXPECT_NEAR(simulated(circle.path(), end_mill(r), stock, pitch).removed.mm3(), 4 * kPi * ring * r * deep,
                kMaxOff * pitch * 4 * kPi * ring * deep);
  }
}

TEST_P(Walls, RoofsOfAKeyholeSlotCountToo) {
  const double pitch = GetParam();
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {2, 2.5, 0}, {2, 9, 0}})));
  for (const double y : {15.0, 15.017, 15.031}) {
    Path path;  // from outside the block to its centre, the head below a roof
    path.tool(1).rapid({-6, y, 5}).rapid({-6, y, -7}).cut({18.013, y, -7});
    const Simulation result = simulated(path.path(), tools, block({0, 0, -10}, {30, 30, 0}), pitch);
    const double exact = (8 * 18.013 + 8 * kPi) * 2.5 + (4 * 18.013 + 2 * kPi) * 4.5;
    const double walls = (2 * 18.013 + 4 * kPi) * 2.5 + (2 * 18.013 + 2 * kPi) * 4.5;
    EXPECT_NEAR(result.removed.mm3(), exact, kMaxOff * pitch * walls) << y;
  }
}

TEST_P(Walls, ABorderColumnCountsByItsFraction) {
  const double pitch = GetParam();
  const Stock stock = block({0, 0, -4}, {20.013, 15.031, 0});  // the pitch does not divide it
  Path path;
  path.tool(1).rapid({20.013, -5, 5}).rapid({20.013, -5, -3}).cut({20.013, 20, -3});
  const Simulation result = simulated(path.path(), end_mill(2.111), stock, pitch);
  EXPECT_NEAR(result.removed.mm3(), 2.111 * 15.031 * 3, kMaxOff * pitch * 15.031 * 3);
}

INSTANTIATE_TEST_SUITE_P(Pitches, Walls, testing::Values(0.05, 0.1, 0.2, 0.5));

// With so many squares each has only a few points: their errors cancel.
TEST(WallsOfManySquares, AreAsExactAlongTheWholeOutline) {
  constexpr double kPitch = 0.05, kRadius = 1.0137, kDepth = 2.5;
  constexpr int kSlots = 24;
  Path path;
  path.tool(1);
  double area = 0.0, outline = 0.0;
  for (int n = 0; n < kSlots; ++n) {
    const Point3 from{3.0, 4.0 + 3.0 * n, -kDepth}, to{97.0, 4.0 + 3.0 * n + 0.61, -kDepth};
    path.rapid({from.x, from.y, 5}).cut(from).cut(to).rapid({to.x, to.y, 5});
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    area += 2 * kRadius * length + kPi * kRadius * kRadius;
    outline += 2 * length + 2 * kPi * kRadius;
  }
  const Simulation result =
      simulated(path.path(), end_mill(kRadius), block({0, 0, -4}, {100, 80, 0}), kPitch);
  EXPECT_NEAR(result.removed.mm3(), area * kDepth, 2e-3 * kPitch * outline * kDepth);
}

// The frusta of a concave arc lie on both sides of it.
TEST(Walls, AConcaveFlankHasItsVolume) {
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {0.5, 0, -kQuarter}, {2.5, 2, 0}, {2.5, 6, 0}})));
  Path path;
  path.tool(1).rapid({5, 5, 5}).cut({5, 5, -2});
  const double exact = kPi * (2.5 * 2.5 * 2 - 5 * kPi + 8 - 8.0 / 3);  // of (2.5 - sqrt(4 - z^2))^2
  const Simulation result = simulated(path.path(), tools, block({0, 0, -4}, {10, 10, 0}), 0.02);
  EXPECT_NEAR(result.removed.mm3(), exact, 3e-4 * exact);
}

/// Crossing level motions with short chords, whose walls many steps make together.
Toolpath crossing_moves(unsigned seed) {
  Random random(seed);
  Path path;
  Point3 at{10, 10, -1};
  path.tool(1).rapid({at.x, at.y, 5}).cut(at);
  for (int n = 0; n < 30; ++n) {
    at = {random.between(2, 18), random.between(2, 18), -0.5 * (1 + n % 6)};
    path.rapid({at.x, at.y, 5}).cut(at);
    const double turn = random.between(0, 2 * kPi);
    for (int k = 1; k <= 40; ++k) {
      at.x += 0.12 * std::cos(turn + 0.05 * k);
      at.y += 0.12 * std::sin(turn + 0.05 * k);
      path.cut(at);
    }
  }
  return path.path();
}

TEST(WallsOfManySteps, AgreeWithAFinerRun) {
  const Stock stock = block({0, 0, -5}, {20, 20, 0});
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Toolpath path = crossing_moves(seed);
    const double coarse = simulated(path, end_mill(1.2), stock, 0.32).removed.mm3();
    const double fine = simulated(path, end_mill(1.2), stock, 0.02).removed.mm3();
    EXPECT_NEAR(coarse, fine, 2e-3 * fine) << seed;
  }
}

TEST(WallsOfManySteps, AreTheSameForAnyNumberOfThreads) {
  const Stock stock = block({0, 0, -5}, {20, 20, 0});
  const Toolpath path = crossing_moves(4);
  const Simulation one = simulated(path, end_mill(1.2), stock, 0.1, 1);
  for (const unsigned threads : {2u, 5u}) {
    const Simulation more = simulated(path, end_mill(1.2), stock, 0.1, threads);
    EXPECT_EQ(one.removed, more.removed);
    EXPECT_EQ(one.removed_by_step, more.removed_by_step);
    EXPECT_EQ(one.workpiece.volume(), more.workpiece.volume());
  }
}

}  // namespace
}  // namespace kerf::test
