// The rotary simulator against solids of known volume.
#include "kerf/sim/rotary.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "../path/jobs.h"
#include "base/codes/sim.h"

namespace kerf::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Toolpaths with an A axis.
class RotaryPath {
 public:
  RotaryPath& tool(int number) { return path_.add(step::ToolChange{number}, here_), *this; }
  RotaryPath& spindle(SpindleTurn turn) { return path_.add(step::Spindle{rpm(9000), turn}, here_), *this; }
  RotaryPath& rapid(Point3 to, double a = 0.0) { return turned(path_.add(step::Rapid{to}, here_), a); }
  RotaryPath& cut(Point3 to, double a = 0.0) {
    return turned(path_.add(step::Cut{to, mm_per_min(500)}, here_), a);
  }
  RotaryPath& arc(Point3 to, Point2 centre) {
    return turned(path_.add(step::Arc{.to = to, .centre = centre, .feed = mm_per_min(500)}, here_), 0.0);
  }
  /// X and Y are unknown from the first motion on.
  RotaryPath& lost() {
    for (std::size_t i = 0; i < path_.size(); ++i)
      if (path_[i].is_motion()) path_.set_unknown_axes(i, 3);
    return *this;
  }
  const Toolpath& path() const { return path_; }

 private:
  RotaryPath& turned(std::size_t i, double a) {
    path_.set_extra(i, {std::array{a, 0.0, 0.0}, {}});
    return *this;
  }
  Toolpath path_;
  OriginId here_ = OriginId::none;
};

ToolTable one_tool(Profile cutting) {
  ToolTable tools;
  tools.set(1, make_drawn(1, std::move(cutting)));
  return tools;
}
ToolTable square(double radius) { return one_tool(profile({{0, 0, 0}, {radius, 0, 0}, {radius, 60, 0}})); }

const RoundBar kBar{20, 0, 30, 0, 0};

std::optional<RotarySimulation> run(const RotaryPath& path, const ToolTable& tools, double pitch,
                                    Diagnostics& diagnostics, unsigned threads = 1) {
  SimulationOptions options;
  options.resolution = mm(pitch);
  options.threads = threads;
  return simulate_rotary(path.path(), tools, kBar, options, diagnostics);
}

/// The area of a disc segment beyond a chord at distance `h` from the centre.
double cap_area(double r, double h) { return r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h); }

TEST(Rotary, AnUntouchedBar) {
  RotaryPath path;
  path.tool(1).rapid({0, 0, 20}).rapid({30, 0, 20}, 400);
  Diagnostics diagnostics;
  const auto result = run(path, square(3), 0.2, diagnostics);
  ASSERT_TRUE(result && diagnostics.list().empty());
  EXPECT_NEAR(result->stock.mm3(), kPi * 100 * 30, 1e-2);
  EXPECT_EQ(result->removed.mm3(), 0.0);
  EXPECT_TRUE(result->hazards.empty());
}

TEST(Rotary, AnArcFromAnUnknownPositionIsCutFromXZeroYZero) {
  double removed[2] = {};
  for (const bool lost : {false, true}) {
    RotaryPath path;
    path.tool(1).rapid({0, 0, 20}).cut({0, 0, 9}).arc({0, 0, 9}, {8, 0});
    if (lost) path.lost();
    Diagnostics diagnostics;
    const auto result = run(path, square(3), 0.2, diagnostics);
    ASSERT_TRUE(result);
    removed[lost ? 1 : 0] = result->removed.mm3();
  }
  EXPECT_GT(removed[0], 50.0);
  EXPECT_EQ(removed[1], removed[0]);
}

TEST(Rotary, AFlatByIndexing) {
  // A wide tool faces one side at Z7; then, after half a turn of the bar, the other side.
  RotaryPath path;
  path.tool(1)
      .rapid({-20, 0, 20})
      .rapid({-20, 0, 7})
      .cut({50, 0, 7})
      .rapid({50, 0, 20})
      .rapid({50, 0, 20}, 180);
  path.rapid({50, 0, 7}, 180).cut({-20, 0, 7}, 180);
  Diagnostics diagnostics;
  const auto result = run(path, square(15), 0.1, diagnostics);
  ASSERT_TRUE(result && diagnostics.list().empty());
  const double exact = 2 * cap_area(10, 7) * 30;
  EXPECT_NEAR(result->removed.mm3(), exact, 2e-3 * exact);
  EXPECT_NEAR(result->workpiece.volume().mm3(), result->stock.mm3() - result->removed.mm3(), 1e-2);
  EXPECT_TRUE(result->hazards.empty());
  const auto& up = result->workpiece.rays[result->workpiece.along / 2];  // nearly A0
  ASSERT_EQ(up.size(), 1u);
  EXPECT_NEAR(static_cast<double>(up[0].high), 7.0, 0.01);
  EXPECT_EQ(up[0].high_step, 3u);
}

TEST(Rotary, IndexedHolesComeFromTheirSides) {
  RotaryPath path;
  path.tool(1).rapid({10, 0, 20});
  for (const double a : {0.0, 90.0})
    path.rapid({10 + a / 10, 0, 20}, a).cut({10 + a / 10, 0, 4}, a).rapid({10 + a / 10, 0, 20}, a);
  Diagnostics diagnostics;
  const auto result = run(path, square(2), 0.05, diagnostics);
  ASSERT_TRUE(result);
  // Each hole reaches from the surface sqrt(100 - y^2) down to 4.
  double exact = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double y = -2 + 4 * (k + 0.5) / 2000;
    exact += 2 * 2 * std::sqrt(4 - y * y) * (std::sqrt(100 - y * y) - 4) * 4 / 2000;
  }
  EXPECT_NEAR(result->removed.mm3(), exact, 5e-3 * exact);
  // A90 moves the tool from Z+ to Y-, which is ray number around / 4.
  const auto& side = result->workpiece.rays[static_cast<std::size_t>(result->workpiece.around / 4) *
                                                static_cast<std::size_t>(result->workpiece.along) +
                                            static_cast<std::size_t>(19 / result->workpiece.dx)];
  EXPECT_NEAR(static_cast<double>(side.back().high), 4.0, 0.02);
}

TEST(Rotary, TurningWhileCuttingMakesAGroove) {
  // A square tool of 4 mm at rest at Z8 while the bar makes one turn: a groove with a round floor; below a
  // tool of that width it would be a polygon, but the tool extends beyond the line of the axis.
  RotaryPath path;
  path.tool(1).rapid({15, 0, 20}).cut({15, 0, 8}).cut({15, 0, 8}, 360);
  Diagnostics diagnostics;
  const auto result = run(path, square(2), 0.1, diagnostics);
  ASSERT_TRUE(result && diagnostics.list().empty());
  // At distance dx from its centre the tool is 2 sqrt(4 - dx^2) wide, and the centre of its bottom is nearest
  // to the axis: 8. So every ray within 2 mm is cut to 8.
  const double exact = kPi * (100 - 64) * 4;
  EXPECT_NEAR(result->removed.mm3(), exact, 5e-3 * exact);
  double lowest = 100, highest = 0;
  for (int j = 0; j < result->workpiece.around; ++j) {
    const auto& ray =
        result->workpiece
            .rays[static_cast<std::size_t>(j) * static_cast<std::size_t>(result->workpiece.along) +
                  static_cast<std::size_t>(15 / result->workpiece.dx)];
    lowest = std::min(lowest, static_cast<double>(ray.back().high));
    highest = std::max(highest, static_cast<double>(ray.back().high));
  }
  EXPECT_NEAR(lowest, 8.0, 1e-3);
  EXPECT_NEAR(highest, 8.0, 2e-3);
}

TEST(Rotary, ABallFollowsAHelix) {
  RotaryPath path;
  path.tool(1).rapid({5, 0, 20}).cut({5, 0, 9}).cut({25, 0, 9}, 720);
  Diagnostics diagnostics;
  const ToolTable ball = one_tool(profile({{0, 0, kQuarter}, {1.5, 1.5, 0}, {1.5, 12, 0}}));
  const auto coarse = run(path, ball, 0.1, diagnostics), fine = run(path, ball, 0.05, diagnostics);
  ASSERT_TRUE(coarse && fine);
  EXPECT_NEAR(coarse->removed.mm3(), fine->removed.mm3(), 5e-3 * fine->removed.mm3());
  // A groove 1 mm deep by a ball of 1.5: approximately the area of a segment times the path of its centroid.
  const double segment = cap_area(1.5, 0.5), way = std::hypot(20.0, 4 * kPi * 9.4);
  EXPECT_NEAR(fine->removed.mm3(), segment * way, 0.05 * segment * way);
}

/// A convex tool by its half outline: the height of its surface above the tip at a distance from its axis.
struct Cutter {
  const char* name;
  Profile outline;
  double rim;
  double (*height)(double);
};
const std::vector<Cutter>& cutters() {
  static const double cot = std::sqrt(3.0);
  static const std::vector<Cutter> all{
      {"square", profile({{0, 0, 0}, {2, 0, 0}, {2, 30, 0}}), 2.0, [](double) { return 0.0; }},
      {"bull nose", profile({{0, 0, 0}, {1.5, 0, kQuarter}, {2.5, 1, 0}, {2.5, 30, 0}}), 2.5,
       [](double u) { return u < 1.5 ? 0.0 : 1 - std::sqrt(1 - (u - 1.5) * (u - 1.5)); }},
      {"ball", profile({{0, 0, kQuarter}, {3, 3, 0}, {3, 30, 0}}), 3.0,
       [](double u) { return 3 - std::sqrt(9 - u * u); }},
      {"vee", profile({{0, 0, 0}, {6, 6 * cot, 0}, {6, 30, 0}}), 6.0, [](double u) { return u * cot; }}};
  return all;
}

/// Tools whose flutes are hollow, by the height of their lowest point at a distance from the axis.
const std::vector<Cutter>& hollow_cutters() {
  static const std::vector<Cutter> all{
      {"roundover", profile({{0, 0, 0}, {0.5, 0, -kQuarter}, {2.5, 2, 0}, {2.5, 30, 0}}), 2.5,
       [](double u) { return u < 0.5 ? 0.0 : std::sqrt(4 - (2.5 - u) * (2.5 - u)); }},
      {"cove and fillet",
       profile(
           {{0, 0, 0}, {0.5, 0, -kQuarter}, {1.5, 1, 0}, {1.5, 1.2, kQuarter}, {2.5, 2.2, 0}, {2.5, 30, 0}}),
       2.5, [](double u) {
         if (u < 0.5) return 0.0;
         return u < 1.5 ? std::sqrt(1 - (1.5 - u) * (1.5 - u)) : 2.2 - std::sqrt(1 - (u - 1.5) * (u - 1.5));
       }}};
  return all;
}

/// The integral of twice `f` over the radius of a tool, by the midpoint rule.
template <class F>
double both_sides(const Cutter& cutter, const F& f) {
  constexpr int kSlices = 100000;
  double sum = 0.0;
  for (int k = 0; k < kSlices; ++k) sum += f(cutter.rim * (k + 0.5) / kSlices);
  return 2.0 * sum * cutter.rim / kSlices;
}

/// Bar of 40 mm, 60 mm long: what is removed at a distance of rays; 0 is the default, 0.27 mm.
double removed_of(const RotaryPath& path, const Cutter& cutter, double pitch) {
  SimulationOptions options;
  options.resolution = mm(pitch);
  Diagnostics diagnostics;
  const auto result =
      simulate_rotary(path.path(), one_tool(cutter.outline), {40, 0, 60, 0, 0}, options, diagnostics);
  if (!result) return 0.0;
  EXPECT_NEAR(result->workpiece.volume().mm3(), result->stock.mm3() - result->removed.mm3(), 0.02);
  double steps = 0.0;
  for (const float volume : result->removed_by_step) steps += static_cast<double>(volume);
  EXPECT_NEAR(steps, result->removed.mm3(), 1e-5 * steps);
  return result->removed.mm3();
}

constexpr double kDistances[] = {0.0, 0.4, 0.15};

TEST(Rotary, RingsHaveTheirVolume) {
  for (const Cutter& cutter : cutters()) {
    for (const double z : {15.0, 18.5}) {
      RotaryPath path;
      path.tool(1).rapid({30.1, 0, 30}).cut({30.1, 0, z}).cut({30.1, 0, z}, 360);
      // The tool is nearest to the axis in the plane through it, so the floor is its outline.
      const double exact = both_sides(cutter, [&](double u) {
        const double floor = z + cutter.height(u);
        return floor < 20 ? kPi * (400 - floor * floor) : 0.0;
      });
      for (const double pitch : kDistances)
        EXPECT_NEAR(removed_of(path, cutter, pitch), exact, 3e-3 * exact)
            << cutter.name << " at " << z << ", " << pitch << " mm";
    }
  }
}

/// The flank of a square tool beside the bar, with its bottom below the axis, is the floor of a ring.
TEST(Rotary, ARingFromTheSideHasItsVolume) {
  const Cutter wide{"wide", profile({{0, 0, 0}, {3, 0, 0}, {3, 30, 0}}), 3.0, [](double) { return 0.0; }};
  const double exact = both_sides(wide, [](double u) {
    const double floor = 18 - std::sqrt(9 - u * u);
    return floor < 20 ? kPi * (400 - floor * floor) : 0.0;
  });
  for (const double side : {1.0, -1.0}) {
    RotaryPath path;
    path.tool(1).rapid({30.1, 40 * side, 30}).rapid({30.1, 40 * side, -4}).cut({30.1, 18 * side, -4});
    path.cut({30.1, 18 * side, -4}, 360);
    for (const double pitch : kDistances)
      EXPECT_NEAR(removed_of(path, wide, pitch), exact, 3e-3 * exact) << side << ", " << pitch;
  }
}

TEST(Rotary, GroovesAlongTheBarHaveTheirVolume) {
  for (const Cutter& cutter : cutters()) {
    RotaryPath path;
    path.tool(1).rapid({-10, 1.3, 30}, 31).rapid({-10, 1.3, 17}, 31).cut({70, 1.3, 17}, 31);
    double exact = 0.0;
    for (const double side : {1.0, -1.0})
      exact += 0.5 * both_sides(cutter, [&](double u) {
                 const double y = 1.3 + side * u;
                 return 60 * std::max(std::sqrt(400 - y * y) - 17 - cutter.height(u), 0.0);
               });
    for (const double pitch : kDistances)
      EXPECT_NEAR(removed_of(path, cutter, pitch), exact, 3e-3 * exact) << cutter.name << ", " << pitch;
  }
}

/// A turn more of a helix removes its steady section, whatever the ends of the groove are. At a distance s
/// along the bar from the tool, the section has the lowest of all points of the tool that pass there while
/// the bar turns.
void expect_helix(const Cutter& cutter, const std::vector<double>& pitches) {
  constexpr double kLead = 16.0, kDepthZ = 18.0;
  const auto floor = [&](double s) {
    double lowest = 20.0;
    for (int k = -800; k <= 800; ++k) {
      const double angle = k * 0.2 / 800, along = s - kLead * angle / (2 * kPi);
      // The lowest r with r cos(angle) at the height of the tool there; that depends on r sin(angle).
      double r = lowest;
      const auto is_inside = [&](double at) {
        const double u = std::hypot(along, at * std::sin(angle));
        return u < cutter.rim && at * std::cos(angle) >= kDepthZ + cutter.height(u);
      };
      if (!is_inside(r)) continue;
      double outside = kDepthZ - 1e-9;
      for (int n = 0; n < 30; ++n) {
        const double centre = 0.5 * (r + outside);
        (is_inside(centre) ? r : outside) = centre;
      }
      lowest = std::min(lowest, r);
    }
    return lowest;
  };
  constexpr int kSlices = 3000;
  double exact = 0.0;
  for (int k = 0; k < kSlices; ++k) {
    const double r = floor(3.5 * (2.0 * (k + 0.5) / kSlices - 1.0));
    exact += kPi * (400 - r * r) * 7.0 / kSlices;
  }
  for (const double pitch : pitches) {
    double removed[2];
    for (const int turns : {1, 2}) {
      RotaryPath path;
      path.tool(1).rapid({10, 0, 30}).cut({10, 0, kDepthZ});
      path.cut({10 + kLead * turns, 0, kDepthZ}, 360.0 * turns);
      removed[turns - 1] = removed_of(path, cutter, pitch);
    }
    EXPECT_NEAR(removed[1] - removed[0], exact, 3e-3 * exact) << cutter.name << ", " << pitch;
  }
}

TEST(Rotary, AHelicalGrooveHasItsVolume) {
  expect_helix(cutters()[1], {std::begin(kDistances), std::end(kDistances)});
  expect_helix(hollow_cutters()[0], {0.4});
}

/// Passes along the whole bar, three degrees apart: the floor is a row of flats, its sides are those of the
/// first and the last pass.
TEST(Rotary, AWrappedPocketHasItsVolume) {
  constexpr int kPasses = 21;
  constexpr double kStep = 3.0 * kPi / 180;
  RotaryPath path;
  path.tool(1).rapid({-10, 0, 30});
  for (int k = 0; k < kPasses; ++k) {
    const double from = k % 2 == 0 ? -10 : 70;
    path.rapid({from, 0, 30}, 3.0 * k).rapid({from, 0, 18}, 3.0 * k).cut({60 - from, 0, 18}, 3.0 * k);
    path.rapid({60 - from, 0, 30}, 3.0 * k);
  }
  // Between passes: triangles of height 18 on half a step on each side; at each end half a groove of 2 mm.
  const double between = (kPasses - 1) * (0.5 * 400 * kStep - 18 * 18 * std::tan(0.5 * kStep));
  double half_groove = 0.0;
  for (int n = 0; n < 10000; ++n) {
    const double y = 2 * (n + 0.5) / 10000;
    half_groove += (std::sqrt(400 - y * y) - 18) * 2 / 10000;
  }
  const double exact = 60 * (between + 2 * half_groove);
  for (const double pitch : kDistances)
    EXPECT_NEAR(removed_of(path, cutters()[0], pitch), exact, 3e-3 * exact) << pitch;
}

TEST(Rotary, ABarIsCutToASquare) {
  RotaryPath path;
  path.tool(1).rapid({-20, 0, 30});
  for (const double a : {0.0, 90.0, 180.0, 270.0})
    path.rapid({-20, 0, 30}, a).rapid({-20, 0, 12}, a).cut({80, 0, 12}, a).rapid({80, 0, 30}, a);
  // The corners of a square of 24 mm are inside the circle of 40.
  const Cutter wide{"wide", profile({{0, 0, 0}, {17, 0, 0}, {17, 30, 0}}), 17.0, [](double) { return 0.0; }};
  const double exact = 60 * (kPi * 400 - 24 * 24);
  for (const double pitch : kDistances)
    EXPECT_NEAR(removed_of(path, wide, pitch), exact, 3e-3 * exact) << pitch;
}

/// A pass in one motion and in many short ones leave the same.
TEST(Rotary, ShortMotionsRemoveWhatALongOneDoes) {
  for (const Cutter& cutter : cutters()) {
    double removed[2];
    for (const int count : {1, 150}) {
      RotaryPath path;
      path.tool(1).rapid({10, -3, 30}).cut({10, -3, 17});
      for (int k = 1; k <= count; ++k)
        path.cut({10 + 30.0 * k / count, -3 + 5.0 * k / count, 17 + 1.5 * k / count}, 200.0 * k / count);
      removed[count == 1 ? 0 : 1] = removed_of(path, cutter, 0.3);
    }
    EXPECT_NEAR(removed[1], removed[0], 1e-3 * removed[0]) << cutter.name;
  }
}

TEST(Rotary, HazardsAreReported) {
  ToolTable tools = square(2);
  Tool tool = make_drawn(1, profile({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}}));
  tool.silhouette.shank = profile({{4, 3, 0}, {4, 40, 0}});
  tools.set(1, tool);
  RotaryPath path;
  path.tool(1).rapid({15, 0, 20}).rapid({15, 0, 9}).rapid({15, 0, 20});  // 1 mm into the bar
  path.rapid({5, 0, 20}).cut({5, 0, 5});                                 // 5 deep with a flute of 3
  Diagnostics diagnostics;
  const auto result = run(path, tools, 0.1, diagnostics);
  ASSERT_TRUE(result);
  std::vector<std::pair<HazardKind, std::uint32_t>> found;
  for (const Hazard& h : result->hazards) found.emplace_back(h.kind, h.step);
  const std::vector<std::pair<HazardKind, std::uint32_t>> expected{{HazardKind::rapid_in_stock, 2},
                                                                   {HazardKind::shank_contact, 5}};
  EXPECT_EQ(found, expected);
  EXPECT_NEAR(result->hazards[0].depth.mm(), 1.0, 0.02);
  EXPECT_NEAR(result->hazards[0].at.z, 10.0, 0.05);
  EXPECT_NEAR(result->hazards[1].depth.mm(), 2.0, 0.02);
}

TEST(Rotary, RapidsThroughTheBarAreReported) {
  // Above, at and below the axis, and with the flutes below the bar; a tool of 4 mm with a flute of 5.
  const ToolTable tools = one_tool(profile({{0, 0, 0}, {2, 0, 0}, {2, 5, 0}}));
  for (const double z : {9.0, 1.0, 0.0, -3.0, -10.0, -40.0}) {
    RotaryPath path;
    path.tool(1).rapid({15, -30, z}).rapid({15, 30, z});
    Diagnostics diagnostics;
    const auto result = run(path, tools, 0.2, diagnostics);
    ASSERT_TRUE(result);
    ASSERT_EQ(result->hazards.size(), 1u) << z;
    EXPECT_EQ(result->hazards[0].kind, HazardKind::rapid_in_stock);
    EXPECT_EQ(result->hazards[0].step, 2u);
    EXPECT_NEAR(result->hazards[0].depth.mm(), std::min(10.0 - z, 10.0), 0.03) << z;
    const double exact = 4 * (z <= -10 ? kPi * 100 : cap_area(10, z));
    EXPECT_NEAR(result->removed.mm3(), exact, 0.03 * exact) << z;
  }
}

TEST(Rotary, NearMissesAndGrazes) {
  // A hundredth above and into the top of the bar, and a ray distance beside and into its side.
  struct Limit {
    const char* name;
    double y, z;  // of the tip at the limit
    double step;
    bool is_rapid;
  };
  const ToolTable tools = one_tool(profile({{0, 0, 0}, {2, 0, 0}, {2, 5, 0}}));
  for (const Limit& limit :
       {Limit{"rapid over it", 0, 10, 0.01, true}, Limit{"rapid beside it", 12, -4, 0.1, true},
        Limit{"rapid beside it, above the flutes", 12, -30, 0.1, true},
        Limit{"spindle off, over it", 0, 10, 0.01, false}}) {
    for (const double beyond : {-limit.step, 0.0, limit.step}) {
      SCOPED_TRACE(testing::Message() << limit.name << " " << beyond);
      const bool over = limit.y == 0;
      const Point3 from{-10, limit.y - (over ? 0 : beyond), limit.z - (over ? beyond : 0)};
      const Point3 to{40, from.y, from.z};
      RotaryPath path;
      path.tool(1).spindle(limit.is_rapid ? SpindleTurn::cw : SpindleTurn::off).rapid({-10, 0, 40});
      path.rapid(from);
      limit.is_rapid ? path.rapid(to) : path.cut(to);
      Diagnostics diagnostics;
      const auto result = run(path, tools, 0.1, diagnostics);
      ASSERT_TRUE(result);
      ASSERT_EQ(result->hazards.size(), beyond > 0 ? 1u : 0u);
      if (beyond <= 0) continue;
      EXPECT_EQ(result->hazards[0].kind,
                limit.is_rapid ? HazardKind::rapid_in_stock : HazardKind::spindle_off);
      if (over) {
        EXPECT_NEAR(result->hazards[0].depth.mm(), 0.01, 1e-3);
      }
    }
  }
}

TEST(Rotary, ACutAboveTheFlutesIsReported) {
  RotaryPath path;
  path.tool(1).rapid({-5, 0, 20}).rapid({-5, 0, 5}).cut({10, 0, 5});
  Diagnostics diagnostics;
  const auto result = run(path, one_tool(profile({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}})), 0.1, diagnostics);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->hazards.size(), 1u);
  EXPECT_EQ(result->hazards[0].kind, HazardKind::over_flute);
  EXPECT_NEAR(result->hazards[0].depth.mm(), 2.0, 0.03);
}

TEST(Rotary, TheSameWithAnyNumberOfThreads) {
  RotaryPath path;
  path.tool(1).rapid({5, 0, 20}).cut({5, 1, 9}).cut({25, -3, 6}, 720).rapid({5, 0, 7}, 400);
  Diagnostics diagnostics;
  const auto a = run(path, square(2), 0.2, diagnostics, 1), b = run(path, square(2), 0.2, diagnostics, 3);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->removed.mm3(), b->removed.mm3());
  EXPECT_EQ(a->removed_by_step, b->removed_by_step);
  ASSERT_EQ(a->hazards.size(), b->hazards.size());
}

TEST(Rotary, TheMeshIsClosedAndHasTheVolume) {
  RotaryPath path;
  path.tool(1)
      .rapid({5, 0, 20})
      .cut({5, 0, 9})
      .cut({25, 0, 7}, 720)
      .rapid({15, 0, 20}, 720)
      .cut({15, 0, -20}, 765);
  Diagnostics diagnostics;
  const auto result = run(path, square(2), 0.15, diagnostics);
  ASSERT_TRUE(result);
  const MeshCheck check = check_mesh(extract_mesh(result->workpiece));
  EXPECT_EQ(check.bad_edges, 0u);
  EXPECT_NEAR(check.volume.mm3(), result->workpiece.volume().mm3(), 5e-3 * check.volume.mm3());
  const VolumeRange range = mesh_volume(result->workpiece);
  // The mesh is that of the rays, which find the walls to half a distance.
  const double of_rays = result->workpiece.volume().mm3() - result->workpiece.wall_volume;
  EXPECT_NEAR(range.expected.mm3(), of_rays, 1e-6 * check.volume.mm3());
  EXPECT_NEAR(check.volume.mm3(), range.expected.mm3(), range.tolerance.mm3());
  EXPECT_LT(range.tolerance.mm3(), 0.2 * check.volume.mm3());
}

/// A plunge from an unknown height with a keyhole cutter, whose neck is thinner than its head, into bars
/// above and below Z0: the head comes from the bar's top.
TEST(Rotary, APlungeFromAnUnknownHeightStartsAtTheBarsTop) {
  const ToolTable keyhole = one_tool(profile({{0, 0, 0}, {4, 0, 0}, {4, 2.5, 0}, {2, 2.5, 0}, {2, 60, 0}}));
  // The volume within 4 mm of the tool's axis and above Z-5, in a bar of 20 mm along X.
  double exact = 0.0;
  constexpr int kSlices = 4000;
  for (int i = 0; i < kSlices; ++i) {
    const double y = -4 + 8 * (i + 0.5) / kSlices;
    exact += 8.0 / kSlices * 2 * std::sqrt(16 - y * y) * (std::sqrt(100 - y * y) + 5);
  }
  for (const double axis_z : {0.0, 30.0, -30.0}) {
    RoundBar bar = kBar;
    bar.axis_z = axis_z;
    SimulationOptions options;
    options.resolution = mm(0.1);
    Diagnostics diagnostics;
    Toolpath from_nowhere;
    from_nowhere.add(step::ToolChange{1}, OriginId::none);
    const std::size_t over = from_nowhere.add(step::Rapid{{15, 0, 0}}, OriginId::none);
    from_nowhere.set_unknown_axes(over, 4);
    from_nowhere.add(step::Cut{{15, 0, axis_z - 5}, mm_per_min(500)}, OriginId::none);
    const auto result = simulate_rotary(from_nowhere, keyhole, bar, options, diagnostics);
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->removed.mm3(), exact, 0.01 * exact) << axis_z;
  }
}

/// Rings of radius 10 and 4 in turn, one ray wide: the walls between them are as wide as the rays, so the
/// mesh may have the volume of neither.
TEST(Rotary, TheToleranceOfTheVolumeHasTheWallsAcrossTheAxis) {
  RotaryWorkpiece work;
  work.bar = kBar;
  work.along = 60;
  work.around = 90;
  work.dx = 0.5;
  for (int j = 0; j < work.around; ++j)
    for (int i = 0; i < work.along; ++i) work.rays.push_back({{0.0f, i % 2 == 0 ? 10.0f : 4.0f, 1, 1}});
  const VolumeRange range = mesh_volume(work);
  EXPECT_NEAR(range.expected.mm3(), kPi * (100 + 16) * 15, 1e-6 * range.expected.mm3());
  // 59 rings of the area between the circles, each off by a pitch: the larger one of 0.5 mm and the arc.
  const double walls = 59 * kPi * (100 - 16), pitch = std::max(0.5, 10 * 2 * kPi / 90);
  EXPECT_GE(range.tolerance.mm3(), walls * pitch);
  EXPECT_LE(range.tolerance.mm3(), 1.2 * walls * pitch);
  EXPECT_NEAR(check_mesh(extract_mesh(work)).volume.mm3(), range.expected.mm3(), range.tolerance.mm3());
}

double area(const Mesh& mesh, std::size_t triangle) {
  std::array<Point3, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* const at = mesh.positions.data() + std::size_t{3} * mesh.triangles[3 * triangle + k];
    p[k] = {at[0], at[1], at[2]};
  }
  return 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
}

/// Every edge has two triangles, in opposite directions, and no triangle is without area.
void expect_valid(const RotarySimulation& result) {
  const Mesh mesh = extract_mesh(result.workpiece);
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(check.bad_edges, 0u);
  for (std::size_t t = 0; t < mesh.step.size(); ++t)
    EXPECT_GT(area(mesh, t), 1e-10) << t << " of " << mesh.step.size();
  const VolumeRange range = mesh_volume(result.workpiece);
  EXPECT_NEAR(check.volume.mm3(), range.expected.mm3(), range.tolerance.mm3());
}

/// The area of a prism: its lateral face and its ends. The axis and the seam add none.
TEST(Rotary, TheMeshHasNoFacesInside) {
  Diagnostics diagnostics;
  RotaryPath path;
  path.tool(1).rapid({-10, 0, 20}).rapid({-5, 0, 20});
  const auto result = run(path, square(2), 0.25, diagnostics);
  ASSERT_TRUE(result);
  expect_valid(*result);
  const Mesh mesh = extract_mesh(result->workpiece);
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.step.size(); ++t) sum += area(mesh, t);
  const double r = 0.5 * kBar.diameter, long_side = kBar.x_high - kBar.x_low;
  EXPECT_NEAR(sum, 2.0 * kPi * r * (r + long_side), 1e-3 * sum);
}

TEST(Rotary, MeshesOfRandomJobsAreValid) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int job = 0; job < 30; ++job) {
    RotaryPath path;
    path.tool(1);
    double a = between(-90, 90);
    for (int cut = 0; cut < 6; ++cut) {
      path.rapid({between(-2, 32), between(-6, 6), 20}, a);
      path.cut({between(-2, 32), between(-6, 6), job % 3 == 0 ? 0.0 : between(-8, 9)}, a);
      if (cut % 2 == 0) a += between(-400, 400);
      path.cut({between(-2, 32), between(-6, 6), job % 3 == 0 ? 0.0 : between(-8, 9)}, a);
      path.rapid({15, 0, 20}, a);
    }
    Diagnostics diagnostics;
    const auto result = run(path, square(between(0.5, 3)), between(0.3, 0.7), diagnostics);
    ASSERT_TRUE(result);
    SCOPED_TRACE(job);
    expect_valid(*result);
  }
}

/// A tool that stops at the end of a turning cut and retracts from there touches nothing: its flutes have
/// been there.
TEST(Rotary, ARapidFromTheEndOfATurningCutIsNoHazard) {
  RotaryPath path;
  path.tool(1).rapid({32.42, -5.86, 30}, -62.47).cut({32.42, -5.86, 4.55}, -62.47);
  path.cut({6, 1.39, 9.54}, -270.42).rapid({6, 1.39, 30}, -270.42);
  SimulationOptions options;
  for (const double pitch : {0.15, 0.3}) {
    options.resolution = mm(pitch);
    Diagnostics diagnostics;
    const auto result = simulate_rotary(path.path(), square(3), {40, 0, 60, 0, 0}, options, diagnostics);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->hazards.empty()) << pitch;
  }
}

/// The flutes have cut all of the way back, with tools of all shapes.
TEST(Rotary, ARapidBackOverATurningCutIsNoHazard) {
  for (const NamedProfile& shape : all_profiles()) {
    std::mt19937 random(1);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    Profile cutting = shape.profile;
    const double shaft = cutting.knots.back().r;
    cutting.knots.push_back({shaft, 80, 0});
    for (int job = 0; job < 2; ++job) {
      RotaryPath path;
      std::vector<std::pair<Point3, double>> points;
      double a = between(-90, 90);
      for (int k = 0; k < 3; ++k) {
        const double x = between(-2, 32), y = between(-8, 8), z = between(-6, 9);
        points.emplace_back(Point3{x, y, z}, a);
        a += job == 0 ? between(-60, 60) : between(-300, 300);
      }
      path.tool(1).rapid({points[0].first.x, points[0].first.y, 90}, points[0].second);
      for (const auto& [to, turn] : points) path.cut(to, turn);
      for (std::size_t k = points.size() - 1; k-- > 0;) path.rapid(points[k].first, points[k].second);
      path.rapid({points[0].first.x, points[0].first.y, 90}, points[0].second);
      // The same way 0.05 mm lower is through material.
      RotaryPath lower;
      lower.tool(1).rapid({points[0].first.x, points[0].first.y, 90}, points[0].second);
      for (const auto& [to, turn] : points) lower.cut(to, turn);
      lower.rapid({points[1].first.x, points[1].first.y, points[1].first.z - 0.05}, points[1].second);
      Diagnostics diagnostics;
      const auto back = run(path, one_tool(cutting), 1.5, diagnostics);
      const auto deeper = run(lower, one_tool(cutting), 1.5, diagnostics);
      ASSERT_TRUE(back && deeper);
      EXPECT_TRUE(back->hazards.empty()) << shape.name << ", " << job;
      ASSERT_EQ(deeper->hazards.size(), 1u) << shape.name << ", " << job;
      EXPECT_EQ(deeper->hazards[0].kind, HazardKind::rapid_in_stock);
    }
  }
}

/// A ring by a tool over the axis has the tool's outline as its section.
TEST(Rotary, RingsOfHollowToolsHaveTheirProfile) {
  for (const Cutter& cutter : hollow_cutters()) {
    RotaryPath path;
    path.tool(1).rapid({15, 0, 30}).cut({15, 0, 7.5}).cut({15, 0, 7.5}, 360);
    const double exact = both_sides(cutter, [&](double u) {
      const double floor = 7.5 + cutter.height(u);
      return floor < 10 ? kPi * (100 - floor * floor) : 0.0;
    });
    Diagnostics diagnostics;
    const auto result = run(path, one_tool(cutter.outline), 0.3, diagnostics);
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->removed.mm3(), exact, 3e-3 * exact) << cutter.name;
    const RotaryWorkpiece& work = result->workpiece;
    for (std::size_t n = 0; n < work.rays.size(); ++n) {
      const double x =
          work.bar.x_low + (static_cast<double>(n % static_cast<std::size_t>(work.along)) + 0.5) * work.dx;
      // Chords of the outline are within a micron of it, which is more in height where it is steep.
      const auto floor = [&](double u) {
        return u < cutter.rim ? std::min(7.5 + cutter.height(u), 10.0) : 10.0;
      };
      const double found = static_cast<double>(work.rays[n].back().high), u = std::abs(x - 15);
      ASSERT_GT(found, floor(std::max(u - 2e-3, 0.0)) - 2e-3) << cutter.name << " at " << x;
      ASSERT_LT(found, floor(u + 2e-3) + 2e-3) << cutter.name << " at " << x;
    }
  }
}

TEST(Rotary, TheDefaultDistanceDependsOnTheBar) {
  struct Case {
    RoundBar bar;
    double distance;
  };
  // sqrt(length * girth / 100,000), limited to 0.02 to 1 mm; of huge bars sqrt(length * girth / 4,000,000)
  for (const Case& c :
       {Case{{10, 0, 60, 0, 0}, 0.1373}, Case{{40, 0, 100, 0, 0}, 0.3545}, Case{{1, 0, 5, 0, 0}, 0.02},
        Case{{300, 0, 2000, 0, 0}, 1.0}, Case{{10000, 0, 10000, 0, 0}, 8.862}}) {
    RotaryPath path;
    path.tool(1).rapid({0, 0, 6000});
    Diagnostics diagnostics;
    const auto result = simulate_rotary(path.path(), square(3), c.bar, {}, diagnostics);
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->workpiece.dx, c.distance, 0.01 * c.distance);
    EXPECT_NEAR(kPi * c.bar.diameter / result->workpiece.around, c.distance, 0.01 * c.distance);
  }
}

/// A turn needs as many positions of the tool as a straight motion that is as long as the way of the bar's
/// surface: the angle in radians times the radius.
TEST(Rotary, TheNumberOfPositionsIsThatOfTheWayOfTheSurface) {
  constexpr double kLength = 9e5;
  RotaryPath straight, turning;
  straight.tool(1).rapid({-0.5 * kLength, 0, 20});
  turning.tool(1).rapid({0, 0, 20});
  for (int i = 1; i <= 10; ++i) {
    straight.cut({(i % 2 == 0 ? -0.5 : 0.5) * kLength, 0, 20});
    turning.cut({0, 0, 20}, i * kLength / 10 * 180 / kPi);
  }
  double needed[2] = {};
  for (const bool turns : {false, true}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(run(turns ? turning : straight, square(2), 0.1, diagnostics));
    ASSERT_EQ(diagnostics.list().back().code, codes::rotary_limit);
    ASSERT_EQ(std::sscanf(diagnostics.list().back().message.c_str(), "the job needs %lf tool positions",
                          &needed[turns ? 1 : 0]),
              1);
  }
  EXPECT_NEAR(needed[1], needed[0], 30.0);
}

TEST(Rotary, InvalidInputIsReported) {
  RotaryPath path;
  path.tool(1).rapid({5, 0, 20}).cut({5, 0, 9}, 3.6e9);
  Diagnostics diagnostics;
  EXPECT_FALSE(run(path, square(2), 0.1, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::rotary_limit);
  RotaryPath no_tool;
  no_tool.tool(7).cut({5, 0, 9});
  EXPECT_FALSE(run(no_tool, square(2), 0.1, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::no_such_tool);
  SimulationOptions fine;
  fine.resolution = mm(0.02);
  EXPECT_FALSE(
      simulate_rotary(RotaryPath().tool(1).path(), square(2), {100, 0, 200, 0, 0}, fine, diagnostics));
  ASSERT_EQ(diagnostics.list().back().code, codes::rotary_limit);
  // 100 * pi * 200 / 50,000,000 is the square of 0.0354
  EXPECT_EQ(diagnostics.list().back().hint, "try a resolution of 0.0359 mm");
  EXPECT_FALSE(simulate_rotary(path.path(), square(2), {0, 0, 10, 0, 0}, {}, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::stock_empty);
}

}  // namespace
}  // namespace kerf::test
