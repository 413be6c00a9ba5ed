// Regions of known areas and shapes: boolean operations and queries.
#include "kerf/region.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

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
                      {},
                      {{{4, 0}, {}, {}},
                       {{4, 4}, {}, {}},
                       {{1, 4}, {}, {}},
                       {{1, 1}, {}, {}},
                       {{3, 1}, {}, {}},
                       {{3, 3}, {}, {}},
                       {{0, 3}, {}, {}},
                       {{0, 0}, {}, {}}}};
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
                         {},
                         {{{10, 0}, {}, {}},
                          {{10, 5 - e}, {}, {}},
                          {{20, 5 - e}, {}, {}},
                          {{20, 0}, {}, {}},
                          {{30, 0}, {}, {}},
                          {{30, 10}, {}, {}},
                          {{20, 10}, {}, {}},
                          {{20, 5 + e}, {}, {}},
                          {{10, 5 + e}, {}, {}},
                          {{10, 10}, {}, {}},
                          {{0, 10}, {}, {}},
                          {{0, 0}, {}, {}}}};
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

TEST_F(Regions, ReportSelfIntersections) {
  const Outline bow{{0, 0}, {}, {{{4, 4}, {}, {}}, {{4, 0}, {}, {}}, {{0, 4}, {}, {}}, {{0, 0}, {}, {}}}};
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
            Code::region_open_outline);
  EXPECT_EQ(code_of([&](Diagnostics& d) {
              return make_region({rectangle(0, nan, 1, 1)}, FillRule::nonzero, {}, d);
            }),
            Code::outline_not_finite);
  RegionOptions options;
  options.tolerance.weld = mm(-1.0);
  EXPECT_EQ(code_of([&](Diagnostics& d) { return unite({Region{{open}}}, options, d); }),
            Code::region_bad_argument);
}

/// Chains that are not closed have no winding numbers; only code inside the kernel can make them.
TEST(RegionErrors, ContradictionsAreFoundAndRefused) {
  region_detail::EdgeSet set(1e-6);
  region_detail::add_outline(set, rectangle(0, 0, 10, 10), 0, 0);
  set.close();
  region_detail::add_outline(set, {{5, 5}, {}, {{{5, 15}, {}, {}}}}, 4, 0);
  Diagnostics diagnostics;
  const auto inside = [](const region_detail::Winding& w) { return w.of[0] > 0; };
  EXPECT_FALSE(region_detail::arrange(set, {}, diagnostics, inside).has_value());
  ASSERT_TRUE(diagnostics.has_errors());
  EXPECT_EQ(diagnostics.list()[0].code, Code::region_unresolved);
}

/// Saw teeth along x and along y: every tooth crosses all of the others.
TEST(RegionErrors, TooManyCrossingsAreRefused) {
  constexpr int kTeeth = 4000;
  const auto saw = [](auto point) {
    Outline outline;
    outline.start = point(0.0, 0.0);
    for (int i = 1; i <= kTeeth; ++i)
      outline.segments.push_back({point(i, i % 2 == 0 ? 0.0 : kTeeth), {}, {}});
    outline.segments.push_back({point(kTeeth, -1.0), {}, {}});
    outline.segments.push_back({outline.start, {}, {}});
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
  EXPECT_EQ(diagnostics.list()[0].code, Code::region_too_complex);
}

}  // namespace
}  // namespace kerf
