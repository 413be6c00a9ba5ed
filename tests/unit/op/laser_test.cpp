// Lasers: what is burnt where and with which power, order, leads, tones, test grids, and bad input.
#include "kerf/op/laser.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "base/codes/op.h"
#include "swept.h"

namespace kerf {
namespace {

using namespace test;

/// A motion at feed, with the power of the beam.
struct Burn {
  Point2 from, to;
  double s = 0.0, feed = 0.0;  // mm/min
  double length = 0.0;
  bool arc = false;
  std::vector<Point2> points;  // along it
};

/// The motions at feed of a path. Checks what holds for all paths of lasers: power 0 in rapids, Z unknown,
/// the beam off at the end.
std::vector<Burn> burns(const Toolpath& path) {
  std::vector<Burn> list;
  step::LaserPower beam;
  PathPosition here;
  for (const Step& s : path.steps()) {
    if (s.kind() == StepKind::laser_power) beam = s.laser_power();
    if (!s.is_motion()) continue;
    EXPECT_EQ(s.unknown_axes(), 4u);
    EXPECT_NE(beam.mode, LaserMode::off);
    if (s.kind() == StepKind::rapid) {
      EXPECT_EQ(beam.power, 0.0);
    } else {
      Burn burn{here.at.xy(), s.to().xy(), beam.power, s.feed().mm_per_min(), 0.0, false, {}};
      burn.arc = s.kind() == StepKind::arc;
      const int chords = burn.arc ? 200 : 20;
      for (int k = 0; k <= chords; ++k) {
        const double t = double(k) / chords;
        burn.points.push_back(burn.arc ? walk_of(s, here.at).at(t).xy()
                                       : burn.from + t * (burn.to - burn.from));
        if (k > 0) burn.length += distance(burn.points[burn.points.size() - 2], burn.points.back());
      }
      list.push_back(std::move(burn));
    }
    here.pass(s);
  }
  EXPECT_EQ(beam.mode, LaserMode::off);
  return list;
}

double burnt_length(const std::vector<Burn>& list) {
  double sum = 0.0;
  for (const Burn& burn : list) sum += burn.s > 0.0 ? burn.length : 0.0;
  return sum;
}

LaserOptions usual(double power = 0.5, double feed = 600) {
  LaserOptions options;
  options.power = power, options.feed = mm_per_min(feed);
  return options;
}

/// The distance of a point from a rectangle's inside, below 0 in it.
double from_rectangle(Point2 p, double x0, double y0, double x1, double y1) {
  const double dx = std::max(x0 - p.x, p.x - x1), dy = std::max(y0 - p.y, p.y - y1);
  return dx > 0.0 && dy > 0.0 ? std::hypot(dx, dy) : std::max(dx, dy);
}

TEST(LaserCut, TheBeamIsHalfAKerfBesideThePartAndItsHolesComeFirst) {
  const Region part = region_of({rectangle(0, 0, 40, 30), as_outline({{20, 15}, mm(6)})});
  Diagnostics diagnostics;
  const auto made = laser_cut(part, {.laser = usual(), .kerf = mm(0.4)}, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_TRUE(diagnostics.list().empty());
  const std::vector<Burn> list = burns(made->path);
  EXPECT_NEAR(burnt_length(list), 2 * (40 + 30) + 2 * std::numbers::pi * (0.2 + 5.8), 2e-3);
  for (const Burn& burn : list) {
    EXPECT_EQ(burn.s, 500.0);
    EXPECT_EQ(burn.feed, 600.0);
    for (const Point2 p : burn.points) {
      const double hole = 6 - distance(p, {20, 15}), outside = from_rectangle(p, 0, 0, 40, 30);
      EXPECT_NEAR(std::max(hole, outside), 0.2, 1e-4);
    }
  }
  EXPECT_LT(distance(list.front().from, {20, 15}), 6.0);
}

TEST(LaserCut, AnOpeningIsCutOnItsInside) {
  Diagnostics diagnostics;
  LaserCutOptions options{.laser = usual(), .kerf = mm(0.4), .side = ContourSide::inside};
  options.laser.passes = 3;
  const auto made = laser_cut(region_of({rectangle(0, 0, 40, 30)}), options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_NEAR(burnt_length(burns(made->path)), 3 * 2 * (39.6 + 29.6), 1e-6);
}

TEST(LaserCut, LeadsAreInWhatFallsOff) {
  for (const LeadKind kind : {LeadKind::arc, LeadKind::line})
    for (const ContourSide side : {ContourSide::outside, ContourSide::inside}) {
      LaserCutOptions options{.laser = usual(), .kerf = mm(0.2), .side = side};
      options.lead_in = options.lead_out = {kind, mm(2)};
      options.overlap = mm(1);
      Diagnostics diagnostics;
      const auto made = laser_cut(region_of({rectangle(0, 0, 40, 30)}), options, diagnostics);
      ASSERT_TRUE(made);
      const std::vector<Burn> list = burns(made->path);
      const double sign = side == ContourSide::outside ? 1.0 : -1.0;
      for (const Burn& burn : list)
        for (const Point2 p : burn.points) EXPECT_GE(sign * from_rectangle(p, 0, 0, 40, 30), 0.1 - 1e-3);
      const double chord = kind == LeadKind::arc ? 2.0 * std::numbers::sqrt2 : 2.0;
      EXPECT_NEAR(distance(list.front().from, list.front().to), chord, 1e-6);
      EXPECT_NEAR(distance(list.back().from, list.back().to), chord, 1e-6);
      EXPECT_GT(sign * from_rectangle(list.front().from, 0, 0, 40, 30), 1.0);
      EXPECT_GT(sign * from_rectangle(list.back().to, 0, 0, 40, 30), 1.0);
      const double lead = kind == LeadKind::arc ? std::numbers::pi : 2.0;
      const double around =
          side == ContourSide::outside ? 2 * (40 + 30) + 2 * std::numbers::pi * 0.1 : 2 * (39.8 + 29.8);
      EXPECT_NEAR(burnt_length(list), around + 1.0 + 2 * lead, 2e-3);
    }
}

TEST(LaserCut, ALeadThatDoesNotFitIsLeftOut) {
  LaserCutOptions options{.laser = usual(), .kerf = mm(0.2), .side = ContourSide::inside};
  options.lead_in = {LeadKind::arc, mm(4)};
  Diagnostics diagnostics;
  const auto made = laser_cut(region_of({rectangle(0, 0, 40, 3)}), options, diagnostics);
  ASSERT_TRUE(made);
  EXPECT_NEAR(burnt_length(burns(made->path)), 2 * (39.8 + 2.8), 1e-6);
}

TEST(LaserCut, AKerfWiderThanAnOpeningIsReported) {
  Diagnostics diagnostics;
  LaserCutOptions options{.laser = usual(), .kerf = mm(2), .side = ContourSide::inside};
  EXPECT_FALSE(laser_cut(region_of({rectangle(0, 0, 40, 1)}), options, diagnostics));
  EXPECT_EQ(diagnostics.list().front().code, codes::op_tool_wide);
  Diagnostics warned;
  const Region part = region_of({rectangle(0, 0, 40, 30), as_outline({{20, 15}, mm(0.5)})});
  EXPECT_TRUE(laser_cut(part, {.laser = usual(), .kerf = mm(2)}, warned));
  ASSERT_EQ(warned.list().size(), 1u);
  EXPECT_EQ(warned.list().front().code, codes::op_tool_wide);
  EXPECT_FALSE(warned.has_errors());
}

TEST(LaserLines, PassesOfAnOpenLineGoBackAndForth) {
  LaserOptions options = usual(1.0, 1200);
  options.passes = 2, options.mode = LaserMode::constant;
  Diagnostics diagnostics;
  const auto made = laser_lines({Outline{{0, 0}, {{{30, 0}, {}}}}}, options, diagnostics);
  ASSERT_TRUE(made);
  const std::vector<Burn> list = burns(made->path);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].to, (Point2{30, 0}));
  EXPECT_EQ(list[1].to, (Point2{0, 0}));
  EXPECT_EQ(made->path[0].laser_power().mode, LaserMode::constant);
}

TEST(LaserFill, LinesCoverTheRegionAndRunOnBeyondIt) {
  const Region ring = region_of({as_outline({{0, 0}, mm(10)}), as_outline({{0, 0}, mm(4)})});
  for (const double angle : {0.0, 33.0, 90.0}) {
    Diagnostics diagnostics;
    const auto made =
        laser_fill(ring, degrees(angle), {.interval = mm(0.1), .overscan = mm(3)}, usual(), diagnostics);
    ASSERT_TRUE(made);
    const std::vector<Burn> list = burns(made->path);
    EXPECT_NEAR(0.1 * burnt_length(list), std::numbers::pi * (100 - 16), 0.3);
    double beyond = 0.0;
    for (const Burn& burn : list)
      for (const Point2 p : burn.points) {
        const double r = length(p);
        if (burn.s > 0.0) {
          EXPECT_TRUE(r > 4 - 1e-6 && r < 10 + 1e-6) << r;
        }
        beyond = std::max(beyond, r);
      }
    EXPECT_NEAR(beyond, 13.0, 0.1);
  }
}

TEST(LaserFill, DirectionsOfTheLines) {
  for (const bool one_way : {false, true}) {
    Diagnostics diagnostics;
    const auto made =
        laser_fill(region_of({rectangle(0, 0, 20, 4)}), {},
                   {.interval = mm(1), .overscan = mm(0), .one_way = one_way}, usual(), diagnostics);
    ASSERT_TRUE(made);
    const std::vector<Burn> list = burns(made->path);
    ASSERT_EQ(list.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_DOUBLE_EQ(list[i].from.y, 0.5 + double(i));
      EXPECT_EQ(list[i].to.x > list[i].from.x, one_way || i % 2 == 0);
    }
  }
}

TEST(LaserPicture, TonesBecomePowersRowByRowFromTheBottom) {
  const GreyPicture picture{3, 2, {0, 255, 51, 204, 204, 255}};
  LaserPictureOptions options{
      .laser = usual(0.8), .scan = {.interval = mm(10), .overscan = mm(5)}, .at = {100, 50}, .width = mm(30)};
  Diagnostics diagnostics;
  const auto made = laser_picture(picture, options, diagnostics);
  ASSERT_TRUE(made);
  const std::vector<Burn> list = burns(made->path);
  // Lower row: 5 mm without power, two pixels at 20%, 5 mm without power; then back over the upper row.
  ASSERT_EQ(list.size(), 3u + 5u);
  EXPECT_EQ(list[0].from, (Point2{95, 55}));
  EXPECT_EQ(list[0].s, 0.0);
  EXPECT_EQ(list[1].from, (Point2{100, 55}));
  EXPECT_EQ(list[1].to, (Point2{120, 55}));
  EXPECT_EQ(list[1].s, 160.0);
  EXPECT_EQ(list[2].to, (Point2{125, 55}));
  EXPECT_EQ(list[3].from, (Point2{135, 65}));
  EXPECT_EQ(list[4].s, 640.0);
  EXPECT_EQ(list[4].to, (Point2{120, 65}));
  EXPECT_EQ(list[5].s, 0.0);  // the white pixel
  EXPECT_EQ(list[6].s, 800.0);
  EXPECT_EQ(list[6].to, (Point2{100, 65}));
  EXPECT_EQ(list[7].to, (Point2{95, 65}));
}

TEST(LaserPicture, MinimumGammaAndNegative) {
  const GreyPicture picture{2, 1, {204, 255}};  // darkness 0.2 and 0
  LaserPictureOptions options{.laser = usual(1.0), .scan = {.interval = mm(10)}, .width = mm(20)};
  const auto first_power = [&] {
    Diagnostics diagnostics;
    const auto made = laser_picture(picture, options, diagnostics);
    double highest = 0.0;
    for (const Burn& burn : burns(made->path)) highest = std::max(highest, burn.s);
    return highest;
  };
  options.gamma = 2.0;
  EXPECT_EQ(first_power(), 40.0);
  options.min_power = 0.1;
  EXPECT_EQ(first_power(), 136.0);  // 100 + 0.04 * 900
  options.gamma = 1.0, options.min_power = 0.0, options.negative = true;
  EXPECT_EQ(first_power(), 1000.0);
}

TEST(LaserPicture, PixelsOfTheFileAreAveraged) {
  // 4 x 4 pixels on 2 x 2: a half black, a quarter black, all white, all black.
  const GreyPicture picture{4, 4, {0, 255, 0, 255, 0, 255, 255, 255, 255, 255, 0, 0, 255, 255, 0, 0}};
  LaserPictureOptions options{
      .laser = usual(1.0), .scan = {.interval = mm(5), .overscan = mm(0)}, .width = mm(10)};
  Diagnostics diagnostics;
  const auto made = laser_picture(picture, options, diagnostics);
  ASSERT_TRUE(made);
  std::vector<double> powers;
  for (const Burn& burn : burns(made->path))
    if (burn.s > 0.0) powers.push_back(burn.s);
  EXPECT_EQ(powers, (std::vector<double>{1000, 250, 500}));
}

TEST(LaserPicture, DitheredTonesKeepTheirMean) {
  for (const int grey : {10, 64, 128, 200, 250}) {
    GreyPicture picture{50, 50, std::vector<std::uint8_t>(2500, static_cast<std::uint8_t>(grey))};
    LaserPictureOptions options{
        .laser = usual(0.7), .scan = {.interval = mm(0.1)}, .width = mm(20), .tones = PictureTones::dither};
    Diagnostics diagnostics;
    const auto made = laser_picture(picture, options, diagnostics);
    ASSERT_TRUE(made);
    const std::vector<Burn> list = burns(made->path);
    for (const Burn& burn : list) EXPECT_TRUE(burn.s == 0.0 || burn.s == 700.0);
    EXPECT_NEAR(0.1 * burnt_length(list) / 400.0, 1.0 - grey / 255.0, 0.01);
  }
}

TEST(LaserTest, TheFocusTestInOneCall) {
  LaserTestOptions options{.laser = usual(1.0), .cell_width = mm(100), .gap = mm(4)};
  options.laser.mode = LaserMode::constant;
  options.powers = {1.0};
  for (const double feed : {1200, 1000, 800, 600, 400}) options.feeds.push_back(mm_per_min(feed));
  Diagnostics diagnostics;
  const auto made = laser_test(options, diagnostics);
  ASSERT_TRUE(made);
  const std::vector<Burn> list = burns(made->path);
  ASSERT_EQ(list.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(list[i].from, (Point2{0, 16 - 4 * double(i)}));
    EXPECT_EQ(list[i].to, (Point2{100, 16 - 4 * double(i)}));
    EXPECT_EQ(list[i].feed, 1200 - 200 * double(i));
    EXPECT_EQ(list[i].s, 1000.0);
  }
}

TEST(LaserTest, CellsOfPowersAndFeedsWithLabels) {
  LaserTestOptions options{
      .laser = usual(0.3, 2000), .at = {50, 20}, .cell_height = mm(5), .label_height = mm(3)};
  options.scan = {.interval = mm(0.5), .overscan = mm(1)};
  options.powers = {0.2, 0.9}, options.feeds = {mm_per_min(900), mm_per_min(600), mm_per_min(300)};
  Diagnostics diagnostics;
  const auto made = laser_test(options, diagnostics);
  ASSERT_TRUE(made);
  double cells[3][2] = {};
  double labels = 0.0;
  for (const Burn& burn : burns(made->path)) {
    if (!(burn.s > 0.0)) continue;
    if (burn.feed == 2000.0) {
      EXPECT_TRUE(burn.to.x < 50 || burn.to.y < 20);
      EXPECT_EQ(burn.s, 300.0);
      labels += burn.length;
      continue;
    }
    const int row = 2 - static_cast<int>((burn.from.y - 20) / 9), column = burn.from.x < 61 ? 0 : 1;
    EXPECT_EQ(burn.feed, 900.0 - 300.0 * row);
    EXPECT_EQ(burn.s, column == 0 ? 200.0 : 900.0);
    cells[row][column] += 0.5 * burn.length;
  }
  for (const auto& row : cells)
    for (const double area : row) EXPECT_NEAR(area, 50.0, 1e-6);
  EXPECT_GT(labels, 50.0);
}

TEST(LaserFrame, AroundTheBox) {
  Diagnostics diagnostics;
  const auto made = laser_frame({{1, 2}, {31, 22}}, usual(0.0, 3000), diagnostics);
  ASSERT_TRUE(made);
  const std::vector<Burn> list = burns(made->path);
  ASSERT_EQ(list.size(), 4u);
  EXPECT_EQ(list[1].to, (Point2{31, 22}));
  EXPECT_EQ(list[3].to, (Point2{1, 2}));
  EXPECT_EQ(burnt_length(list), 0.0);
}

TEST(Laser, BadOptionsAreErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Region part = region_of({rectangle(0, 0, 40, 30)});
  const auto refused = [&](auto change) {
    LaserCutOptions options{.laser = usual(), .kerf = mm(0.2)};
    ScanOptions scan;
    change(options, scan);
    Diagnostics diagnostics;
    const bool made =
        laser_cut(part, options, diagnostics) && laser_fill(part, {}, scan, options.laser, diagnostics);
    return !made && diagnostics.has_errors();
  };
  EXPECT_FALSE(refused([](auto&, auto&) {}));
  for (const double bad : {nan, inf, -1.0}) {
    EXPECT_TRUE(refused([&](auto& o, auto&) { o.laser.power = bad; }));
    EXPECT_TRUE(refused([&](auto& o, auto&) { o.laser.full_s = bad; }));
    EXPECT_TRUE(refused([&](auto& o, auto&) { o.laser.feed = mm_per_min(bad); }));
    EXPECT_TRUE(refused([&](auto& o, auto&) { o.kerf = mm(bad); }));
    EXPECT_TRUE(refused([&](auto& o, auto&) { o.overlap = mm(bad); }));
    EXPECT_TRUE(refused([&](auto& o, auto&) { o.lead_in = {LeadKind::arc, mm(bad)}; }));
    EXPECT_TRUE(refused([&](auto&, auto& s) { s.interval = mm(bad); }));
    EXPECT_TRUE(refused([&](auto&, auto& s) { s.overscan = mm(bad); }));
  }
  EXPECT_TRUE(refused([&](auto& o, auto&) { o.laser.passes = 0; }));
  EXPECT_TRUE(refused([&](auto& o, auto&) { o.laser.mode = LaserMode::off; }));
  EXPECT_TRUE(refused([&](auto&, auto& s) { s.interval = mm(0); }));
  EXPECT_TRUE(refused([&](auto& o, auto&) { o.laser.max_steps = 3; }));
}

TEST(Laser, BadPicturesTestsAndFramesAreErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Diagnostics diagnostics;
  LaserPictureOptions picture{.laser = usual(), .width = mm(10)};
  EXPECT_FALSE(laser_picture({}, picture, diagnostics));
  EXPECT_FALSE(laser_picture({3, 2, {1, 2}}, picture, diagnostics));
  EXPECT_FALSE(laser_picture({-1, -1, {1}}, picture, diagnostics));
  const GreyPicture pixel{1, 1, {0}};
  EXPECT_TRUE(laser_picture(pixel, picture, diagnostics));
  const auto refused = [&](auto change) {
    LaserPictureOptions changed = picture;
    change(changed);
    return !laser_picture(pixel, changed, diagnostics);
  };
  EXPECT_TRUE(refused([&](auto& o) { o.width = mm(nan); }));
  EXPECT_TRUE(refused([&](auto& o) { o.width = mm(1e6); }));  // more pixels than the limit
  EXPECT_TRUE(refused([&](auto& o) { o.gamma = 0.0; }));
  EXPECT_TRUE(refused([&](auto& o) { o.min_power = 0.9; }));
  EXPECT_TRUE(refused([&](auto& o) { o.at.y = nan; }));
  LaserTestOptions test{.laser = usual()};
  EXPECT_FALSE(laser_test(test, diagnostics));  // no cells
  test.powers = {0.5}, test.feeds = {mm_per_min(nan)};
  EXPECT_FALSE(laser_test(test, diagnostics));
  EXPECT_FALSE(laser_frame({}, usual(), diagnostics));
  EXPECT_FALSE(laser_lines({}, usual(), diagnostics));
  EXPECT_FALSE(laser_lines({Outline{{nan, 0}, {{{1, 1}, {}}}}}, usual(), diagnostics));
  EXPECT_FALSE(laser_cut({}, {.laser = usual()}, diagnostics));
}

}  // namespace
}  // namespace kerf
