// Dog-bones and T-bones: where they are, how far they go, and that a square part fits.
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "base/codes/op.h"
#include "swept.h"

#include "kerf/op/mill.h"

namespace kerf {
namespace {

using namespace test;

/// The largest distance from a rectangle at which cuts below the surface remove material, along its sides.
struct Beyond {
  double left = 0.0, right = 0.0, low = 0.0, high = 0.0;
};
Beyond beyond(const Toolpath& path, double width, double height, double radius) {
  Beyond sides;
  for (const Motion& m : motions(path)) {
    if (m.low() > -1e-9) continue;
    for (const Point2 p : {m.from.xy(), m.to.xy()}) {
      sides.left = std::max(sides.left, radius - p.x),
      sides.right = std::max(sides.right, p.x + radius - width);
      sides.low = std::max(sides.low, radius - p.y), sides.high = std::max(sides.high, p.y + radius - height);
    }
  }
  return sides;
}

std::optional<Operation> pocketed(const Region& region, const BoneOptions& bones, PocketPattern pattern,
                                  double finish = 0.0) {
  Diagnostics diagnostics;
  PocketOptions options{levels(), 0.4, pattern};
  options.finish = mm(finish), options.bones = bones;
  auto made = pocket(region, mill(4), options, diagnostics);
  EXPECT_TRUE(diagnostics.list().empty());
  return made;
}

TEST(Bones, ADogBoneTouchesTheCornerOnEachLevel) {
  const Region region = region_of({rectangle(0, 0, 40, 25)});
  const double gouge = 2.0 - std::sqrt(2.0);  // of a disc of radius 2 through a corner, beyond both sides
  for (const PocketPattern pattern : {PocketPattern::offset, PocketPattern::spiral, PocketPattern::zigzag})
    for (const double finish : {0.0, 0.3}) {
      const auto made = pocketed(region, {.kind = BoneKind::dog_bone}, pattern, finish);
      ASSERT_TRUE(made);
      EXPECT_TRUE(made->unreached.empty());
      const std::vector<Motion> cuts = motions(made->path);
      for (const Point2 c : {Point2{0, 0}, {40, 0}, {40, 25}, {0, 25}}) {
        EXPECT_TRUE(removed_to(cuts, c, 2.0 + 1e-6, -4.0));
        if (finish == 0.0) {
          EXPECT_TRUE(std::any_of(cuts.begin(), cuts.end(), [&](const Motion& m) {
            return m.from.z == -2.0 && m.to.z == -2.0 && m.distance_to(c) <= 2.0 + 1e-6;
          }));
        }
        const Point2 outside = c + (0.01 / std::sqrt(2.0)) * Point2{c.x > 0 ? 1.0 : -1, c.y > 0 ? 1.0 : -1};
        EXPECT_FALSE(touched(cuts, outside, 2.0, 0.0));
      }
      const Beyond sides = beyond(made->path, 40, 25, 2);
      for (const double side : {sides.left, sides.right, sides.low, sides.high})
        EXPECT_NEAR(side, gouge, 1e-5);
      EXPECT_EQ(rapid_problem(made->path, 2, 0), "");
    }
}

TEST(Bones, ATBoneCutsIntoTheSideAtTheEndOfItsEdge) {
  const Region region = region_of({rectangle(0, 0, 40, 25)});
  for (const BoneEdge edge : {BoneEdge::longer, BoneEdge::shorter}) {
    const auto made = pocketed(region, {.kind = BoneKind::t_bone, .edge = edge}, PocketPattern::offset);
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->unreached.empty());
    const std::vector<Motion> cuts = motions(made->path);
    for (const Point2 c : {Point2{0, 0}, {40, 0}, {40, 25}, {0, 25}})
      EXPECT_TRUE(removed_to(cuts, c, 2.0 + 1e-6, -4.0));
    const Beyond sides = beyond(made->path, 40, 25, 2);
    const bool longer = edge == BoneEdge::longer;
    EXPECT_NEAR(sides.left, longer ? 2 : 0, 1e-5);
    EXPECT_NEAR(sides.right, longer ? 2 : 0, 1e-5);
    EXPECT_NEAR(sides.low, longer ? 0 : 2, 1e-5);
    EXPECT_NEAR(sides.high, longer ? 0 : 2, 1e-5);
  }
}

TEST(Bones, OfAPartAreInItsNotches) {
  // An L: one inner corner at 20, 15; the others are round already.
  const Region part = region_of({polygon({{0, 0}, {40, 0}, {40, 15}, {20, 15}, {20, 30}, {0, 30}})});
  ContourOptions options{.cut = levels()};
  options.bones.kind = BoneKind::dog_bone;
  options.tabs.height = mm(1), options.tabs.length = mm(4);
  Diagnostics diagnostics;
  const auto made = contour(part, mill(4), options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->unreached.empty());
  const std::vector<Motion> cuts = motions(made->path);
  EXPECT_TRUE(removed_to(cuts, {20, 15}, 2.0 + 1e-6, -4.0));
  EXPECT_FALSE(touched(cuts, {19.99, 14.99}, 2.0, 0.0));
  for (double x = 0.1; x < 40; x += 0.5)
    for (double y = 0.1; y < 30; y += 0.5)
      if ((x < 20 || y < 15) && distance(Point2{x, y}, {20, 15}) > 3.0) {
        ASSERT_FALSE(touched(cuts, {x, y}, 1.9999, 0)) << x << " " << y;
      }
}

TEST(Bones, AllowanceStaysInTheCorner) {
  CutOptions cut = levels();
  cut.allowance = mm(0.5);
  for (const BoneKind kind : {BoneKind::dog_bone, BoneKind::t_bone}) {
    Diagnostics diagnostics;
    const auto made =
        pocket(region_of({rectangle(0, 0, 40, 25)}), mill(4), {.cut = cut, .bones = {kind}}, diagnostics);
    ASSERT_TRUE(made);
    double nearest = INFINITY;
    for (const Motion& m : motions(made->path))
      if (m.low() < -1) nearest = std::min(nearest, m.distance_to({0, 0}));
    // A T-bone stays the allowance away from its edge, so that the corner is at 2, 0.5 from its tip's centre.
    EXPECT_NEAR(nearest, kind == BoneKind::dog_bone ? 2.5 : std::hypot(2.5, 0.5), 1e-5);
  }
}

TEST(Bones, WideAndRoundCornersHaveNone) {
  std::vector<Point2> many;
  for (int i = 0; i < 24; ++i)
    many.push_back({20 * std::cos(i * std::numbers::pi / 12), 20 * std::sin(i * std::numbers::pi / 12)});
  const Region wide = region_of({polygon(many)});  // 165 degrees
  const auto length_of = [](const Operation& made) {
    double sum = 0.0;
    for (const Motion& m : motions(made.path)) sum += m.arc ? 0.0 : distance(m.from, m.to);
    return sum;
  };
  const auto with = pocketed(wide, {.kind = BoneKind::dog_bone}, PocketPattern::offset);
  const auto without = pocketed(wide, {}, PocketPattern::offset);
  ASSERT_TRUE(with && without);
  EXPECT_EQ(length_of(*with), length_of(*without));
  const auto all = pocketed(wide, {.kind = BoneKind::dog_bone, .angle = degrees(170)}, PocketPattern::offset);
  ASSERT_TRUE(all);
  EXPECT_NEAR(length_of(*all) - length_of(*without),
              2 * 24 * 2 * 2 * (1 / std::cos(std::numbers::pi / 24) - 1), 1e-3);
  // A circle, and a rounded corner that the tool reaches.
  const Region round = region_of({as_outline({{0, 0}, mm(10)})});
  EXPECT_EQ(length_of(*pocketed(round, {.kind = BoneKind::dog_bone}, PocketPattern::offset)),
            length_of(*pocketed(round, {}, PocketPattern::offset)));
}

TEST(Bones, BothCornersOfAShortEdgeAreCovered) {
  const Region region = region_of({polygon({{1, 0}, {40, 0}, {40, 25}, {0, 25}, {0, 1.3}})});
  for (const BoneKind kind : {BoneKind::dog_bone, BoneKind::t_bone}) {
    const auto made = pocketed(region, {.kind = kind}, PocketPattern::offset);
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->unreached.empty());
    const std::vector<Motion> cuts = motions(made->path);
    for (const Point2 c : {Point2{1, 0}, {0, 1.3}, {0.5, 0.65}, {40, 0}})
      EXPECT_TRUE(removed_to(cuts, c, 2.0 + 1e-6, -4.0)) << c.x << " " << c.y;
  }
}

TEST(Bones, ASlotAsWideAsTheToolHasThemAtItsEnds) {
  for (const double width : {4.0, 4.02, 5.0}) {
    const Region region = region_of({rectangle(0, 0, 40, width)});
    for (const BoneKind kind : {BoneKind::dog_bone, BoneKind::t_bone}) {
      const auto made = pocketed(region, {.kind = kind}, PocketPattern::offset);
      ASSERT_TRUE(made);
      const std::vector<Motion> cuts = motions(made->path);
      for (const Point2 c : {Point2{0, 0}, {40, 0}, {40, width}, {0, width}})
        EXPECT_TRUE(removed_to(cuts, c, 2.0 + 1e-3, -4.0)) << width << " " << c.x << " " << c.y;
    }
  }
}

TEST(Bones, OfTheRestAreThoseOfTheRegion) {
  const Region region = region_of({rectangle(0, 0, 40, 25)});
  PocketOptions options{levels()};
  options.bones.kind = BoneKind::dog_bone;
  Diagnostics diagnostics;
  const auto made = rest_pocket(region, mill(8), mill(3), options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->unreached.empty());
  for (const Point2 c : {Point2{0, 0}, {40, 0}, {40, 25}, {0, 25}})
    EXPECT_TRUE(removed_to(motions(made->path), c, 1.5 + 1e-6, -4.0));
  EXPECT_NEAR(beyond(made->path, 40, 25, 1.5).left, 1.5 * (1 - std::sqrt(0.5)), 1e-5);
}

TEST(Bones, AdaptivePocketsCutThemInTheFinishingPass) {
  const Region region = region_of({rectangle(0, 0, 40, 25)});
  const auto made = pocketed(region, {.kind = BoneKind::dog_bone}, PocketPattern::adaptive, 0.3);
  ASSERT_TRUE(made);
  EXPECT_TRUE(removed_to(motions(made->path), {0, 0}, 2.0 + 1e-6, -4.0));
  PocketOptions options{levels(), 0.4, PocketPattern::adaptive};
  options.bones.kind = BoneKind::dog_bone;
  Diagnostics diagnostics;
  EXPECT_FALSE(pocket(region, mill(4), options, diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::op_option);
  options = {levels()};
  options.bones = {.kind = BoneKind::dog_bone, .angle = degrees(190)};
  EXPECT_FALSE(pocket(region, mill(4), options, diagnostics));
  EXPECT_FALSE(contour(region, mill(4), {.cut = levels(), .bones = options.bones}, diagnostics));
}

// Random polygons: where the tool reaches both sides of a corner, it covers all of the corner, and what it
// cuts outside lies within its radius of the way from there to the corner.
TEST(Bones, CoverTheCornersOfRandomPolygons) {
  std::mt19937_64 random(7);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int checked = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Point2> points;
    const int count = 3 + static_cast<int>(in(0, 6));
    for (int i = 0; i < count; ++i) {
      const double a = 2 * std::numbers::pi * (i + in(0, 0.7)) / count, r = in(12, 40);
      points.push_back({r * std::cos(a), r * std::sin(a)});
    }
    const Region region = region_of({polygon(points)});
    const RegionSearch inside(region);
    const bool contours = round % 2 == 1;
    CutOptions cut = levels(4, in(0, 1) < 0.5 ? 0.0 : 2.0);
    if (in(0, 1) < 0.5) cut.direction = CutDirection::conventional;
    const Length finish = mm(in(0, 1) < 0.5 ? 0.0 : 0.3);
    Diagnostics diagnostics;
    const BoneOptions bones{.kind = BoneKind::dog_bone, .angle = degrees(179)};
    const auto made =
        contours ? contour(region, mill(4),
                           {.cut = cut,
                            .side = ContourSide::inside,
                            .lead_in = {LeadKind::arc, mm(1)},
                            .lead_out = {LeadKind::arc, mm(1)},
                            .overlap = mm(in(0, 3)),
                            .finish = finish,
                            .bones = bones},
                           diagnostics)
                 : pocket(region, mill(4), {.cut = cut, .finish = finish, .bones = bones}, diagnostics);
    if (!made) continue;
    const std::vector<Motion> cuts = motions(made->path);
    std::vector<std::pair<Point2, Point2>> ways;
    bool blunt = false;  // an edge so short that the tool touches others first
    for (int i = 0; i < count; ++i) {
      const Point2 c = points[i];
      Point2 a = points[(i + count - 1) % count] - c, b = points[(i + 1) % count] - c;
      a = (1 / length(a)) * a, b = (1 / length(b)) * b;
      if (cross(b, a) <= 0) continue;
      Point2 bisector = a + b;
      bisector = (1 / length(bisector)) * bisector;
      const double half = std::acos(std::clamp(dot(bisector, a), -1.0, 1.0));
      const Point2 start = c + (2.0 / std::sin(half)) * bisector;
      if (inside.locate(start, mm(1e-9)) != Location::inside || inside.clearance(start)->mm() < 2 - 1e-6) {
        blunt = true;
        continue;
      }
      ways.push_back({start, c + 2.0 * bisector});
      if (2.0 / std::sin(half) - 2.0 < 0.002) continue;
      EXPECT_TRUE(removed_to(cuts, c, 2 + 1e-5, -4)) << round << " " << i;
      ++checked;
    }
    for (const Motion& m : cuts) {
      if (m.low() > -1e-9 || blunt) continue;
      for (const Point2 p : {m.from.xy(), m.to.xy()}) {
        if (inside.locate(p, mm(1e-9)) == Location::inside && inside.clearance(p)->mm() > 2 - 1e-3) continue;
        double off = INFINITY;
        for (const auto& [from, to] : ways) {
          Motion way;
          way.from = {from.x, from.y, 0}, way.to = {to.x, to.y, 0};
          off = std::min(off, way.distance_to(p));
        }
        EXPECT_LT(off, 1e-4) << round << " at " << p.x << ", " << p.y;
      }
    }
  }
  EXPECT_GT(checked, 600);
}

}  // namespace
}  // namespace kerf
