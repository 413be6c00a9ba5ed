// The burn of a laser against energies computed by hand: 4 P / (pi d v) on the centre line of a straight cut.
#include "kerf/sim/burn.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/codes/files.h"
#include "base/codes/path.h"
#include "base/codes/sim.h"

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

/// A laser of 5 W at S1000 with a beam of 0.2 mm. S500 and 20 mm/s: 2.5 W, 0.125 J per mm.
struct Job {
  Toolpath path;
  BurnOptions options{.beam = mm(0.2), .full_power = 5.0, .full_s = 1000.0};
  Diagnostics diagnostics{};

  template <class S>
  Job& add(const S& s) {
    path.add(s, OriginId::none);
    return *this;
  }
  Job& at(double x, double y) { return add(step::Rapid{{x, y, 0}}); }
  Job& on(double power, LaserMode mode = LaserMode::dynamic) { return add(step::LaserPower{mode, power}); }
  Job& off() { return add(step::LaserPower{}); }
  Job& cut(double x, double y, double feed = 1200) { return add(step::Cut{{x, y, 0}, mm_per_min(feed)}); }
  BurnMap map() {
    const auto made = map_burn(path, options, diagnostics);
    EXPECT_TRUE(made);
    return made.value_or(BurnMap{});
  }
};

/// The energy in the cells, J.
double energy_in(const BurnMap& map) {
  return std::accumulate(map.joules_per_mm2.begin(), map.joules_per_mm2.end(), 0.0) * map.cell * map.cell;
}

constexpr double kCells = 0.03;                             // of the energy: the beam is five cells wide
constexpr double kCentre = 4.0 * 2.5 / (kPi * 0.2 * 20.0);  // J/mm2, 0.7958

TEST(Burn, OfAStraightCut) {
  const BurnMap map = Job{}.at(0, 0).on(500).cut(20, 0).off().map();
  EXPECT_NEAR(map.joules, 2.5, 1e-9);
  EXPECT_NEAR(map.on.seconds(), 1.0, 1e-9);
  EXPECT_NEAR(map.cell, 0.04, 1e-9);
  EXPECT_NEAR(map.at({10, 0}), kCentre, 1e-5);
  // Beside the centre line the chord of the beam is shorter: 2 sqrt(r^2 - y^2).
  EXPECT_NEAR(map.at({10, 0.04}), kCentre * std::sqrt(1 - 0.4 * 0.4), 1e-5);
  EXPECT_NEAR(map.at({10, -0.08}), kCentre * std::sqrt(1 - 0.8 * 0.8), 1e-5);
  EXPECT_EQ(map.at({10, 0.13}), 0.0);
  EXPECT_NEAR(map.at({0, 0}), 0.5 * kCentre, 1e-5);  // half of the beam covers the start
  EXPECT_EQ(map.at({-0.11, 0}), 0.0);
  EXPECT_EQ(map.at({1e9, 1e9}), 0.0);
  EXPECT_NEAR(energy_in(map), 2.5, kCells * 2.5);
  EXPECT_NEAR(map.highest, kCentre, 1e-5);
  EXPECT_NEAR(map.burnt_mm2, 20 * 0.2 + kPi * 0.01, 0.1 * 4);
}

TEST(Burn, OfLinesInAnyDirection) {
  for (const double degrees_to_x : {17.0, 45.0, 90.0, 123.0, 180.0, 301.0}) {
    const double a = degrees_to_x * kPi / 180;
    const BurnMap map = Job{}.at(3, 2).on(500).cut(3 + 20 * std::cos(a), 2 + 20 * std::sin(a)).map();
    EXPECT_NEAR(map.joules, 2.5, 1e-9);
    EXPECT_NEAR(energy_in(map), 2.5, kCells * 2.5) << degrees_to_x;
    EXPECT_LE(map.highest, kCentre * (1 + 1e-6));
    EXPECT_GT(map.highest, 0.97 * kCentre);
  }
}

TEST(Burn, IsProportionalToPowerPassesAndTheInverseOfSpeed) {
  EXPECT_NEAR((Job{}.at(0, 0).on(1000).cut(20, 0).map().at({10, 0})), 2 * kCentre, 1e-5);
  EXPECT_NEAR((Job{}.at(0, 0).on(500).cut(20, 0, 300).map().at({10, 0})), 4 * kCentre, 1e-5);
  EXPECT_NEAR((Job{}.at(0, 0).on(500).cut(20, 0).cut(0, 0).map().at({10, 0})), 2 * kCentre, 1e-5);
  Job wide;
  wide.options.beam = mm(0.4);
  EXPECT_NEAR((wide.at(0, 0).on(500).cut(20, 0).map().at({10, 0})), 0.5 * kCentre, 1e-5);
}

TEST(Burn, OfAnArcIsThatOfItsLength) {
  Job job;
  job.at(0, 0).on(500);
  job.add(step::Arc{.to = {20, 0, 0}, .centre = {10, 0}, .turn = Turn::cw, .feed = mm_per_min(1200)});
  const BurnMap map = job.map();
  EXPECT_NEAR(map.joules, 10 * kPi * 0.125, 1e-3);
  EXPECT_NEAR(map.at({10, 10}), kCentre, 0.05 * kCentre);
  EXPECT_EQ(map.at({10, 0}), 0.0);
}

TEST(Burn, OfARasterIsPowerOverSpeedAndDistance) {
  Job job;
  job.options.cell = mm(0.01);
  job.at(0, 0).on(500);
  for (int row = 0; row <= 50; ++row)
    job.cut(row % 2 == 0 ? 10 : 0, 0.1 * row).cut(row % 2 == 0 ? 10 : 0, 0.1 * row + 0.1);
  const BurnMap map = job.map();
  double sum = 0.0;
  int cells = 0;
  for (double x = 3; x < 7; x += map.cell)
    for (double y = 1; y < 4; y += map.cell) sum += map.at({x, y}), ++cells;
  EXPECT_NEAR(sum / cells, 2.5 / (20 * 0.1), 0.01 * 1.25);
}

TEST(Burn, ABeamAtRestOfM3BurnsDeep) {
  Job job;
  job.at(0, 0).on(500, LaserMode::constant).cut(5, 0).add(step::Dwell{seconds(0.4)});
  EXPECT_NEAR(job.map().at({5, 0}), 1.0 / (kPi * 0.01) + 0.5 * kCentre, 1e-3);  // 1 J on the beam
  Job dynamic;
  dynamic.at(0, 0).on(500).cut(5, 0).add(step::Dwell{seconds(0.4)});
  EXPECT_NEAR(dynamic.map().joules, 5 * 0.125, 1e-9);
  Job after_rapid;
  after_rapid.at(0, 0).on(500, LaserMode::constant).add(step::Dwell{seconds(9)}).cut(5, 0).at(8, 0);
  EXPECT_NEAR(after_rapid.map().joules, 5 * 0.125, 1e-9);
  Job plunge;  // 2 mm at 2 mm/s: 1 s, 2.5 J
  plunge.at(0, 0).on(500).add(step::Cut{{0, 0, -2}, mm_per_min(120)});
  EXPECT_NEAR(plunge.map().at({0, 0}), 2.5 / (kPi * 0.01), 1e-3);
}

/// Two lines of 600 mm across a board with a beam of 0.1 mm: 2 x 600 x 0.1 mm2, and a round end each.
TEST(Burn, OfAThinBeamOnALargeBoard) {
  Job job;
  job.options.beam = mm(0.1);
  job.at(0, 0.013).on(500).cut(600, 0.013).at(0, 400).cut(600, 400);
  const BurnMap map = job.map();
  EXPECT_TRUE(job.diagnostics.list().empty());
  EXPECT_NEAR(map.burnt_mm2, 120.0, 0.02 * 120.0);
  EXPECT_NEAR(map.highest, 2.0 * kCentre, 0.01 * kCentre);
  EXPECT_LE(map.joules_per_mm2.size(), job.options.max_cells);
  EXPECT_NEAR(energy_in(map), map.joules, kCells * map.joules);
}

TEST(Burn, CellsTooCoarseForTheBeamAreAWarning) {
  Job job;
  job.options.max_cells = 10'000;
  job.at(0, 0).on(500).cut(300, 0).map();
  ASSERT_EQ(job.diagnostics.list().size(), 1u);
  EXPECT_EQ(job.diagnostics.list()[0].code, codes::burn_coarse);
}

TEST(Burn, CellsAreLargerOnLargeBoardsAndKeepTheEnergy) {
  Job job;
  job.options.max_cells = 10'000;
  const BurnMap map = job.at(0, 0).on(500).cut(300, 0).cut(300, 200).cut(0, 0).map();
  EXPECT_GT(map.cell, 0.5);
  EXPECT_LE(map.joules_per_mm2.size(), 12'000u);
  EXPECT_NEAR(map.joules, (500 + std::hypot(300, 200)) * 0.125, 1e-6);
  EXPECT_NEAR(energy_in(map), map.joules, 0.05 * map.joules);
}

TEST(Burn, PowersAboveFullPowerAreFullPowerWithAWarning) {
  Job job;
  const BurnMap map = job.at(0, 0).on(3000).cut(20, 0).map();
  EXPECT_NEAR(map.joules, 5.0, 1e-9);
  ASSERT_EQ(job.diagnostics.list().size(), 1u);
  EXPECT_EQ(job.diagnostics.list()[0].code, codes::path_spindle_range);
}

TEST(Burn, WhatIsNotMappedIsAWarning) {
  Job unknown;
  unknown.on(500).cut(20, 0).cut(30, 0);
  EXPECT_NEAR(unknown.map().joules, 10 * 0.125, 1e-9);
  ASSERT_EQ(unknown.diagnostics.list().size(), 1u);
  EXPECT_EQ(unknown.diagnostics.list()[0].code, codes::cut_at_unknown_place);
}

TEST(Burn, RefusesPathsWithoutABeamAndOptionsOutOfRange) {
  Job dark, spindle;
  dark.at(0, 0).on(0).cut(20, 0);
  EXPECT_FALSE(map_burn(dark.path, dark.options, dark.diagnostics));
  EXPECT_EQ(dark.diagnostics.list()[0].code, codes::nothing_to_cut);
  spindle.at(0, 0).cut(20, 0);
  EXPECT_FALSE(map_burn(spindle.path, spindle.options, spindle.diagnostics));
  EXPECT_FALSE(spindle.diagnostics.list()[0].hint.empty());
  for (const double wrong :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Job job;
    job.at(0, 0).on(500).cut(20, 0);
    for (BurnOptions options :
         {BurnOptions{.beam = mm(wrong)}, BurnOptions{.full_power = wrong}, BurnOptions{.full_s = wrong}})
      EXPECT_FALSE(map_burn(job.path, options, job.diagnostics)) << wrong;
    EXPECT_EQ(job.diagnostics.list()[0].code, codes::bad_resolution);
  }
}

TEST(Burn, ThePictureIsDarkWhereTheEnergyIs) {
  const BurnMap map = Job{}.at(0, 0).on(500).cut(20, 0).off().cut(20, 10).on(250).cut(0, 10).map();
  const Image image = draw_burn(map, 0.0, 300, 200);
  ASSERT_EQ(image.rgba.size(), 300u * 200u * 4u);
  const auto grey = [&](int x, int y) {
    const auto at = (static_cast<std::size_t>(y) * 300 + static_cast<std::size_t>(x)) * 4;
    return image.rgba[at] + image.rgba[at + 1] + image.rgba[at + 2];
  };
  const auto darkest = [&](int first, int last) {
    int least = 999;
    for (int y = first; y < last; ++y) least = std::min(least, grey(150, y));
    return least;
  };
  const int board = grey(2, 2);
  EXPECT_LT(darkest(150, 200), darkest(0, 50));  // rows from the top: high Y first, with half of the power
  EXPECT_LT(darkest(0, 50), board);
  EXPECT_EQ(darkest(80, 120), board);
  EXPECT_EQ(draw_burn(map, 0.0, -5, 100'000).height, 8192);
}

}  // namespace
}  // namespace kerf
