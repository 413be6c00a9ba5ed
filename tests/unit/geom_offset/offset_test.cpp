// Offsets and buffers whose areas and shapes are known.
#include "kerf/geom/offset.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "../geom_region/region_samples.h"
#include "base/codes/outline.h"

namespace kerf {
namespace {

class Offsets : public RegionTest {
 protected:
  Region offset_by(const Region& region, double by) {
    const auto found = offset(region, mm(by), {}, diagnostics);
    vanished = found->vanished;
    return found->region;
  }
  std::size_t vanished = 0;
};

TEST_F(Offsets, GrowWithRoundCornersAndShrinkWithSharpOnes) {
  const Region square = made({rectangle(0, 0, 10, 10)});
  EXPECT_NEAR(area(offset_by(square, 2.0)), 100.0 + 80.0 + 4.0 * kPi, 1e-11);
  EXPECT_NEAR(area(offset_by(square, -2.0)), 36.0, 1e-11);
  EXPECT_EQ(vanished, 0u);
  EXPECT_TRUE(offset_by(square, -5.0).empty());
  EXPECT_EQ(vanished, 1u);
  EXPECT_TRUE(offset_by(square, -50.0).empty());
}

TEST_F(Offsets, OfCirclesGrowByTheRadius) {
  const Region ring = made({circle(0, 0, 10), circle(0, 0, 4)}, FillRule::even_odd);
  EXPECT_NEAR(area(offset_by(ring, 1.0)), kPi * (121.0 - 9.0), 1e-10);
  EXPECT_NEAR(area(offset_by(ring, -2.5)), kPi * (7.5 * 7.5 - 6.5 * 6.5), 1e-10);
  EXPECT_NEAR(area(offset_by(ring, 5.0)), kPi * 225.0, 1e-10);  // the hole is gone
  EXPECT_EQ(vanished, 1u);
  EXPECT_TRUE(offset_by(ring, -3.5).empty());
}

TEST_F(Offsets, ThatShrinkFallApart) {
  // Two squares of 10 with a bridge of 2 between.
  const Region barbell = combined(made({rectangle(0, 0, 10, 10), rectangle(20, 0, 10, 10)}),
                                  made({rectangle(9, 4, 12, 2)}), Boolean::unite);
  const Region two = offset_by(barbell, -1.5);
  EXPECT_EQ(two.loops.size(), 2u);
  const Region grown = offset_by(two, 1.5);  // without the bridge, and nowhere beyond what was there
  EXPECT_EQ(grown.loops.size(), 2u);
  EXPECT_TRUE(combined(grown, barbell, Boolean::subtract).empty());
  EXPECT_LT(area(grown), 200.0);
}

TEST_F(Offsets, ThatGrowAndShrinkAgainKeepTheirRoundShape) {
  const Region round = offset_by(made({rectangle(0, 0, 30, 20)}), 5.0);
  const Region back = offset_by(offset_by(round, 3.0), -3.0);
  EXPECT_NEAR(area(back), area(round), 1e-9);
  EXPECT_EQ(back.loops[0].segments.size(), 8u);
}

TEST_F(Offsets, WithNecksThatCloseUpToRoundingKeepBothSides) {
  // Two squares of 10 with a bridge of 2: where it closes two squares of 8 are left, and what the bridge's
  // ends leave is at most the tolerance's width.
  const Region bridged = made({rectangle(0, 0, 10, 10), rectangle(9, 4, 12, 2), rectangle(20, 0, 10, 10)});
  EXPECT_NEAR(area(offset_by(bridged, -1.0)), 128.0 + 2.0 * (1.0 - 0.25 * kPi) * 2.0, 1e-4);
  EXPECT_NEAR(area(offset_by(bridged, -1.0 + 1e-9)), 128.0 + 2.0 * (1.0 - 0.25 * kPi) * 2.0, 1e-4);
  Region chained = bridged;
  for (int i = 0; i < 3; ++i) chained = offset_by(chained, -1.0 / 3.0);
  EXPECT_NEAR(area(chained), 128.0 + 2.0 * (1.0 - 0.25 * kPi) * 2.0, 1e-4);
}

TEST_F(Offsets, ScaleWithTheirTolerance) {
  RegionOptions options;
  options.tolerance.weld = mm(1e-3);
  const auto small = offset(made({rectangle(0, 0, 10, 10), circle(10, 10, 4)}), mm(-1.0), {}, diagnostics);
  const auto large = offset(*make_region({rectangle(0, 0, 1e4, 1e4), circle(1e4, 1e4, 4e3)},
                                         FillRule::nonzero, options, diagnostics),
                            mm(-1000.0), options, diagnostics);
  EXPECT_NEAR(area(large->region), 1e6 * area(small->region), 1e-3);
}

TEST_F(Offsets, OfPathsHaveRoundOrButtEnds) {
  const Outline path{{0, 0}, {{{10, 0}, {}}, {{10, 10}, {}}}};
  // Two strips of 20, less their overlap at the inner corner, and a quarter disc at the outer one.
  const double expected = 40.0 - 1.0 + 0.25 * kPi;
  EXPECT_NEAR(area(*buffer(path, mm(1.0), PathEnds::butt, {}, diagnostics)), expected, 1e-11);
  EXPECT_NEAR(area(*buffer(path, mm(1.0), PathEnds::round, {}, diagnostics)), expected + kPi, 1e-11);
  const auto ring = buffer(circle(0, 0, 5), mm(1.0), PathEnds::round, {}, diagnostics);
  EXPECT_NEAR(area(*ring), kPi * 20.0, 1e-10);
  EXPECT_NEAR(area(*buffer(circle(0, 0, 5), mm(6.0), PathEnds::round, {}, diagnostics)), kPi * 121.0, 1e-9);
}

/// An arc about (3, 4) in both directions: half widths below and above its radius of 5.
TEST_F(Offsets, BuffersOfArcsHaveTheAreaOfTheirSectors) {
  for (const double sweep : {0.5, 2.0, 4.5}) {
    const auto at = [](double angle) { return Point2{3 + 5 * std::cos(angle), 4 + 5 * std::sin(angle)}; };
    const Outline ccw{at(1), {{at(1 + sweep), at(1 + 0.5 * sweep)}}};
    const Outline cw{at(1 + sweep), {{at(1), at(1 + 0.5 * sweep)}}};
    for (const Outline& path : {ccw, cw}) {
      const auto area_of = [&](double half, PathEnds ends) {
        const auto found = buffer(path, mm(half), ends, {}, diagnostics);
        return found ? area(*found) : 0.0;
      };
      EXPECT_NEAR(area_of(1.0, PathEnds::butt), sweep * 5 * 2, 1e-9) << sweep;
      EXPECT_NEAR(area_of(0.3, PathEnds::round), sweep * 5 * 0.6 + kPi * 0.09, 1e-9) << sweep;
      if (sweep > kPi) continue;  // the sector beyond the centre would overlap the other
      EXPECT_NEAR(area_of(7.0, PathEnds::butt), 0.5 * sweep * (12 * 12 + 2 * 2), 1e-9) << sweep;
    }
  }
}

TEST_F(Offsets, ParallelCurvesRunInThePathsSense) {
  const Outline path{{0, 0}, {{{10, 0}, {}}, {{10, 10}, {}}}};
  const auto left = offset_path(path, mm(1.0), {}, diagnostics);
  ASSERT_EQ(left->size(), 1u);
  EXPECT_EQ((*left)[0].start, (Point2{0, 1}));
  EXPECT_EQ((*left)[0].segments.size(), 2u);  // the inner corner is sharp
  EXPECT_NEAR(length((*left)[0]).mm(), 18.0, 1e-12);
  const auto right = offset_path(path, mm(-1.0), {}, diagnostics);
  EXPECT_EQ((*right)[0].start, (Point2{0, -1}));
  EXPECT_NEAR(length((*right)[0]).mm(), 20.0 + 0.5 * kPi, 1e-12);
}

TEST_F(Offsets, WithMitresHaveTipsUpToTheLimit) {
  const Region square = made({rectangle(0, 0, 10, 10)});
  const auto mitred = [&](double by, double limit) {
    return offset(square, mm(by), {Join::mitre, limit}, {}, diagnostics)->region;
  };
  EXPECT_NEAR(area(mitred(1.0, 2.0)), 144.0, 1e-11);
  EXPECT_EQ(mitred(1.0, 2.0).loops[0].segments.size(), 4u);
  EXPECT_NEAR(area(mitred(-1.0, 2.0)), 64.0, 1e-11);
  // A tip is sqrt(2) from its corner; cut off at 1.2 it loses a right triangle of that height.
  const double lost = std::numbers::sqrt2 - 1.2;
  EXPECT_NEAR(area(mitred(1.0, 1.2)), 144.0 - 4.0 * lost * lost, 1e-11);
  EXPECT_EQ(mitred(1.0, 1.2).loops[0].segments.size(), 8u);
  // A hole's corners are outer corners of the material.
  const Region plate = made({rectangle(-20, -20, 50, 50), rectangle(0, 0, 10, 10)}, FillRule::even_odd);
  EXPECT_NEAR(area(offset(plate, mm(-1.0), {Join::mitre, 2.0}, {}, diagnostics)->region), 48.0 * 48.0 - 144.0,
              1e-9);
}

TEST_F(Offsets, NameTheSegmentsThatTheyAreParallelTo) {
  const Region square = made({rectangle(0, 0, 10, 10)});
  const auto grown = offset(square, mm(2.0), {}, diagnostics);
  ASSERT_EQ(grown->sources.size(), 1u);
  ASSERT_EQ(grown->sources[0].size(), 8u);
  const Outline& loop = grown->region.loops[0];
  for (std::size_t i = 0; i < 8; ++i) {
    const BoundaryElement source = grown->sources[0][i];
    const Outline& original = square.loops[source.loop];
    EXPECT_EQ(source.corner, loop.segments[i].via.has_value());
    const Point2 end = original.segments[source.segment].to;
    if (source.corner)
      EXPECT_NEAR(distance(*loop.segments[i].via, end), 2.0, 1e-12);
    else
      EXPECT_NEAR(distance(loop.segments[i].to, end), 2.0, 1e-12);
  }
}

/// Stops at the first question.
class StopAtOnce : public Progress {
 public:
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return ++asked > 0; }
  int asked = 0;
};

TEST_F(Offsets, CanBeStopped) {
  // A wave offset by many times its length: its offset curve intersects itself a few hundred thousand times.
  Outline wave{{0, 0}, {}};
  for (int i = 1; i <= 2000; ++i) wave.segments.push_back({{0.01 * i, i % 2 == 0 ? 0.0 : 5.0}, {}});
  wave.segments.push_back({{20.0, -5.0}, {}});
  wave.segments.push_back({{0.0, -5.0}, {}});
  wave.segments.push_back({{0, 0}, {}});
  const Region region{{wave}};
  StopAtOnce stop;
  RegionOptions options;
  options.progress = &stop;
  EXPECT_FALSE(offset(region, mm(3.0), options, diagnostics).has_value());
  EXPECT_GT(stop.asked, 0);
  EXPECT_TRUE(diagnostics.list().empty());
}

TEST(OffsetErrors, NameTheArgument) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Diagnostics diagnostics;
  EXPECT_FALSE(offset(Region{{rectangle(0, 0, 1, 1)}}, mm(nan), {}, diagnostics).has_value());
  EXPECT_FALSE(buffer(rectangle(0, 0, 1, 1), mm(0.0), PathEnds::round, {}, diagnostics).has_value());
  ASSERT_EQ(diagnostics.list().size(), 2u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::region_bad_argument);
  EXPECT_EQ(diagnostics.list()[1].code, codes::region_bad_argument);
}

}  // namespace
}  // namespace kerf
