// The simulation as a whole: volumes, steps of surfaces, threads, unknown positions.
#include <cmath>
#include <gtest/gtest.h>
#include <initializer_list>
#include <random>

#include "base/codes/sim.h"
#include "cut_jobs.h"

namespace kerf::test {
namespace {

TEST(Simulate, VolumesAddUp) {
  Diagnostics diagnostics;
  const Stock stock = block({0, 0, -10}, {50, 40.03, 0});  // the pitch does not divide it
  const auto result = run(random_job(1, 300), square_and_keyhole(), stock, 0.17, diagnostics);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->stock.mm3(), 50 * 40.03 * 10, 1e-6);
  EXPECT_NEAR(result->stock.mm3() - result->removed.mm3(), result->workpiece.volume().mm3(), 0.05);
  double sum = 0.0;
  for (const float v : result->removed_by_step) sum += static_cast<double>(v);
  EXPECT_NEAR(sum, result->removed.mm3(), 1e-4 * result->removed.mm3());
  EXPECT_GT(result->removed.mm3(), 5000.0);
}

TEST(Simulate, SameForAnyNumberOfThreads) {
  const Toolpath path = random_job(2, 400);
  const Stock stock = block({0, 0, -10}, {50, 40, 0});
  std::optional<Simulation> first;
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    Diagnostics diagnostics;
    auto result = run(path, square_and_keyhole(), stock, 0.13, diagnostics, threads);
    ASSERT_TRUE(result);
    if (!first) {
      first = std::move(result);
      continue;
    }
    EXPECT_EQ(first->removed, result->removed);
    EXPECT_EQ(first->removed_by_step, result->removed_by_step);
    ASSERT_EQ(first->hazards.size(), result->hazards.size());
    for (std::size_t k = 0; k < result->hazards.size(); ++k) {
      EXPECT_EQ(first->hazards[k].at, result->hazards[k].at);
      EXPECT_EQ(first->hazards[k].removed, result->hazards[k].removed);
    }
    const ColumnGrid a = first->workpiece.grid(), b = result->workpiece.grid();
    ASSERT_EQ(a.first, b.first);
    for (std::size_t k = 0; k < a.intervals.size(); ++k) {
      ASSERT_EQ(a.intervals[k].low, b.intervals[k].low);
      ASSERT_EQ(a.intervals[k].high, b.intervals[k].high);
      ASSERT_EQ(a.intervals[k].low_step, b.intervals[k].low_step);
      ASSERT_EQ(a.intervals[k].high_step, b.intervals[k].high_step);
    }
  }
}

/// A slot and an undercut in it, with a rapid through the material and a plunge through the floor, again and
/// again: only the first time removes anything or touches material, and each goes below the floor.
TEST(Simulate, RepeatedPassesTouchNothing) {
  const auto passes = [](int count) {
    Path path;
    for (int k = 0; k < count; ++k) {
      path.tool(1)
          .rapid({10, 20, 2})
          .cut({10, 20, -2})
          .cut({30, 22, -4})
          .rapid({34, 20, -3})
          .rapid({34, 20, 2});
      path.tool(2).rapid({-6, 20, 2}).cut({-6, 20, -8}).cut({20, 20, -8}).cut({20, 20, -10.5});
      path.rapid({20, 20, 2});
    }
    return path.path();
  };
  const Stock stock = block({0, 0, -10}, {50, 40, 0});
  Diagnostics diagnostics;
  const auto once = run(passes(1), square_and_keyhole(), stock, 0.4, diagnostics);
  constexpr int kPasses = 3000;  // over several batches
  const auto often = run(passes(kPasses), square_and_keyhole(), stock, 0.4, diagnostics, 2);
  ASSERT_TRUE(once && often);
  EXPECT_EQ(once->removed, often->removed);
  const std::size_t steps = once->removed_by_step.size();
  for (std::size_t k = 0; k < often->removed_by_step.size(); ++k)
    ASSERT_EQ(often->removed_by_step[k], k < steps ? once->removed_by_step[k] : 0.0f) << k;
  const ColumnGrid a = once->workpiece.grid(), b = often->workpiece.grid();
  ASSERT_EQ(a.first, b.first);
  for (std::size_t k = 0; k < a.intervals.size(); ++k) {
    ASSERT_EQ(a.intervals[k].high, b.intervals[k].high);
    ASSERT_EQ(a.intervals[k].high_step, b.intervals[k].high_step);
  }
  std::size_t below = 0;
  for (const Hazard& hazard : often->hazards) {
    below += hazard.kind == HazardKind::below_floor ? 1 : 0;
    EXPECT_TRUE(hazard.step < steps || hazard.kind == HazardKind::below_floor) << hazard.step;
  }
  EXPECT_EQ(below, std::size_t{kPasses});
  EXPECT_GT(once->hazards.size(), 1u);
}

/// Helices in half turns, level circles, turns that rise again, cuts below the block, with tools that
/// undercut and with a stopped spindle between: columns, hazards and volumes of tools do not depend on what
/// is left out.
TEST(Simulate, CoveredTurnsLeaveNoTrace) {
  std::mt19937 random(11);
  const auto one_of = [&](std::initializer_list<double> values) {
    return *(values.begin() + static_cast<std::ptrdiff_t>(random() % values.size()));
  };
  for (int job = 0; job < 40; ++job) {
    Path path;
    double z = 1.0;
    path.tool(1).spindle(SpindleTurn::cw).rapid({20, 20, z});
    for (int k = 0; k < 60; ++k) {
      z += one_of({-0.3, -0.3, -0.3, -0.2, 0.0, 0.1});
      const double x = k % 2 == 0 ? 30.0 : 20.0;
      path.arc({.to = {x, 20, z}, .centre = {25, 20}, .feed = mm_per_min(500)});
      if (random() % 20 == 0) path.tool(1 + static_cast<int>(random() % 3));
      if (random() % 30 == 0) path.cut({x, 20, z = one_of({z, -9.5, -10.5, 0.5})});
      if (random() % 30 == 0) path.spindle(one_of({0, 1}) > 0 ? SpindleTurn::off : SpindleTurn::cw);
      if (random() % 30 == 0) path.rapid({x, 20, z = one_of({z, 2})});
    }
    const Stock stock = block({0, 0, -10}, {50, 40, 0});
    SimulationOptions whole, by_tool;
    whole.resolution = by_tool.resolution = mm(0.5);
    by_tool.volumes_by_tool = true;
    Diagnostics diagnostics;
    const auto a = simulate(path.path(), square_and_keyhole(), stock, whole, diagnostics);
    const auto b = simulate(path.path(), square_and_keyhole(), stock, by_tool, diagnostics);
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->removed.mm3(), b->removed.mm3(), 1e-4 * a->removed.mm3()) << job;
    ASSERT_EQ(a->hazards.size(), b->hazards.size()) << job;
    for (std::size_t k = 0; k < a->hazards.size(); ++k) {
      EXPECT_EQ(a->hazards[k].step, b->hazards[k].step) << job;
      EXPECT_EQ(a->hazards[k].kind, b->hazards[k].kind) << job;
      EXPECT_EQ(a->hazards[k].depth, b->hazards[k].depth) << job;
    }
    const ColumnGrid of_a = a->workpiece.grid(), of_b = b->workpiece.grid();
    ASSERT_EQ(of_a.first, of_b.first) << job;
    for (std::size_t k = 0; k < of_a.intervals.size(); ++k) {
      ASSERT_EQ(of_a.intervals[k].low, of_b.intervals[k].low) << job;
      ASSERT_EQ(of_a.intervals[k].high, of_b.intervals[k].high) << job;
    }
  }
}

TEST(Simulate, GridAndColumnsAgree) {
  Diagnostics diagnostics;
  const auto result =
      run(random_job(3, 200), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), 0.5, diagnostics);
  ASSERT_TRUE(result);
  const ColumnGrid grid = result->workpiece.grid();
  ASSERT_EQ(grid.first.size(), static_cast<std::size_t>(grid.nx * grid.ny + 1));
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const auto number = static_cast<std::size_t>(j * grid.nx + i);
      const auto column = result->workpiece.column(i, j);
      ASSERT_EQ(column.size(), grid.first[number + 1] - grid.first[number]);
      float above = 0.0f;
      for (const Interval& run : column) {
        ASSERT_LT(run.low, run.high);
        ASSERT_GE(run.low, above);
        above = run.high;
      }
    }
  }
}

TEST(Simulate, EmptyColumnsHaveTheStepThatEmptiedThem) {
  Path path;  // 2 plunge, 3 slot through, 6 keyhole beside it, 7 deeper in empty columns
  path.tool(1).rapid({10, 20, 2}).cut({10, 20, -2}).cut({10, 20, -11}).cut({30, 20, -11});
  path.tool(2).rapid({40, 20, 2}).cut({40, 20, -12}).cut({40, 20, -13});
  Diagnostics diagnostics;
  const auto result =
      run(path.path(), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), 0.5, diagnostics);
  ASSERT_TRUE(result);
  const ColumnGrid grid = result->workpiece.grid();
  ASSERT_EQ(grid.cut_through.size(), static_cast<std::size_t>(grid.nx * grid.ny));
  const auto at = [&](double x, double y) {
    return grid.cut_through[static_cast<std::size_t>(static_cast<int>(y / 0.5) * grid.nx) +
                            static_cast<std::size_t>(x / 0.5)];
  };
  EXPECT_EQ(at(10, 20), 3u);
  EXPECT_EQ(at(25, 20), 4u);
  EXPECT_EQ(at(40, 20), 7u);    // in the neck
  EXPECT_EQ(at(43.2, 20), 7u);  // the head has removed everything from above
  EXPECT_EQ(at(2, 2), kStockSurface);
}

TEST(Simulate, EveryEndHasTheStepThatMadeIt) {
  Path path;  // 0 tool, 1 rapid, 2 plunge, 3 slot, 4 tool, 5 rapid, 6 beside, 7 undercut through the end of
              // the slot
  path.tool(1).rapid({10, 20, 2}).cut({10, 20, -2}).cut({30, 20, -2});
  path.tool(2).rapid({-6, 20, 2}).cut({-6, 20, -8}).cut({20, 20, -8});
  Diagnostics diagnostics;
  const auto result =
      run(path.path(), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), 0.5, diagnostics);
  ASSERT_TRUE(result);
  const auto at = [&](double x, double y) {
    return result->workpiece.column(static_cast<int>(x / 0.5), static_cast<int>(y / 0.5));
  };
  EXPECT_EQ(at(45, 5).at(0).high_step, kStockSurface);
  EXPECT_EQ(at(28, 20).at(0).high_step, 3u);
  EXPECT_EQ(at(9, 20).at(0).high_step, 7u);  // the neck is in the column: no material above the head
  const auto roofed = at(5, 23.2);           // beyond the neck, within the head
  ASSERT_EQ(roofed.size(), 2u);
  EXPECT_EQ(roofed[0].high_step, 7u);
  EXPECT_EQ(roofed[0].low_step, kStockSurface);
  EXPECT_EQ(roofed[1].low_step, 7u);
  EXPECT_EQ(roofed[1].high_step, kStockSurface);
  EXPECT_NEAR(roofed[0].high, 2.0, 1e-4);
  EXPECT_NEAR(roofed[1].low, 4.5, 1e-4);
}

TEST(Simulate, AColumnMayHaveManyIntervals) {
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {5, 0, 0}, {5, 0.5, 0}, {1, 0.5, 0}, {1, 40, 0}})));
  Path path;
  path.tool(1);
  for (int k = 1; k <= 9; ++k)
    path.rapid({-8, 10, 5}).cut({-8, 10, -2.0 * k}).cut({10, 10, -2.0 * k}).cut({-8, 10, -2.0 * k});
  Diagnostics diagnostics;
  const auto result = run(path.path(), tools, block({0, 0, -20}, {30, 20, 0}), 0.5, diagnostics);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->workpiece.column(10, 26).size(), 10u);
  EXPECT_NEAR(result->stock.mm3() - result->removed.mm3(), result->workpiece.volume().mm3(), 0.01);
}

// ---- motions whose start is unknown

TEST(UnknownPositions, AProgramThatOnlyRetractsCutsNothing) {
  Path path;
  path.tool(1).rapid({0, 0, 5});
  path.path().set_unknown_axes(1, 3);
  path.rapid({20, 20, 5}).rapid({20, 20, -2});
  path.path().set_unknown_axes(2, 0);
  Diagnostics diagnostics;
  Toolpath retract;
  const auto here = retract.origins().add(CallLocation{.file = "", .line = 1, .call = "t"});
  retract.add(step::ToolChange{1}, here);
  retract.set_unknown_axes(retract.add(step::Rapid{{0, 0, 5}}, here), 3);
  const auto result =
      run(retract, square_and_keyhole(), block({-10, -10, -10}, {10, 10, 0}), 0.5, diagnostics);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->removed.mm3(), 0.0);
  EXPECT_TRUE(result->hazards.empty());
}

TEST(UnknownPositions, ARapidFromAnUnknownPositionIsSweptAtItsEndOnly) {
  Toolpath path;
  const auto here = path.origins().add(CallLocation{.file = "", .line = 1, .call = "t"});
  path.add(step::ToolChange{1}, here);
  path.set_unknown_axes(path.add(step::Rapid{{0, 0, -2}}, here), 3);
  path.add(step::Rapid{{25, 20, -2}}, here);
  Diagnostics diagnostics;
  const auto result = run(path, square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), 0.1, diagnostics);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->hazards.size(), 1u);
  EXPECT_NEAR(result->removed.mm3(), std::numbers::pi * 9 * 2, 1.0);
}

TEST(UnknownPositions, AnArcFromAnUnknownPositionIsCutFromXZeroYZero) {
  for (const unsigned unknown : {0u, 3u}) {
    Toolpath path;
    const auto here = path.origins().add(CallLocation{.file = "", .line = 1, .call = "t"});
    path.add(step::ToolChange{1}, here);
    path.set_unknown_axes(path.add(step::Rapid{{0, 0, 5}}, here), unknown);
    path.set_unknown_axes(path.add(step::Cut{{0, 0, -1}, mm_per_min(100)}, here), unknown);
    path.set_unknown_axes(
        path.add(step::Arc{.to = {0, 0, -1}, .centre = {10, 0}, .feed = mm_per_min(100)}, here), unknown);
    Diagnostics diagnostics;
    const auto result = run(path, square_and_keyhole(), block({-10, -20, -5}, {30, 20, 0}), 0.1, diagnostics);
    ASSERT_TRUE(result);
    EXPECT_EQ(diagnostics.warnings(), unknown == 0 ? 0u : 1u);
    EXPECT_NEAR(result->removed.mm3(), std::numbers::pi * (13 * 13 - 7 * 7), 2.0);
  }
}

TEST(UnknownPositions, ACutFromAnUnknownHeightComesFromAbove) {
  Toolpath path;
  const auto here = path.origins().add(CallLocation{.file = "", .line = 1, .call = "t"});
  path.add(step::ToolChange{1}, here);
  path.set_unknown_axes(path.add(step::Rapid{{25, 20, 0}}, here), 4);
  path.add(step::Cut{{25, 20, -3}, mm_per_min(100)}, here);
  Diagnostics diagnostics;
  const auto result = run(path, square_and_keyhole(), block({0, 0, -10}, {50, 40, 2}), 0.1, diagnostics);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->removed.mm3(), std::numbers::pi * 9 * 5, 2.5);
}

TEST(Simulate, LongPathsAreSurveyedInSectionsWithOneWarning) {
  Path path;
  const auto cut_across = [&](int tool, double y) {
    path.tool(tool).rapid({2, y, 5}).cut({2, y, -2}).cut({40, y, -2});
  };
  cut_across(1, 8);
  for (int k = 0; k < 70000; ++k) path.rapid({40, 8, 5.0 + k % 2});
  cut_across(3, 20);
  Diagnostics quiet;
  EXPECT_TRUE(run(path.path(), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), 0.5, quiet));
  EXPECT_TRUE(quiet.list().empty());
  for (int k = 0; k < 70000; ++k) path.rapid({40, 8, 5.0 + k % 2});
  cut_across(2, 32);
  for (const std::size_t step : {std::size_t{5}, std::size_t{70010}, path.path().size() - 1})
    path.path().set_extra(step, {.abc = std::array<double, 3>{10, 0, 0}, .z_correction = ""});
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    Diagnostics diagnostics;
    const auto result =
        run(path.path(), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), 0.5, diagnostics, threads);
    ASSERT_TRUE(result);
    ASSERT_EQ(diagnostics.list().size(), 1u) << threads << " threads";
    EXPECT_EQ(diagnostics.list()[0].code, codes::rotary_not_simulated);
    for (const std::size_t step : {std::size_t{3}, std::size_t{70007}, path.path().size() - 1})
      EXPECT_GT(result->removed_by_step[step], 1.0f) << "step " << step;
  }
}

class Stopper : public Progress {
 public:
  void phase(std::string_view what) override { phase_ = what; }
  void report(double fraction) override { fraction_ = fraction; }
  bool stop_requested() override { return true; }
  std::string phase_;
  double fraction_ = -1;
};

TEST(Simulate, StopsOnRequest) {
  Stopper stopper;
  Diagnostics diagnostics;
  SimulationOptions options;
  options.resolution = mm(0.5);
  const auto result = simulate(random_job(4, 50), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}),
                               options, diagnostics, &stopper);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->stopped);
  EXPECT_EQ(stopper.phase_, "cutting");
}

}  // namespace
}  // namespace kerf::test
