// Pockets and facing: what is removed and what stays, from the geometry of the region.
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "base/codes/op.h"
#include "op/mill/pocket_rings.h"
#include "random_regions.h"
#include "swept.h"

#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

const Code* first_code(const Diagnostics& diagnostics) {
  return diagnostics.list().empty() ? nullptr : &diagnostics.list().front().code;
}

TEST(Pocket, ARectangleIsClearedToItsCorners) {
  const Region region = region_of({rectangle(0, 0, 40, 20)});
  for (const PocketPattern pattern : {PocketPattern::offset, PocketPattern::spiral, PocketPattern::zigzag})
    for (const double stepover : {0.2, 0.4, 0.6, 0.75, 0.9, 1.0}) {
      Diagnostics diagnostics;
      const auto made =
          pocket(region, mill(6), {.cut = levels(), .stepover = stepover, .pattern = pattern}, diagnostics);
      ASSERT_TRUE(made);
      EXPECT_TRUE(diagnostics.list().empty());
      // A corner keeps the square of the radius less a quarter of the circle.
      EXPECT_NEAR(area(made->unreached), 4 * 9 * (1 - std::numbers::pi / 4), 1e-3);
      EXPECT_EQ(wrong_points(made->path, region, made->unreached, 3, 0, -4, 0.37), "") << stepover;
      EXPECT_EQ(rapid_problem(made->path, 3, 0), "") << stepover;
    }
}

TEST(Pocket, IslandsStay) {
  const Region region =
      region_of({rectangle(0, 0, 60, 40), rectangle(20, 15, 30, 25), as_outline({{45, 20}, mm(5)})});
  for (const PocketPattern pattern : {PocketPattern::offset, PocketPattern::spiral, PocketPattern::zigzag}) {
    Diagnostics diagnostics;
    const auto made =
        pocket(region, mill(5), {.cut = levels(), .stepover = 0.45, .pattern = pattern, .angle = degrees(30)},
               diagnostics);
    ASSERT_TRUE(made);
    EXPECT_EQ(wrong_points(made->path, region, made->unreached, 2.5, 0, -4, 0.41), "");
    EXPECT_EQ(rapid_problem(made->path, 2.5, 0), "");
  }
}

TEST(Pocket, ASlotAsWideAsTheToolIsCut) {
  const Region region = region_of({rectangle(0, 0, 30, 6)});
  Diagnostics diagnostics;
  const auto made = pocket(region, mill(6), {.cut = levels()}, diagnostics);
  ASSERT_TRUE(made) << to_string(diagnostics.list().front());
  EXPECT_FALSE(diagnostics.has_errors());
  EXPECT_EQ(wrong_points(made->path, region, made->unreached, 3, 0, -4, 0.31), "");
}

TEST(Pocket, RingsOfManyShortArcsCoverAllInside) {
  // A circle of arcs that bulge in and out by turns, by less than a micrometre.
  constexpr int kArcs = 40'000;
  constexpr double kRadius = 60.0, kStep = 2.0 * std::numbers::pi / kArcs;
  const auto at = [](double radius, double angle) {
    return Point2{radius * std::cos(angle), radius * std::sin(angle)};
  };
  Outline outline{at(kRadius, 0.0)};
  for (int i = 1; i <= kArcs; ++i) {
    const double bulge = (i % 2 == 0 ? 0.05 : -0.05) * kRadius * kStep;
    outline.segments.push_back({at(kRadius, i * kStep), at(kRadius + bulge, (i - 0.5) * kStep)});
  }
  outline.segments.back().to = outline.start;
  Diagnostics diagnostics;
  const auto made =
      pocket(region_of({outline}), mill(10), {.cut = levels(2, 0), .stepover = 0.4}, diagnostics);
  ASSERT_TRUE(made) << to_string(diagnostics.list().front());
  EXPECT_TRUE(diagnostics.list().empty());
  // One row of points outwards; a circle is the same in all directions.
  const std::vector<Motion> path = motions(made->path);
  for (double r = 0.0; r < 66.0; r += 1.37) {
    if (r < kRadius - 0.002) {
      EXPECT_TRUE(removed_to(path, at(r, 1.0), 5.0, -2.0 + 1e-6)) << r;
    }
    if (r > kRadius + 0.002) {
      EXPECT_FALSE(touched(path, at(r, 1.0), 5.0, -1e-6)) << r;
    }
  }
}

TEST(Pocket, AToolTooWideIsReportedWithTheLargestThatFits) {
  Diagnostics diagnostics;
  EXPECT_FALSE(pocket(region_of({rectangle(0, 0, 30, 4)}), mill(6), {.cut = levels()}, diagnostics));
  ASSERT_EQ(diagnostics.errors(), 1u);
  EXPECT_EQ(*first_code(diagnostics), codes::op_tool_wide);
  const std::string message = diagnostics.list().front().message;
  EXPECT_NE(message.find("6 mm"), std::string::npos) << message;
  EXPECT_NE(message.find("has 4 mm"), std::string::npos) << message;
}

TEST(Pocket, ANarrowPartIsAWarningAndTheRestIsCut) {
  // A square with a channel of 4 mm to the right.
  const Region region =
      region_of({polygon({{0, 0}, {20, 0}, {20, 8}, {40, 8}, {40, 12}, {20, 12}, {20, 20}, {0, 20}})});
  Diagnostics diagnostics;
  const auto made = pocket(region, mill(6), {.cut = levels()}, diagnostics);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->narrow.size(), 1u);
  EXPECT_NEAR(made->narrow[0].diameter.mm(), 4.0, 0.05);
  EXPECT_GT(made->narrow[0].at.x, 20.0);
  EXPECT_NEAR(made->narrow[0].at.y, 10.0, 0.05);
  EXPECT_EQ(diagnostics.warnings(), 1u);
  EXPECT_EQ(wrong_points(made->path, region, made->unreached, 3, 0, -4, 0.37), "");
}

TEST(Pocket, ClimbHasTheWallOnTheRight) {
  for (const CutDirection direction : {CutDirection::climb, CutDirection::conventional}) {
    CutOptions cut = levels(1, 0);
    cut.direction = direction;
    cut.entry.kind = EntryKind::plunge;
    Diagnostics diagnostics;
    const auto made = pocket(region_of({rectangle(0, 0, 40, 20)}), mill(6), {.cut = cut}, diagnostics);
    ASSERT_TRUE(made);
    // Along the lower wall, at y = 3.
    double along = 0.0;
    for (const Motion& m : motions(made->path))
      if (!m.rapid && std::abs(m.from.y - 3) < 1e-6 && std::abs(m.to.y - 3) < 1e-6)
        along += m.to.x - m.from.x;
    EXPECT_NEAR(along, direction == CutDirection::climb ? 34.0 : -34.0, 1e-6);
  }
}

TEST(Pocket, EntriesAreNoSteeperThanGiven) {
  for (const EntryKind kind : {EntryKind::ramp, EntryKind::helix})
    for (const PocketPattern pattern :
         {PocketPattern::offset, PocketPattern::spiral, PocketPattern::zigzag}) {
      CutOptions cut = levels(6, 2);
      cut.entry = {.kind = kind, .angle = degrees(5)};
      Diagnostics diagnostics;
      const auto made = pocket(region_of({rectangle(0, 0, 40, 30)}), mill(6),
                               {.cut = cut, .pattern = pattern}, diagnostics);
      ASSERT_TRUE(made);
      bool descends = false;
      for_each_motion(made->path, [&](const Step& s, const MotionContext& context) {
        if (!s.is_cutting() || s.to().z >= context.from.z) return;
        const double drop = context.from.z - s.to().z;
        const double along = s.kind() == StepKind::arc
                                 ? std::sqrt(std::pow(walk_of(s, context.from).length(), 2) - drop * drop)
                                 : distance(s.to().xy(), context.from.xy());
        EXPECT_LE(std::atan2(drop, along), degrees(5).rad() + 1e-6);
        // The speed downwards is at most that of plunging.
        EXPECT_LE(s.feed().mm_per_min() * drop / std::hypot(drop, along), 200.0 + 1e-6);
        descends = true;
      });
      EXPECT_TRUE(descends);
    }
}

TEST(Pocket, AllPassesHaveOneDepth) {
  Diagnostics diagnostics;
  const auto made = pocket(region_of({rectangle(0, 0, 40, 20)}), mill(6), {.cut = levels(5, 2)}, diagnostics);
  ASSERT_TRUE(made);
  for (const double z : {-5.0 / 3, -10.0 / 3, -5.0}) {
    bool present = false;
    for (const Motion& m : motions(made->path))
      present |= !m.rapid && std::abs(m.from.z - z) < 1e-9 && std::abs(m.to.z - z) < 1e-9;
    EXPECT_TRUE(present) << z;
  }
}

TEST(Pocket, AllowanceStaysOnTheWalls) {
  CutOptions cut = levels();
  cut.allowance = mm(0.5);
  Diagnostics diagnostics;
  const auto made = pocket(region_of({rectangle(0, 0, 40, 20)}), mill(6), {.cut = cut}, diagnostics);
  ASSERT_TRUE(made);
  const Region smaller = region_of({rectangle(0.5, 0.5, 39.5, 19.5)});
  const auto opened = offset(smaller, mm(-3), {}, diagnostics);
  const auto reached = offset(opened->region, mm(3), {}, diagnostics);
  const auto corners = combine(smaller, reached->region, Boolean::subtract, {}, diagnostics);
  EXPECT_EQ(wrong_points(made->path, smaller, corners->region, 3, 0, -4, 0.37), "");
}

TEST(Pocket, TheFinishingPassRemovesTheAllowance) {
  const Region region = region_of({rectangle(0, 0, 40, 24), as_outline({{14, 12}, mm(4)})});
  for (const PocketPattern pattern : {PocketPattern::offset, PocketPattern::spiral, PocketPattern::zigzag}) {
    PocketOptions options{.cut = levels(6, 2), .pattern = pattern};
    options.finish = mm(0.3);
    Diagnostics diagnostics;
    const auto made = pocket(region, mill(5), options, diagnostics);
    ASSERT_TRUE(made);
    EXPECT_TRUE(diagnostics.list().empty());
    EXPECT_EQ(wrong_points(made->path, region, made->unreached, 2.5, 0, -6, 0.37), "");
    EXPECT_EQ(rapid_problem(made->path, 2.5, 0), "");
    // The wall at y = 0 is cut once, at the bottom.
    double along = 0.0;
    for (const Motion& m : motions(made->path))
      if (!m.rapid && std::abs(m.from.y - 2.5) < 1e-6 && std::abs(m.to.y - 2.5) < 1e-6)
        along += std::abs(m.to.x - m.from.x);
    EXPECT_NEAR(along, 35, 1e-6);
  }
}

TEST(Pocket, APartThatOnlyTheFinishingPassReachesIsCutInPasses) {
  // A slot 5.2 mm wide to the right of a square.
  const Region region =
      region_of({polygon({{0, 0}, {20, 0}, {20, 7}, {40, 7}, {40, 12.2}, {20, 12.2}, {20, 20}, {0, 20}})});
  PocketOptions options{.cut = levels(6, 2)};
  options.finish = mm(0.3);
  Diagnostics diagnostics;
  const auto made = pocket(region, mill(5), options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_TRUE(diagnostics.list().empty());
  EXPECT_EQ(wrong_points(made->path, region, made->unreached, 2.5, 0, -6, 0.37), "");
  EXPECT_EQ(rapid_problem(made->path, 2.5, 0), "");
  bool first = false;
  for (const Motion& m : motions(made->path))
    first |= !m.rapid && m.from.x > 30 && std::abs(m.from.z + 2) < 1e-9 && std::abs(m.to.z + 2) < 1e-9;
  EXPECT_TRUE(first);
}

TEST(Pocket, BadInputIsAnError) {
  const Region region = region_of({rectangle(0, 0, 40, 20)});
  const auto code = [&](const Region& r, const PocketOptions& options) {
    Diagnostics diagnostics;
    EXPECT_FALSE(pocket(r, mill(6), options, diagnostics));
    return diagnostics.list().empty() ? Code{} : diagnostics.list().front().code;
  };
  PocketOptions good{.cut = levels()};
  EXPECT_EQ(code({}, good), codes::op_empty);
  Region open = region;
  open.loops[0].segments.pop_back();
  EXPECT_EQ(code(open, good), codes::op_open);
  for (const double stepover : {0.0, -0.4, 1.5, std::nan("")}) {
    PocketOptions bad = good;
    bad.stepover = stepover;
    EXPECT_EQ(code(region, bad), codes::op_option) << stepover;
  }
  for (const double number : {-1.0, std::nan(""), double{INFINITY}}) {
    std::vector<PocketOptions> all(7, good);
    all[0].cut.depth = mm(number), all[1].cut.stepdown = mm(number), all[2].cut.feed = mm_per_min(number);
    all[3].cut.plunge = mm_per_min(number), all[4].cut.clearance = mm(number);
    all[5].cut.allowance = mm(number), all[6].cut.entry.angle = degrees(number);
    for (const PocketOptions& bad : all) EXPECT_EQ(code(region, bad), codes::op_option) << number;
  }
  for (const double finish : {-1.0, std::nan("")}) {
    PocketOptions bad = good;
    bad.finish = mm(finish);
    EXPECT_EQ(code(region, bad), codes::op_option) << finish;
  }
  PocketOptions low = good;
  low.cut.retract_plane = -1;
  EXPECT_EQ(code(region, low), codes::op_option);
  PocketOptions fine = good;
  fine.stepover = 1e-9;
  EXPECT_EQ(code(region, fine), codes::op_limit);
  PocketOptions few = good;
  few.cut.max_steps = 10;
  EXPECT_EQ(code(region, few), codes::op_limit);
}

TEST(Pocket, AFluteShorterThanTheDepthIsAWarning) {
  Diagnostics diagnostics;
  EXPECT_TRUE(pocket(region_of({rectangle(0, 0, 40, 20)}), mill(6, 3), {.cut = levels()}, diagnostics));
  ASSERT_EQ(diagnostics.warnings(), 1u);
  EXPECT_EQ(*first_code(diagnostics), codes::op_flute);
}

TEST(Pocket, RestMachiningCutsWhatTheEarlierToolLeft) {
  std::mt19937_64 random(41);
  int cut_count = 0;
  for (int i = 0; i < 20; ++i) {
    const Region region = i == 0 ? region_of({rectangle(0, 0, 40, 20)}) : random_region(random);
    const Tool big = mill(8), small = mill(2.5);
    PocketOptions options{.cut = levels(3, 1.5)};
    options.pattern = i % 3 == 0   ? PocketPattern::offset
                      : i % 3 == 1 ? PocketPattern::spiral
                                   : PocketPattern::zigzag;
    Diagnostics diagnostics;
    const auto first = pocket(region, big, options, diagnostics);
    Diagnostics found;
    const auto rest = rest_pocket(region, big, small, options, found);
    if (!rest) {
      for (const Diagnostic& d : found.list())
        EXPECT_TRUE(d.severity != Severity::error || d.code == codes::op_empty ||
                    d.code == codes::op_tool_wide)
            << to_string(d);
      continue;
    }
    ++cut_count;
    EXPECT_EQ(rapid_problem(rest->path, 1.25, 0), "") << i;
    // Together they leave what the small tool alone would leave.
    Diagnostics unused;
    const auto alone = pocket(region, small, options, unused);
    ASSERT_TRUE(alone);
    const std::vector<Motion> of_big = first ? motions(first->path) : std::vector<Motion>{};
    const std::vector<Motion> of_small = motions(rest->path);
    const RegionSearch inside(region), left(alone->unreached);
    const Box2 box = bounds(region).grown(2);
    double whole = 0.0, again = 0.0;
    for (const Motion& m : of_small) again += m.rapid ? 0.0 : distance(m.from, m.to);
    for (const Motion& m : motions(alone->path)) whole += m.rapid ? 0.0 : distance(m.from, m.to);
    for (double x = box.low.x; x < box.high.x; x += 0.83)
      for (double y = box.low.y; y < box.high.y; y += 0.79) {
        const double clearance = inside.clearance({x, y})->mm();
        const auto stays = left.clearance({x, y});
        if (clearance < -0.01) {
          ASSERT_FALSE(touched(of_small, {x, y}, 1.25, 0)) << i << ": " << x << " " << y;
        }
        if (clearance > 0.01 && !(stays && stays->mm() > -0.02)) {
          ASSERT_TRUE(removed_to(of_big, {x, y}, 4.0001, -3) || removed_to(of_small, {x, y}, 1.2501, -3))
              << i << ": " << x << " " << y;
        }
      }
    if (i == 0) {
      EXPECT_LT(again, 0.5 * whole);
    }
  }
  EXPECT_GT(cut_count, 12);
}

TEST(Pocket, RestMachiningWithNothingLeftIsAnError) {
  Diagnostics diagnostics;
  EXPECT_FALSE(rest_pocket(region_of({as_outline({{0, 0}, mm(10)})}), mill(6), mill(3), {.cut = levels()},
                           diagnostics));
  ASSERT_EQ(diagnostics.errors(), 1u);
  EXPECT_EQ(diagnostics.list().front().code, codes::op_empty);
}

TEST(Facing, TheWholeRegionIsLevelled) {
  const Region region = region_of({rectangle(0, 0, 50, 30)});
  for (const double angle : {0.0, 90.0, 37.0})
    for (const double stepover : {0.4, 1.0}) {
      Diagnostics diagnostics;
      const auto made =
          facing(region, mill(10), {.cut = levels(1, 0.5), .stepover = stepover, .angle = degrees(angle)},
                 diagnostics);
      ASSERT_TRUE(made);
      const std::vector<Motion> cuts = motions(made->path);
      for (double x = 0.1; x < 50; x += 0.7)
        for (double y = 0.1; y < 30; y += 0.7)
          ASSERT_TRUE(removed_to(cuts, {x, y}, 5.0001, -1)) << x << " " << y << " " << angle;
    }
}

TEST(Pocket, RandomRegionsAreClearedAndNothingElse) {
  std::mt19937_64 random(20261122);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int cut_count = 0;
  for (int i = 0; i < 60; ++i) {
    const Region region = random_region(random);
    const double diameter = in(1.5, 8);
    PocketOptions options{.cut = levels(3, in(1, 4)), .stepover = in(0.15, 1.0)};
    options.pattern = in(0, 1) < 0.3   ? PocketPattern::offset
                      : in(0, 1) < 0.5 ? PocketPattern::spiral
                                       : PocketPattern::zigzag;
    options.angle = degrees(in(0, 180));
    options.cut.direction = in(0, 1) < 0.5 ? CutDirection::climb : CutDirection::conventional;
    options.cut.entry.kind = in(0, 1) < 0.5   ? EntryKind::helix
                             : in(0, 1) < 0.5 ? EntryKind::ramp
                                              : EntryKind::plunge;
    if (in(0, 1) < 0.3) options.cut.allowance = mm(0);
    Diagnostics diagnostics;
    const auto made = pocket(region, mill(diameter), options, diagnostics);
    if (!made) {
      ASSERT_EQ(diagnostics.list().front().code, codes::op_tool_wide)
          << to_string(diagnostics.list().front());
      continue;
    }
    ++cut_count;
    EXPECT_EQ(wrong_points(made->path, region, made->unreached, diameter / 2, 0, -3, 0.83), "")
        << "case " << i << " stepover " << options.stepover << " diameter " << diameter;
    EXPECT_EQ(rapid_problem(made->path, diameter / 2, 0), "") << "case " << i;
  }
  EXPECT_GT(cut_count, 40);
}

TEST(Pocket, ASpiralHasOneEntryAndNoLinks) {
  Diagnostics diagnostics;
  const Region circle = region_of({as_outline({{0, 0}, mm(25)})});
  const auto made = pocket(
      circle, mill(6), {.cut = levels(2, 2), .stepover = 0.4, .pattern = PocketPattern::spiral}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_EQ(wrong_points(made->path, circle, {}, 3, 0, -2, 0.7), "");
  int rapids_down = 0;
  double before = 0.0;  // distance from the centre: it never shrinks by more than the chords' tolerance
  for (const Motion& m : motions(made->path)) {
    rapids_down += m.rapid && m.to.z < m.from.z ? 1 : 0;
    if (m.rapid || m.arc || m.to.z > -2 + 1e-9) continue;
    EXPECT_GT(length(m.to.xy()), before - 0.02);
    before = length(m.to.xy());
  }
  EXPECT_LE(rapids_down, 1);
  EXPECT_GT(before, 21.9);
}

}  // namespace
}  // namespace kerf
