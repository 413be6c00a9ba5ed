// Prints with known volumes.
#include "kerf/sim/print.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "base/codes/sim.h"
#include "path/bead.h"
#include "sim/print/beads.h"

namespace kerf::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWidth = 0.5, kHeight = 0.2;
constexpr double kArea = (kWidth - kHeight) * kHeight + kPi * kHeight * kHeight / 4.0;
/// The volume of two ends of a bead: half a cylinder and a quarter of the outer half of a torus each.
constexpr double kFlat = (kWidth - kHeight) / 2.0, kRound = kHeight / 2.0;
constexpr double kEnds = kPi * kFlat * kFlat * kHeight + kPi * kPi * kFlat * kRound * kRound +
                         4.0 / 3.0 * kPi * kRound * kRound * kRound;

/// Toolpaths of a printer; beads are kWidth wide by default.
class Print {
 public:
  Print& travel(Point3 to) {
    path_.add(step::Cut{to, mm_per_min(6000)}, OriginId::none);
    return arrive(to);
  }
  Print& bead(Point3 to, double width = kWidth, double height = kHeight) {
    const double area = (width - height) * height + kPi * height * height / 4.0;
    return push(to, area * distance(at_.xy(), to.xy()));
  }
  Print& push(Point3 to, double volume, Length width = mm(0), Length height = mm(0)) {
    path_.add(step::Extrude{to, mm3(volume), width, height, mm_per_min(1200)}, OriginId::none);
    return arrive(to);
  }
  Print& line(Point3 from, Point3 to) { return travel(from).bead(to); }
  const Toolpath& path() const { return path_; }
  Toolpath& path() { return path_; }

 private:
  Print& arrive(Point3 to) {
    at_ = to;
    return *this;
  }
  Toolpath path_;
  Point3 at_;
};

PrintSimulation run(const Print& print, double pitch, PrintOptions options = {}) {
  options.resolution = mm(pitch);
  Diagnostics diagnostics;
  auto result = simulate_print(print.path(), options, diagnostics);
  EXPECT_TRUE(result && diagnostics.list().empty())
      << (diagnostics.list().empty() ? "" : to_string(diagnostics.list().front()));
  return result ? std::move(*result) : PrintSimulation{};
}

/// The material of all columns, mm3, without the scaling by layer.
double in_columns(const PrintSimulation& s) {
  double sum = 0.0;
  for (const Interval& run : s.columns.intervals)
    sum += static_cast<double>(run.high) - static_cast<double>(run.low);
  return sum * s.columns.pitch * s.columns.pitch;
}

std::size_t count(const PrintSimulation& s, PrintHazardKind kind) {
  return static_cast<std::size_t>(std::count_if(s.hazards.begin(), s.hazards.end(),
                                                [&](const PrintHazard& h) { return h.kind == kind; }));
}

TEST(PrintSection, TwoOfThreeDetermineTheThird) {
  const auto section = printing::section_of(kArea, kHeight);
  EXPECT_NEAR(section.width, kWidth, 1e-12);
  EXPECT_NEAR(printing::height_of(kArea, kWidth), kHeight, 1e-12);
  EXPECT_NEAR(bead_volume(mm(3), mm(kWidth), mm(kHeight)).mm3(), 3 * kArea, 1e-12);
  const double round = kPi / 4.0 * 0.15 * 0.15;  // a bead thinner than the layer
  EXPECT_NEAR(printing::section_of(round, kHeight).width, 0.15, 1e-12);
  EXPECT_NEAR(printing::section_of(round, kHeight).height, 0.15, 1e-12);
  EXPECT_NEAR(printing::height_of(round, 0.15), 0.15, 1e-9);
  EXPECT_EQ(printing::height_of(1.01 * round, 0.15), 0.0);
}

TEST(Print, ASingleBeadHasItsSectionTimesItsLengthAndItsEnds) {
  const auto s = run(Print().travel({5, 5, kHeight}).bead({15, 12, kHeight}), 0.02);
  const double volume = kArea * std::hypot(10.0, 7.0);
  EXPECT_NEAR(s.total.extruded.mm3(), volume, 1e-12);
  EXPECT_NEAR(s.total.ends.mm3(), kEnds, 0.02 * kEnds);
  EXPECT_EQ(s.total.overlap.mm3(), 0.0);
  EXPECT_NEAR(s.total.laid.mm3(), volume + kEnds, 0.02 * kEnds);
  EXPECT_NEAR(in_columns(s), s.total.laid.mm3(),
              2e-3 * volume);  // an oblique bead has all phases relative to the grid
  EXPECT_EQ(s.beads, 1u);
  ASSERT_EQ(s.layers.size(), 1u);
  EXPECT_EQ(s.layers[0].z, mm(kHeight));
  EXPECT_NEAR(s.layers[0].height.mm(), kHeight, 1e-12);
  EXPECT_TRUE(s.hazards.empty());
}

/// The overlap of two parallel beads, mm2: the intersection of their sections, by fine summation.
double overlap_area(double spacing) {
  double sum = 0.0;
  constexpr double kStep = 1e-5;
  const auto half = [](double v) {
    v = std::abs(v);
    if (v <= kFlat) return kRound;
    return v < kFlat + kRound ? std::sqrt(kRound * kRound - (v - kFlat) * (v - kFlat)) : 0.0;
  };
  for (double v = -1.0; v < 1.0; v += kStep) sum += 2.0 * std::min(half(v), half(v - spacing)) * kStep;
  return sum;
}

TEST(Print, ParallelBeadsOverlapByTheirSections) {
  for (const double spacing : {kWidth - 0.1, kWidth - kHeight * (1.0 - kPi / 4.0), kWidth, kWidth + 0.05}) {
    Print print;
    print.line({1, 1, kHeight}, {31, 3, kHeight});
    const Point2 across{-2.0 / std::hypot(30.0, 2.0), 30.0 / std::hypot(30.0, 2.0)};
    const Point3 shift{spacing * across.x, spacing * across.y, 0};
    print.line(Point3{1, 1, kHeight} + shift, Point3{31, 3, kHeight} + shift);
    const auto s = run(print, 0.02);
    const double length = std::hypot(30.0, 2.0);
    EXPECT_NEAR(s.total.overlap.mm3(), overlap_area(spacing) * length, 2e-3 * kArea * length) << spacing;
    EXPECT_TRUE(s.hazards.empty());
  }
}

/// 40 beads of 20 mm, 0.45 mm wide, 0.42 mm apart and turned: neighbours share a lens of their round sides,
/// two circles of radius 0.1 mm whose centres are 0.17 mm apart.
TEST(Print, OverlapDependsNeitherOnTheDirectionNorOnTheColumns) {
  constexpr double kRadius = 0.1, kApart = 0.17, kLength = 20.0, kSpacing = 0.42;
  constexpr int kBeads = 40;
  const double lens = 2.0 * kRadius * kRadius * std::acos(kApart / (2.0 * kRadius)) -
                      0.5 * kApart * std::sqrt(4.0 * kRadius * kRadius - kApart * kApart);
  const double overlap = (kBeads - 1) * kLength * lens;
  const double extruded = kBeads * bead_volume(mm(kLength), mm(0.45), mm(0.2)).mm3();
  for (const double degrees : {0.0, 90.0, 45.0, 17.0}) {
    const double turn = degrees / 180.0 * kPi;
    const Point2 along{std::cos(turn), std::sin(turn)}, across{-along.y, along.x};
    Print print;
    for (int i = 0; i < kBeads; ++i) {
      const Point2 from = (i * kSpacing) * across, to = from + kLength * along;
      print.travel({from.x, from.y, 0.2}).bead({to.x, to.y, 0.2}, 0.45, 0.2);
    }
    for (const double pitch : {0.05, 0.09, 0.2}) {
      const auto s = run(print, pitch);
      EXPECT_NEAR(s.total.overlap.mm3(), overlap, 0.01 * overlap) << degrees << " degrees, " << pitch;
      EXPECT_NEAR((s.total.laid - s.total.ends).mm3(), extruded - overlap, 0.001 * extruded) << degrees;
    }
  }
}

TEST(Print, FiguresNeedNoSimulation) {
  Print print;
  print.line({0, 0, 0.2}, {10, 0, 0.2}).line({0, 0, 0.5}, {0, 20, 0.5});
  const auto f = figures_of_print(print.path(), {});
  EXPECT_EQ(f.beads, 2u);
  EXPECT_NEAR(f.extruded.mm3(), 30 * kArea, 1e-12);
  EXPECT_EQ(f.blobs.mm3(), 0.0);
  EXPECT_NEAR(f.bead_length.mm(), 30.0, 1e-12);
  ASSERT_EQ(f.layers.size(), 2u);
  EXPECT_NEAR(f.layers[0].height.mm(), 0.2, 1e-12);
  EXPECT_NEAR(f.layers[1].z.mm(), 0.5, 1e-12);
  EXPECT_NEAR(f.layers[1].height.mm(), 0.3, 1e-12);  // from the step in Z
  EXPECT_EQ(f.first_bead, 1u);
  EXPECT_FALSE(figures_of_print(Toolpath{}, {}).first_bead);
}

TEST(Print, CrossingBeadsOverlapOnce) {
  const auto s =
      run(Print().line({0, 10, kHeight}, {20, 10, kHeight}).line({10, 0, kHeight}, {10, 20, kHeight}), 0.01);
  // Two crossing beads: the integral of (2 half width at z)^2 over z.
  const double square = 4.0 * (kFlat * kFlat * kHeight + 2.0 * kFlat * kPi * kRound * kRound / 2.0 +
                               4.0 / 3.0 * kRound * kRound * kRound);
  EXPECT_NEAR(s.total.overlap.mm3(), square, 0.02 * square);
  EXPECT_EQ(s.total.hollow.mm3() > 0.0, true);  // below the round sides
}

/// Below the round sides of a bead on the bed are two grooves, and half a turn of their section at each end.
TEST(Print, TheHollowBelowASingleBeadIsThatOfItsRoundSides) {
  constexpr double kLength = 20.0;
  const double groove = kRound * kRound * (1.0 - kPi / 4.0);
  const double turn = 2.0 * kPi * (kFlat * groove + kRound * kRound * kRound / 6.0);
  const double hollow = 2.0 * groove * kLength + turn;
  for (const double degrees : {0.0, 90.0, 17.0}) {
    const double angle = degrees / 180.0 * kPi;
    const Point3 to{kLength * std::cos(angle), kLength * std::sin(angle), kHeight};
    for (const double pitch : {0.0, 0.05, 0.09, 0.2}) {
      const auto s = run(Print().line({0, 0, kHeight}, to), pitch);
      EXPECT_NEAR(s.total.hollow.mm3(), hollow, 0.02 * hollow) << degrees << " degrees, " << pitch;
      EXPECT_EQ(s.total.enclosed.mm3(), 0.0) << degrees << " degrees, " << pitch;
    }
  }
}

TEST(Print, ACornerIsNoOverlapUpToTheVolumeOfItsWedge) {
  // A circle of many short chords: the excess on the inner side equals what is missing outside.
  Print print;
  print.travel({20.3, 10.7, kHeight});
  constexpr int kChords = 200;
  for (int i = 1; i <= kChords; ++i) {
    const double a = 2.0 * kPi * i / kChords;
    print.bead({10.3 + 10 * std::cos(a), 10.7 + 10 * std::sin(a), kHeight});
  }
  const auto s = run(print, 0.02);
  EXPECT_LT(s.total.overlap.mm3(), 1e-3 * s.total.extruded.mm3());  // without the wedges 7e-3
  EXPECT_EQ(s.total.ends.mm3(), 0.0);                               // it is closed
  EXPECT_NEAR(in_columns(s), s.total.laid.mm3(), 2e-3 * s.total.laid.mm3());
}

TEST(Print, ARightAngleHasTheKnownExcess) {
  const auto s = run(Print().travel({0, 0, kHeight}).bead({10, 0, kHeight}).bead({10, 10, kHeight}), 0.005);
  // At each height the square of the half width, minus the quarter disc of the wedge.
  const double squares = kFlat * kFlat * kHeight + 2.0 * kFlat * kPi * kRound * kRound / 2.0 +
                         4.0 / 3.0 * kRound * kRound * kRound;
  const double excess = (1.0 - kPi / 4.0) * squares;
  EXPECT_NEAR(s.total.overlap.mm3(), excess, 0.1 * excess);
  EXPECT_NEAR(s.total.ends.mm3(), kEnds, 0.02 * kEnds);
}

TEST(Print, ACornerBetweenTwoWidthsIsTheSameInBothDirections) {
  const auto one =
      run(Print().travel({0, 0, kHeight}).bead({10, 0, kHeight}, 1.0).bead({10, 10, kHeight}, 0.4), 0.01);
  const auto other =
      run(Print().travel({10, 10, kHeight}).bead({10, 0, kHeight}, 0.4).bead({0, 0, kHeight}, 1.0), 0.01);
  EXPECT_GT(one.total.overlap.mm3(), 0.0);
  EXPECT_NEAR(one.total.overlap.mm3(), other.total.overlap.mm3(), 1e-3 * one.total.overlap.mm3());
  EXPECT_NEAR(in_columns(one), in_columns(other), 1e-4 * in_columns(one));
}

TEST(Print, AGridOfInfillEnclosesItsCells) {
  Print print;
  constexpr double kCell = 2.0, kSide = 10.0;
  for (int layer = 1; layer <= 4; ++layer) {
    const double z = layer * kHeight;
    for (double at = 0.0; at <= kSide; at += kCell)
      print.line({0, at, z}, {kSide, at, z}).line({at, 0, z}, {at, kSide, z});
  }
  // A lid: beads side by side.
  for (double y = 0.0; y <= kSide; y += kWidth / 2.0)
    print.line({0, y, 5 * kHeight}, {kSide, y, 5 * kHeight});
  const auto s = run(print, 0.025);
  // 25 cells, four layers high and (kCell - kWidth) wide where beads are widest.
  const double cells = 25.0 * (kCell - kWidth) * (kCell - kWidth) * 4.0 * kHeight;
  EXPECT_GT(s.total.enclosed.mm3(), cells);
  EXPECT_LT(s.total.enclosed.mm3(), 25.0 * std::pow(kCell - kWidth + kHeight, 2) * 4.0 * kHeight);
  EXPECT_GE(s.total.hollow.mm3(), s.total.enclosed.mm3());
  double by_layer = 0.0;
  for (const PrintLayer& layer : s.layers) by_layer += layer.volumes.enclosed.mm3();
  EXPECT_NEAR(by_layer, s.total.enclosed.mm3(), 1e-9);
  ASSERT_EQ(s.layers.size(), 5u);
  EXPECT_NEAR(s.layers[1].volumes.enclosed.mm3(), s.layers[2].volumes.enclosed.mm3(), 1e-3);
  // The lid bridges the cells: about (kCell - kWidth) / kCell of its length between the first and last line.
  const double lid = s.layers[4].volumes.bead_length.mm();
  EXPECT_NEAR(s.layers[4].volumes.unsupported.mm() / lid, (kCell - kWidth) / kCell * 30.0 / 41.0, 0.08);
}

TEST(Print, AnOpenCellIsHollowButNotEnclosed) {
  Print print;
  for (const double y : {0.0, 3.0}) print.line({0, y, kHeight}, {10, y, kHeight});
  for (double x = 0.0; x <= 10.0; x += kWidth / 2.0) print.line({x, 0, 2 * kHeight}, {x, 3, 2 * kHeight});
  const auto s = run(print, 0.05);
  EXPECT_GT(s.total.hollow.mm3(), 9.5 * 2.5 * kHeight);
  EXPECT_EQ(s.total.enclosed.mm3() < 0.05 * s.total.hollow.mm3(), true) << s.total.enclosed.mm3();
}

TEST(Print, CompensatedRetractionIsNoBlob) {
  Print print;
  print.line({0, 0, kHeight}, {10, 0, kHeight});
  print.push({10, 0, kHeight}, -2.0)
      .travel({0, 5, kHeight})
      .push({0, 5, kHeight}, 2.0)
      .bead({10, 5, kHeight});
  EXPECT_TRUE(run(print, 0.1).hazards.empty());
  // Wiping: retraction while the nozzle moves.
  print.push({5, 5, kHeight}, -1.5).push({5, 5, kHeight}, -0.5).push({5, 5, kHeight}, 2.3);
  const auto s = run(print, 0.1);
  ASSERT_EQ(s.hazards.size(), 1u);
  EXPECT_EQ(s.hazards[0].kind, PrintHazardKind::blob);
  EXPECT_NEAR(s.hazards[0].volume.mm3(), 0.3, 1e-9);
  EXPECT_NEAR(s.total.blobs.mm3(), 0.3, 1e-9);
  EXPECT_NEAR(s.total.extruded.mm3(), 20.0 * kArea + 0.3, 1e-9);
  const PrintVolumes& t = s.total;
  EXPECT_NEAR((t.laid - t.ends + t.overlap + t.blobs).mm3(), t.extruded.mm3(), 1e-9);
}

TEST(Print, ABeadWiderThanAnyNozzleIsABlob) {
  const auto s = run(Print().line({0, 0, kHeight}, {10, 0, kHeight}).push({10, 0.1, kHeight}, 30.0), 0.1);
  ASSERT_EQ(s.hazards.size(), 1u);
  EXPECT_EQ(s.hazards[0].kind, PrintHazardKind::blob);
  EXPECT_EQ(s.total.blobs.mm3(), 30.0);
}

TEST(Print, ABridgeIsUnsupportedAndABeadInTheAirIsReported) {
  Print print;
  for (const double x : {0.0, 10.0}) {
    print.line({x, 0, kHeight}, {x, 10, kHeight});
    print.line({x, 0, 2 * kHeight}, {x, 10, 2 * kHeight});
  }
  print.line({0, 5, 3 * kHeight}, {10, 5, 3 * kHeight});
  auto s = run(print, 0.05);
  ASSERT_EQ(s.hazards.size(), 1u);
  EXPECT_EQ(s.hazards[0].kind, PrintHazardKind::unsupported);
  EXPECT_NEAR(s.hazards[0].length.mm(), 10.0 - kWidth, 0.15);
  EXPECT_NEAR(s.total.unsupported.mm(), 10.0 - kWidth, 0.15);
  EXPECT_EQ(s.hazards[0].step, 9u);

  print.line({2, 8, 5}, {8, 8, 5}).bead({8, 9, 5});
  s = run(print, 0.05);
  ASSERT_EQ(s.hazards.size(), 2u);
  EXPECT_EQ(s.hazards[1].kind, PrintHazardKind::in_air);
  EXPECT_EQ(s.hazards[1].steps, 2u);
  EXPECT_NEAR(s.hazards[1].length.mm(), 7.0, 1e-9);
}

/// Slicers leave a gap of up to a layer above support structures; the bead sags onto them.
TEST(Print, ABeadALayerAboveOtherMaterialIsNotInTheAir) {
  const auto hazards_at = [](double bottom) {
    Print print;
    print.line({0, 0, kHeight}, {20, 0, kHeight});
    const double z = bottom + kHeight;
    print.travel({0, 0, z}).push({20, 0, z}, 20 * kArea, mm(kWidth), mm(kHeight));
    return run(print, 0.05);
  };
  EXPECT_EQ(count(hazards_at(2.0 * kHeight), PrintHazardKind::in_air), 0u);
  EXPECT_EQ(count(hazards_at(2.0 * kHeight), PrintHazardKind::unsupported), 1u);
  EXPECT_EQ(count(hazards_at(2.5 * kHeight), PrintHazardKind::in_air), 1u);
}

TEST(Print, AnOverhangOfLessThanHalfAWidthIsSupported) {
  for (const double aside : {0.2, 0.3}) {
    const auto s = run(Print()
                           .line({0, 0, kHeight}, {20, 0, kHeight})
                           .line({0, 0, 2 * kHeight}, {20, 0, 2 * kHeight})
                           .line({0, aside, 3 * kHeight}, {20, aside, 3 * kHeight}),
                       0.02);
    EXPECT_EQ(count(s, PrintHazardKind::unsupported), aside > kWidth / 2.0 ? 1u : 0u) << aside;
    EXPECT_EQ(count(s, PrintHazardKind::in_air), 0u);
  }
}

TEST(Print, TheNozzleInPrintedMaterialIsReported) {
  Print print;
  for (int layer = 1; layer <= 10; ++layer) print.line({10, 0, layer * kHeight}, {10, 20, layer * kHeight});
  print.travel({15, 20, 3.0}).travel({15, 10, 1.0});    // down beside it
  print.travel({5, 10, 1.0});                           // through it, 1 mm deep
  print.travel({5, 10, 2.0}).travel({15, 10, 2.0});     // at its height
  print.travel({15, 10, -0.1}).travel({16, 10, -0.1});  // into the bed
  const auto s = run(print, 0.05);
  std::vector<PrintHazard> met;
  for (const PrintHazard& h : s.hazards)
    if (h.kind == PrintHazardKind::nozzle_contact) met.push_back(h);
  ASSERT_EQ(met.size(), 2u);
  EXPECT_NEAR(met[0].depth.mm(), 1.0, 1e-3);
  EXPECT_NEAR(met[0].at.x, 10.25, 0.06);
  EXPECT_EQ(met[0].step, 22u);
  EXPECT_NEAR(met[1].depth.mm(), 0.1, 1e-6);
}

TEST(Print, ThePurgeLineIsNoLayerBelow) {
  Print print;
  print.travel({0, -5, 0.3}).push({20, -5, 0.3}, 20 * 0.3 * 0.5);
  for (int layer = 1; layer <= 3; ++layer) print.line({0, 0, layer * kHeight}, {20, 0, layer * kHeight});
  const auto s = run(print, 0.1);
  ASSERT_EQ(s.layers.size(), 4u);
  EXPECT_NEAR(s.layers[2].z.mm(), 0.4, 1e-9);
  EXPECT_NEAR(s.layers[2].height.mm(), kHeight, 1e-9);
}

TEST(Print, AVaseClimbsWithoutLayerChanges) {
  Print print;
  print.travel({20, 10, kHeight});
  constexpr int kChords = 100, kTurns = 5;
  for (int i = 1; i <= kChords * (kTurns + 1); ++i) {
    const double a = 2.0 * kPi * i / kChords;
    const double z = kHeight + kHeight * std::max(0, i - kChords) / kChords;
    print.bead({10 + 10 * std::cos(a), 10 + 10 * std::sin(a), z});
  }
  const auto s = run(print, 0.05);
  ASSERT_GE(s.layers.size(), 5u);
  EXPECT_LE(s.layers.size(), 6u);
  for (const PrintLayer& layer : s.layers) EXPECT_NEAR(layer.height.mm(), kHeight, 1e-9);
  EXPECT_TRUE(s.hazards.empty());
  // The first climbing turn starts on the flat one with the same extrusion: half a layer in excess.
  const double turn = s.total.extruded.mm3() / (kTurns + 1);
  EXPECT_NEAR(s.total.overlap.mm3(), 0.5 * turn, 0.05 * turn);
}

TEST(Print, GivenHeightsAndWidthsAreUsed) {
  // A bead 0.4 high over two layers of 0.2, as slicers print combined infill.
  Print print;
  print.line({0, 0, kHeight}, {10, 0, kHeight}).line({0, 0, 2 * kHeight}, {10, 0, 2 * kHeight});
  print.travel({0, 5, 2 * kHeight}).push({10, 5, 2 * kHeight}, 2.0, mm(0.6), mm(0.4));
  const double area = 0.2;
  EXPECT_NEAR(run(print, 0.1).layers[1].height.mm(), 0.4, 1e-12);
  EXPECT_NEAR(printing::section_of(area, 0.4).width, 0.4 + (area - kPi * 0.04) / 0.4, 1e-12);
  // Only the width is given: the height follows from the volume, not from the steps in Z.
  Print wide;
  wide.travel({0, 0, 0.9}).push({10, 0, 0.9}, 10 * kArea, mm(kWidth));
  EXPECT_NEAR(run(wide, 0.1).layers[0].height.mm(), kHeight, 1e-9);
}

TEST(Print, WidthsThatContradictTheVolumeAreReported) {
  Print print;  // as if a file for 2.85 mm filament were read with 1.75 mm
  print.travel({0, 0, kHeight}).push({10, 0, kHeight}, 10 * kArea * 0.377, mm(kWidth), mm(kHeight));
  Diagnostics diagnostics;
  ASSERT_TRUE(simulate_print(print.path(), {}, diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::print_width_differs);
}

TEST(Print, AnUnknownHeightIsAssumedAndReported) {
  Print print;
  print.travel({0, 0, 0}).push({10, 0, 0}, 10 * kArea);
  Diagnostics diagnostics;
  auto s = simulate_print(print.path(), {}, diagnostics);
  ASSERT_TRUE(s);
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::print_height_unknown);
  EXPECT_NEAR(s->total.laid.mm3(), 0.0, 1e-9);  // everything is below the bed
  EXPECT_NEAR(s->total.overlap.mm3(), s->total.extruded.mm3(), 1e-9);

  PrintOptions lower;
  lower.bed = mm(-0.3);
  Diagnostics none;
  s = simulate_print(print.path(), lower, none);
  ASSERT_TRUE(s && none.list().empty());
  EXPECT_NEAR(s->layers[0].height.mm(), 0.3, 1e-12);
}

TEST(Print, ErrorsAreReported) {
  const auto code_of = [](const Toolpath& path, const PrintOptions& options) {
    Diagnostics diagnostics;
    const auto s = simulate_print(path, options, diagnostics);
    EXPECT_EQ(s.has_value(), !diagnostics.has_errors());
    return diagnostics.list().empty() ? Code{} : diagnostics.list().front().code;
  };
  const Print good = Print().line({0, 0, kHeight}, {10, 0, kHeight});
  EXPECT_EQ(code_of(good.path(), {}), Code{});
  EXPECT_EQ(code_of(Print().travel({0, 0, 1}).travel({10, 0, 1}).path(), {}), codes::nothing_printed);
  EXPECT_EQ(code_of(good.path(), {.resolution = mm(-1)}), codes::bad_resolution);
  EXPECT_EQ(code_of(good.path(), {.resolution = mm(NAN)}), codes::bad_resolution);
  EXPECT_EQ(code_of(good.path(), {.resolution = mm(1e-9)}), codes::print_too_large);
  EXPECT_EQ(code_of(good.path(), {.resolution = mm(0.02), .max_intervals = 100}), codes::print_too_large);
  EXPECT_EQ(code_of(good.path(), {.resolution = mm(0.3)}), codes::print_coarse);
  EXPECT_EQ(code_of(Print().line({0, 0, kHeight}, {2e5, 0, kHeight}).path(), {}), codes::print_too_large);
  Print unknown = good;
  unknown.path().set_unknown_axes(0, 1);
  EXPECT_EQ(code_of(unknown.path(), {}), codes::print_at_unknown_place);
}

TEST(Print, APrintExtrudesAndStartsNoSpindle) {
  Print print;
  print.travel({0, 0, 1}).push({0, 0, 1}, 5);
  EXPECT_FALSE(is_print(print.path()));
  print.bead({10, 0, 1});
  EXPECT_TRUE(is_print(print.path()));
  print.path().add(step::Spindle{rpm(10000), SpindleTurn::cw}, OriginId::none);
  EXPECT_FALSE(is_print(print.path()));
}

/// A random print with all kinds of motions.
Print random_print(unsigned seed, int moves) {
  std::mt19937 random(seed);
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  Print print;
  double z = kHeight;
  print.travel({10, 10, z});
  for (int i = 0; i < moves; ++i) {
    const int kind = static_cast<int>(random() % 10);
    if (kind == 0) z += kHeight;
    const Point3 to{real(0, 20), real(0, 20), kind == 1 ? z + real(-0.2, 0.2) : z};
    if (kind < 3)
      print.travel(to);
    else
      print.bead(to, real(0.25, 0.8));
  }
  return print;
}

TEST(Print, ThreadsChangeNothing) {
  const Print print = random_print(3, 200);
  const auto one = run(print, 0.1, {.threads = 1});
  for (const unsigned threads : {2u, 3u, 7u}) {
    const auto more = run(print, 0.1, {.threads = threads});
    EXPECT_EQ(one.total.laid.mm3(), more.total.laid.mm3());
    EXPECT_EQ(one.total.enclosed.mm3(), more.total.enclosed.mm3());
    EXPECT_EQ(one.columns.first, more.columns.first);
    ASSERT_EQ(one.hazards.size(), more.hazards.size());
    for (std::size_t i = 0; i < one.hazards.size(); ++i) {
      EXPECT_EQ(one.hazards[i].step, more.hazards[i].step);
      EXPECT_EQ(one.hazards[i].depth, more.hazards[i].depth);
      EXPECT_EQ(one.hazards[i].at, more.hazards[i].at);
    }
  }
}

TEST(Print, RandomPrintsAddUpAndHaveClosedSurfaces) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const auto s = run(random_print(seed, 40), 0.1);
    const PrintVolumes& t = s.total;
    EXPECT_NEAR((t.laid - t.ends + t.overlap).mm3(), t.extruded.mm3(), 1e-6 * t.extruded.mm3());
    EXPECT_NEAR(in_columns(s), t.laid.mm3(), 0.02 * t.laid.mm3()) << seed;
    const Mesh mesh = extract_mesh(s.columns);
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.bad_edges, 0u) << seed;
    EXPECT_NEAR(check.volume.mm3(), in_columns(s), 0.05 * in_columns(s)) << seed;
    const VolumeRange range = mesh_volume(s.columns);
    EXPECT_NEAR(range.expected.mm3(), in_columns(s), 1e-6 * in_columns(s)) << seed;
    EXPECT_NEAR(check.volume.mm3(), range.expected.mm3(), range.tolerance.mm3()) << seed;
    for (std::uint32_t c = 0; c + 1 < s.columns.first.size(); ++c)
      for (std::uint32_t k = s.columns.first[c]; k < s.columns.first[c + 1]; ++k) {
        EXPECT_LT(s.columns.intervals[k].low, s.columns.intervals[k].high);
        if (k > s.columns.first[c]) {
          EXPECT_LT(s.columns.intervals[k - 1].high, s.columns.intervals[k].low);
        }
      }
  }
}

TEST(Print, ExtremeNumbersAreHandled) {
  constexpr double kOdd[] = {0,   1e-9, 1e-4,  0.2, 0.45,   3,   50,      1e3,
                             1e5, 1e7,  1e300, -1,  -1e300, NAN, INFINITY};
  constexpr double kCoordinates[] = {0, 1e-7, 0.1, 0.2, 0.3, 5, 7, 300, -4, 2e4, 1e7};
  std::mt19937 random(11);
  const auto coordinate = [&] {
    return kCoordinates[random() % (random() % 4 == 0 ? std::size(kCoordinates) : 7)];
  };
  int laid = 0;
  for (int n = 0; n < 300; ++n) {
    Print print;
    for (int i = 0; i < 20; ++i) {
      const Point3 to{coordinate(), coordinate(), coordinate()};
      const double odd = kOdd[random() % std::size(kOdd)];
      if (random() % 3 == 0)
        print.travel(to);
      else
        print.push(to, random() % 2 == 0 ? odd : 0.3, mm(kOdd[random() % 8]), mm(kOdd[random() % 8]));
    }
    PrintOptions options;
    options.max_columns = 50'000;
    options.max_intervals = 200'000;
    options.resolution = mm(random() % 2 == 0 ? 0.1 : 0.0);
    Diagnostics diagnostics;
    const auto s = simulate_print(print.path(), options, diagnostics);
    EXPECT_EQ(s.has_value(), !diagnostics.has_errors());
    if (!s) continue;
    ++laid;
    for (const Volume v :
         {s->total.laid, s->total.overlap, s->total.ends, s->total.hollow, s->total.extruded})
      EXPECT_TRUE(v.mm3() >= 0.0 && std::isfinite(v.mm3()));
    for (const PrintHazard& h : s->hazards) EXPECT_TRUE(finite(h.at) && std::isfinite(h.depth.mm()));
  }
  EXPECT_GT(laid, 20);
}

TEST(Print, GroovesCanBeClosed) {
  Print print;
  for (int layer = 1; layer <= 5; ++layer)
    if (layer != 3) print.line({0, 0, layer * kHeight}, {10, 0, layer * kHeight});
  const auto s = run(print, 0.05);
  EXPECT_GT(s.columns.intervals.size(), s.columns.first.size() / 3);
  const ColumnGrid closed = without_grooves(s.columns, mm(0.9 * kHeight));
  EXPECT_EQ(closed.first.size(), s.columns.first.size());
  for (std::size_t c = 0; c + 1 < closed.first.size(); ++c) {
    const std::size_t runs = closed.first[c + 1] - closed.first[c];
    EXPECT_EQ(runs == 0, s.columns.first[c + 1] == s.columns.first[c]);
    if (runs == 0) continue;
    // Near the centre line the missing layer separates two runs; the sides are farther apart and keep their
    // grooves.
    EXPECT_EQ(closed.intervals[closed.first[c]].low, s.columns.intervals[s.columns.first[c]].low);
    EXPECT_EQ(closed.intervals[closed.first[c + 1] - 1].high,
              s.columns.intervals[s.columns.first[c + 1] - 1].high);
  }
  const auto one = [&](const ColumnGrid& grid) {
    std::size_t max_runs = 0;
    for (std::size_t c = 0; c + 1 < grid.first.size(); ++c)
      max_runs = std::max<std::size_t>(max_runs, grid.first[c + 1] - grid.first[c]);
    return max_runs;
  };
  EXPECT_EQ(one(s.columns), 4u);
  EXPECT_EQ(one(closed), 2u);
  EXPECT_EQ(one(without_grooves(s.columns, mm(3 * kHeight))), 1u);
}

class Stop final : public Progress {
 public:
  explicit Stop(int after) : left_(after) {}
  void phase(std::string_view) override {}
  void report(double) override {}
  bool stop_requested() override { return --left_ < 0; }

 private:
  int left_;
};

TEST(Print, CanBeStopped) {
  const Print print = random_print(5, 4000);
  int stopped = 0;
  for (const int after : {0, 1, 2, 3, 5, 9}) {
    Stop progress(after);
    Diagnostics diagnostics;
    const auto s = simulate_print(print.path(), {.resolution = mm(0.2)}, diagnostics, &progress);
    ASSERT_TRUE(s);
    stopped += s->stopped ? 1 : 0;
  }
  EXPECT_GE(stopped, 4);
}

}  // namespace
}  // namespace kerf::test
