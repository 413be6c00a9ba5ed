// Regions of known areas and shapes: boolean operations and queries.
#include "kerf/geom/region.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "base/codes/outline.h"
#include "geom/region/resolve.h"
#include "region_samples.h"

namespace kerf {
namespace {

using Regions = RegionTest;

TEST_F(Regions, HaveTheirInsideOnTheLeft) {
  const Region region = made({reversed(rectangle(0, 0, 10, 10)), rectangle(2, 2, 3, 3)}, FillRule::even_odd);
  ASSERT_EQ(region.loops.size(), 2u);
  EXPECT_DOUBLE_EQ(area(region), 91.0);
  EXPECT_DOUBLE_EQ(length(region).mm(), 52.0);
  EXPECT_EQ(bounds(region).high, (Point2{10, 10}));
}

TEST_F(Regions, OfAnOutlineThatCrossesItselfFollowTheRule) {
  // Goes around the inner square twice.
  const Outline twice{{0, 0},
                      {{{4, 0}, {}},
                       {{4, 4}, {}},
                       {{1, 4}, {}},
                       {{1, 1}, {}},
                       {{3, 1}, {}},
                       {{3, 3}, {}},
                       {{0, 3}, {}},
                       {{0, 0}, {}}}};
  const double even = area(made({twice}, FillRule::even_odd)), any = area(made({twice}));
  EXPECT_DOUBLE_EQ(any, 15.0);   // without one corner
  EXPECT_DOUBLE_EQ(even, 11.0);  // also without the square with winding number 2
  EXPECT_DOUBLE_EQ(area(made({reversed(twice)}, FillRule::positive)), 0.0);
}

TEST_F(Regions, OfCirclesAreExact) {
  const Region two = made({circle(0, 0, 5), circle(6, 0, 5)});
  ASSERT_EQ(two.loops.size(), 1u);
  EXPECT_EQ(two.loops[0].segments.size(), 4u);  // the rest of the two halves of each circle
  const double lens = 50.0 * std::acos(0.6) - 24.0;
  EXPECT_NEAR(area(two), 50.0 * kPi - lens, 1e-11);
}

TEST_F(Regions, CombineAsSetsDo) {
  const Region a = made({rectangle(0, 0, 4, 4)}), b = made({rectangle(2, 1, 4, 2)});
  EXPECT_DOUBLE_EQ(area(combined(a, b, Boolean::unite)), 20.0);
  EXPECT_EQ(relation, Relation::overlapping);
  EXPECT_DOUBLE_EQ(area(combined(a, b, Boolean::intersect)), 4.0);
  EXPECT_DOUBLE_EQ(area(combined(a, b, Boolean::subtract)), 12.0);
  EXPECT_DOUBLE_EQ(area(combined(a, b, Boolean::exclude)), 16.0);
  EXPECT_DOUBLE_EQ(area(*unite({a, b, made({rectangle(-1, -1, 1, 1)})}, {}, diagnostics)), 21.0);
}

TEST_F(Regions, HaveARelation) {
  const Region large = made({rectangle(0, 0, 10, 10)}), small = made({circle(5, 5, 2)});
  combined(large, small, Boolean::subtract);
  EXPECT_EQ(relation, Relation::second_inside_first);
  combined(small, large, Boolean::subtract);
  EXPECT_EQ(relation, Relation::first_inside_second);
  EXPECT_TRUE(combined(large, large, Boolean::exclude).empty());
  EXPECT_EQ(relation, Relation::equal);
  const Region beside = made({rectangle(10, 0, 3, 10)});
  EXPECT_EQ(combined(large, beside, Boolean::unite).loops.size(), 1u);  // the common side is removed
  EXPECT_EQ(relation, Relation::disjoint);
}

TEST_F(Regions, ThatTouchInAPointStaySeparate) {
  const Region two = made({rectangle(0, 0, 1, 1), rectangle(1, 1, 1, 1)});
  EXPECT_EQ(two.loops.size(), 2u);
  const Region tangent = combined(made({circle(0, 0, 2)}), made({circle(4, 0, 2)}), Boolean::unite);
  EXPECT_NEAR(area(tangent), 8.0 * kPi, 1e-11);
}

/// Boundaries nearly two tolerances apart are not connected, but each has the other near its leftmost point.
TEST_F(Regions, OfPiecesOneToTwoTolerancesApartAreExact) {
  for (const double apart : {1.02e-6, 1.5e-6, 1.99e-6}) {
    const Region a = made({circle(0, 0, 5)}), b = made({circle(0, 0, 5 + apart)});
    EXPECT_NEAR(area(combined(a, b, Boolean::unite)), 25.0 * kPi, 1e-4);
    EXPECT_NEAR(area(combined(a, b, Boolean::intersect)), 25.0 * kPi, 1e-4);
    EXPECT_NEAR(area(combined(a, b, Boolean::subtract)), 0.0, 1e-4);
    const Region square = made({rectangle(0, 0, 10, 10)});
    EXPECT_NEAR(area(combined(square, made({rectangle(apart, 2, 5, 1)}), Boolean::subtract)), 95.0, 1e-4);
    EXPECT_NEAR(area(combined(square, made({rectangle(10 + apart, 2, 5, 1)}), Boolean::unite)), 105.0, 1e-4);
  }
}

TEST_F(Regions, WithNecksThatCloseUpToRoundingKeepBothSides) {
  const double e = 1e-12;
  const Outline dumbbell{{0, 0},
                         {{{10, 0}, {}},
                          {{10, 5 - e}, {}},
                          {{20, 5 - e}, {}},
                          {{20, 0}, {}},
                          {{30, 0}, {}},
                          {{30, 10}, {}},
                          {{20, 10}, {}},
                          {{20, 5 + e}, {}},
                          {{10, 5 + e}, {}},
                          {{10, 10}, {}},
                          {{0, 10}, {}},
                          {{0, 0}, {}}}};
  EXPECT_NEAR(area(made({dumbbell})), 200.0, 1e-6);
}

TEST_F(Regions, BecomeFiguresWithTheirHoles) {
  const Region region = made({rectangle(0, 0, 20, 20), rectangle(2, 2, 16, 16), rectangle(4, 4, 2, 2),
                              rectangle(10, 4, 5, 5), circle(12, 6, 1)},
                             FillRule::even_odd);
  const auto parts = figures(region);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].size(), 1u);
  EXPECT_EQ(parts[1].size(), 2u);
  EXPECT_EQ(parts[2].size(), 2u);
  EXPECT_NEAR(area(*make_region(parts[1], {}, diagnostics)), 25.0 - kPi, 1e-12);
}

TEST_F(Regions, LocatePoints) {
  const RegionSearch search(made({circle(0, 0, 10), rectangle(-2, -2, 4, 4)}, FillRule::even_odd));
  EXPECT_EQ(search.locate({5, 0}, {}), Location::inside);
  EXPECT_EQ(search.locate({0, 0}, {}), Location::outside);
  EXPECT_EQ(search.locate({-11, 0}, {}), Location::outside);
  EXPECT_EQ(search.locate({2, 1}, {}), Location::boundary);
  EXPECT_EQ(search.locate({8, 6.0005}, mm(1e-3)), Location::boundary);
  const auto nearest = search.nearest({30, 40});
  EXPECT_NEAR(nearest->distance.mm(), 40.0, 1e-12);
  EXPECT_NEAR(nearest->at.x, 6.0, 1e-12);
  EXPECT_FALSE(RegionSearch(Region{}).nearest({0, 0}).has_value());
}

TEST_F(Regions, KnowWhichLoopIsAroundWhich) {
  // A plate with a hole that has an island with a hole; a second hole; a second plate in the outer bay.
  const Region region = made({rectangle(0, 0, 40, 40), rectangle(2, 2, 20, 20), rectangle(4, 4, 10, 10),
                              circle(9, 9, 2), rectangle(30, 30, 5, 5), rectangle(50, 0, 5, 5)},
                             FillRule::even_odd);
  ASSERT_EQ(region.loops.size(), 6u);
  const Nesting tree = nesting(region);
  const auto loop_of_area = [&](double wanted) {
    for (std::uint32_t i = 0; i < region.loops.size(); ++i)
      if (std::abs(area(region.loops[i]) - wanted) < 1e-9) return i;
    return Nesting::kNone;
  };
  const std::uint32_t plate = loop_of_area(1600), bay = loop_of_area(-400), island = loop_of_area(100),
                      hole = loop_of_area(-4.0 * kPi);
  EXPECT_EQ(tree.parents[plate], Nesting::kNone);
  EXPECT_EQ(tree.parents[bay], plate);
  EXPECT_EQ(tree.parents[island], bay);
  EXPECT_EQ(tree.parents[hole], island);
  EXPECT_EQ(tree.depths[hole], 3u);
  EXPECT_EQ(tree.parents[loop_of_area(-25)], plate);
  EXPECT_EQ(tree.parents[loop_of_area(25)], Nesting::kNone);
}

/// Loops that touch in points, where a ray along the row meets several loops at once.
TEST_F(Regions, NestWhereLoopsTouch) {
  std::vector<Outline> squares{rectangle(-1, -1, 10, 10)};
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      if ((x + y) % 2 == 0) squares.push_back(rectangle(2 * x, 2 * y, 2, 2));
  const Region board = made(squares, FillRule::even_odd);
  const Nesting tree = nesting(board);
  std::size_t outermost = 0;
  for (std::size_t i = 0; i < board.loops.size(); ++i) outermost += tree.depths[i] == 0 ? 1 : 0;
  EXPECT_EQ(outermost, 1u);
  for (std::size_t i = 0; i < board.loops.size(); ++i) EXPECT_LE(tree.depths[i], 2u);
  EXPECT_NEAR(area(board), 100.0 - 32.0, 1e-12);
}

TEST_F(Regions, MeasureClearanceAndEngagement) {
  const RegionSearch search(made({rectangle(0, 0, 20, 10), circle(15, 5, 2)}, FillRule::even_odd));
  EXPECT_NEAR(search.clearance({4, 5})->mm(), 4.0, 1e-12);
  EXPECT_NEAR(search.clearance({12, 5})->mm(), 1.0, 1e-12);
  EXPECT_NEAR(search.clearance({15, 5})->mm(), -2.0, 1e-12);
  EXPECT_NEAR(search.clearance({-3, -4})->mm(), -5.0, 1e-12);
  EXPECT_FALSE(RegionSearch(Region{}).clearance({0, 0}).has_value());
  // A tool half in the material along a straight wall: a slot's worth is half a turn, a side cut by its
  // depth.
  const RegionSearch wall(made({rectangle(0, 0, 100, 50)}));
  EXPECT_NEAR(wall.engagement({{50, 25}, mm(5)}, {1, 0}).deg(), 180.0, 1e-9);
  EXPECT_NEAR(wall.engagement({{50, 50}, mm(5)}, {1, 0}).deg(), 90.0, 1e-9);
  // Radial depth of cut a = r (1 - cos(engagement)).
  EXPECT_NEAR(wall.engagement({{50, 54}, mm(5)}, {1, 0}).rad(), std::acos(1.0 - 1.0 / 5.0), 1e-9);
  EXPECT_NEAR(wall.engagement({{50, 54}, mm(5)}, {0, 1}).rad(), 0.0, 1e-9);
  EXPECT_NEAR(wall.engagement({{50, 54}, mm(5)}, {0, -1}).rad(), 2.0 * std::acos(4.0 / 5.0), 1e-9);
  EXPECT_NEAR(wall.engagement({{50, 55.1}, mm(5)}, {1, 0}).rad(), 0.0, 1e-12);
  const auto ranges = wall.inside({{0, 0}, mm(3)});
  ASSERT_EQ(ranges.size(), 1u);
  EXPECT_NEAR(ranges[0].start.deg(), 0.0, 1e-9);
  EXPECT_NEAR(ranges[0].sweep.deg(), 90.0, 1e-9);
  EXPECT_NEAR(wall.inside({{100, 20}, mm(1)})[0].start.deg(), 90.0, 1e-9);
  EXPECT_NEAR(wall.inside({{0, 20}, mm(1)})[0].sweep.deg(), 180.0, 1e-9);  // across the angle 0
}

TEST_F(Regions, MeasureTheirDistance) {
  const Region left = made({rectangle(0, 0, 10, 10)}), ball = made({circle(20, 5, 4)});
  const auto apart = nearest_points(left, ball);
  EXPECT_NEAR(apart->distance.mm(), 6.0, 1e-12);
  EXPECT_NEAR(apart->first.x, 10.0, 1e-12);
  EXPECT_NEAR(apart->second.x, 16.0, 1e-12);
  EXPECT_NEAR(apart->second.y, 5.0, 1e-9);
  EXPECT_NEAR(nearest_points(ball, made({circle(20, 25, 3)}))->distance.mm(), 13.0, 1e-12);
  EXPECT_EQ(nearest_points(left, made({circle(5, 5, 1)}))->distance.mm(), 0.0);  // inside
  EXPECT_EQ(nearest_points(made({circle(5, 5, 1)}), left)->distance.mm(), 0.0);
  EXPECT_EQ(nearest_points(left, made({rectangle(-5, 4, 30, 2)}))->distance.mm(), 0.0);  // across
  EXPECT_NEAR(nearest_points(left, made({rectangle(13, 14, 3, 3)}))->distance.mm(), 5.0, 1e-12);
  const Region frame = made({rectangle(-20, -20, 50, 50), rectangle(-10, -10, 25, 25)}, FillRule::even_odd);
  EXPECT_NEAR(nearest_points(left, frame)->distance.mm(), 5.0, 1e-12);  // in its hole
  EXPECT_FALSE(nearest_points(left, Region{}).has_value());
}

/// What remains of a disc outside of two others of its size with centres some 1e-4 mm away: at the angle of
/// the unit vector u it is as wide as the smaller of both differences of centres along u.
TEST_F(Regions, KeepCrescentsBetweenThreeCircles) {
  constexpr double kRadius = 2.0;
  const Point2 a{-5.86e-5, -6.02e-5}, b{-2.93e-5, 6.08e-5};  // from the centres of the others
  double expected = 0.0;
  constexpr int kSteps = 100'000;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * kPi * (i + 0.5) / kSteps;
    const Point2 u{std::cos(angle), std::sin(angle)};
    expected += std::max(0.0, std::min(dot(a, u), dot(b, u))) * kRadius * 2.0 * kPi / kSteps;
  }
  const Region disc = made({circle(0, 0, kRadius)});
  const Region others = made({circle(-a.x, -a.y, kRadius), circle(-b.x, -b.y, kRadius)});
  const Region rest = combined(disc, others, Boolean::subtract);
  EXPECT_EQ(rest.loops.size(), 1u);
  EXPECT_NEAR(area(rest), expected, 1e-3 * expected);
}

TEST_F(Regions, DividePathsWhereTheyEnterAndLeave) {
  const Region region = made({rectangle(0, 0, 10, 10), circle(5, 5, 2)}, FillRule::even_odd);
  const Outline path{{-5, 5}, {{{15, 5}, {}}, {{15, 10}, {}}, {{5, 10}, {}}}};
  const auto pieces = divide(path, region, {}, diagnostics);
  ASSERT_EQ(pieces->size(), 6u);
  const Location expected[] = {Location::outside, Location::inside,  Location::outside,
                               Location::inside,  Location::outside, Location::boundary};
  const double lengths[] = {5, 3, 4, 3, 15, 5};
  const std::uint32_t segments[] = {0, 0, 0, 0, 0, 2};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ((*pieces)[i].location, expected[i]) << i;
    EXPECT_NEAR(length((*pieces)[i].path).mm(), lengths[i], 1e-9) << i;
    EXPECT_EQ((*pieces)[i].first_segment, segments[i]) << i;
    if (i == 0) continue;
    EXPECT_EQ((*pieces)[i].path.start, (*pieces)[i - 1].path.segments.back().to);
  }
  const auto inside = clip(circle(10, 10, 3), region, Location::inside, {}, diagnostics);
  ASSERT_EQ(inside->size(), 1u);
  EXPECT_NEAR(length((*inside)[0]).mm(), 1.5 * kPi, 1e-9);
  const auto whole = divide(circle(2, 2, 1), region, {}, diagnostics);
  ASSERT_EQ(whole->size(), 1u);
  EXPECT_TRUE((*whole)[0].path.closed());
  EXPECT_EQ((*whole)[0].location, Location::inside);
  EXPECT_EQ((*divide(path, Region{}, {}, diagnostics)).size(), 1u);
}

TEST_F(Regions, ReportWhereAnOutlineMeetsItself) {
  const Outline bow{{0, 0}, {{{4, 4}, {}}, {{4, 0}, {}}, {{0, 4}, {}}, {{0, 0}, {}}}};
  const auto found = self_intersections(bow, {}, diagnostics);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ((*found)[0].at, (Point2{2, 2}));
  EXPECT_EQ((*found)[0].first, 0u);
  EXPECT_EQ((*found)[0].second, 2u);
  EXPECT_TRUE(self_intersections(rectangle(0, 0, 3, 3), {}, diagnostics)->empty());
}

TEST(RegionErrors, NameWhatIsWrong) {
  const auto code_of = [](auto call) {
    Diagnostics diagnostics;
    EXPECT_FALSE(call(diagnostics).has_value());
    return diagnostics.list().empty() ? Code{} : diagnostics.list()[0].code;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Outline open = rectangle(0, 0, 1, 1);
  open.segments.pop_back();
  EXPECT_EQ(code_of([&](Diagnostics& d) { return make_region({open}, FillRule::nonzero, {}, d); }),
            codes::region_open_outline);
  EXPECT_EQ(code_of([&](Diagnostics& d) {
              return make_region({rectangle(0, nan, 1, 1)}, FillRule::nonzero, {}, d);
            }),
            codes::outline_not_finite);
  RegionOptions options;
  options.tolerance.weld = mm(-1.0);
  EXPECT_EQ(code_of([&](Diagnostics& d) { return unite({Region{{open}}}, options, d); }),
            codes::region_bad_argument);
}

/// Chains that are not closed have no winding numbers; only code inside the kernel can make them.
TEST(RegionErrors, ContradictionsAreFoundAndRefused) {
  region_detail::EdgeSet set(1e-6);
  region_detail::add_outline(set, rectangle(0, 0, 10, 10), 0, 0);
  set.close();
  region_detail::add_outline(set, {{5, 5}, {{{5, 15}, {}}}}, 4, 0);
  Diagnostics diagnostics;
  const auto inside = [](const region_detail::Winding& w) { return w.of[0] > 0; };
  EXPECT_FALSE(region_detail::arrange(set, {}, diagnostics, inside).has_value());
  ASSERT_TRUE(diagnostics.has_errors());
  EXPECT_EQ(diagnostics.list()[0].code, codes::region_unresolved);
}

/// Saw teeth along x and along y: every tooth crosses all of the others.
TEST(RegionErrors, TooManyCrossingsAreRefused) {
  constexpr int kTeeth = 4000;
  const auto saw = [](auto point) {
    Outline outline;
    outline.start = point(0.0, 0.0);
    for (int i = 1; i <= kTeeth; ++i) outline.segments.push_back({point(i, i % 2 == 0 ? 0.0 : kTeeth), {}});
    outline.segments.push_back({point(kTeeth, -1.0), {}});
    outline.segments.push_back({outline.start, {}});
    return outline;
  };
  Diagnostics diagnostics;
  const auto made = make_region({saw([](double a, double b) {
                                   return Point2{a, b};
                                 }),
                                 saw([](double a, double b) {
                                   return Point2{b, a};
                                 })},
                                FillRule::even_odd, {}, diagnostics);
  EXPECT_FALSE(made.has_value());
  ASSERT_TRUE(diagnostics.has_errors());
  EXPECT_EQ(diagnostics.list()[0].code, codes::region_too_complex);
}

/// A common side in both directions separates nothing, in both directions of winding.
TEST(RegionParts, ThatSeparateNothingAreRemoved) {
  region_detail::EdgeSet set(1e-6);
  region_detail::add_outline(set, rectangle(0, 0, 1, 1), 0, 0);
  region_detail::add_outline(set, rectangle(1, 0, 1, 1), 4, 0);
  set.close();
  Diagnostics diagnostics;
  const auto inside = [](const region_detail::Winding& w) { return w.of[0] > 0; };
  const auto made = region_detail::arrange(set, {}, diagnostics, inside);
  ASSERT_TRUE(made);
  std::size_t kept = 0;
  for (const region_detail::Part& part : made->arrangement.parts()) kept += part.kept ? 1 : 0;
  EXPECT_EQ(kept, 6u) << "of 8 sides, two of which are the same";
}

}  // namespace
}  // namespace kerf
