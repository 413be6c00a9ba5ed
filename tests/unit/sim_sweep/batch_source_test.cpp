// Planning a path in batches, and keeping them.
#include "sim/sweep/batch_source.h"

#include <gtest/gtest.h>
#include <memory>
#include <vector>

#include "../path/jobs.h"
#include "sim/dexel/tile.h"

namespace kerf::test {
namespace {

/// A job planned on columns of 0.5 mm of a block of 50 x 40 x 10 whose top is Z0.
struct Planned {
  explicit Planned(const Toolpath& job, double beside = 0.0)
      : path(job), workpiece(block({0, 0, -10}, {50, 40, 0}), mm(0.5)) {
    Diagnostics diagnostics;
    const Stock stock = block({0, 0, -10}, {50, 40, 0});
    setup = sim::set_up(path, square_and_keyhole(), stock, {.resolution = mm(0.5)}, diagnostics);
    sim::BatchSource source(workpiece.body(), path, setup->survey,
                            {.plan = {.margin = 0.5, .beside = beside},
                             .steps = {sim::StepRange{0, path.size()}},
                             .hazard_depth = mm(0.001)});
    do batches.push_back(source.next());
    while (!batches.back()->is_last);
  }
  std::size_t sweeps() const {
    std::size_t count = 0;
    for (const auto& batch : batches) count += batch->sweeps.size();
    return count;
  }
  Toolpath path;
  Workpiece workpiece;
  std::optional<sim::Setup> setup;
  std::vector<std::shared_ptr<const sim::Batch>> batches;
};

TEST(BatchSource, AMotionIsPairedWithTheTilesItCanTouch) {
  Path path;  // tiles are 32 mm wide: a slot of 6 mm in the first, then one through both
  path.tool(1).rapid({5, 5, 2}).cut({5, 5, -1}).cut({20, 5, -1}).cut({45, 5, -1}).rapid({45, 5, 2});
  const Planned planned(path.path());
  ASSERT_EQ(planned.batches.size(), 1u);
  const sim::Batch& batch = *planned.batches[0];
  ASSERT_EQ(planned.sweeps(), 4u);  // the first rapid is above the block
  EXPECT_EQ(batch.busy, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(batch.start[1] - batch.start[0], 3u);
  EXPECT_EQ(batch.start[2] - batch.start[1], 2u);
  EXPECT_TRUE(batch.sweeps[1].follows);
  EXPECT_EQ(batch.steps_done, planned.path.size());
}

TEST(BatchSource, SweepsThatRepeatAnEarlierOneAreMarked) {
  Path path;  // to and fro twice, then deeper
  path.tool(1).rapid({5, 5, 2}).cut({5, 5, -1});
  for (int k = 0; k < 2; ++k) path.cut({20, 5, -1}).cut({5, 5, -1});
  path.cut({5, 5, -2}).cut({20, 5, -2});
  const Planned planned(path.path());
  std::vector<bool> repeats;
  for (const sim::Sweep& sweep : planned.batches[0]->sweeps) repeats.push_back(sweep.is_repeat);
  EXPECT_EQ(repeats, (std::vector<bool>{false, false, false, true, true, false, false}));
}

TEST(BatchSource, ReferencedBatchesAreNotReused) {
  Path path;
  path.tool(1).rapid({5, 5, 2});
  for (int k = 0; k < 50000; ++k) path.cut({5.0 + k % 2, 5, -1});
  const Planned planned(path.path());
  ASSERT_GE(planned.batches.size(), 3u);
  EXPECT_EQ(planned.sweeps(), 50000u);
  EXPECT_EQ(planned.batches[0]->sweeps.front().step, 2u);
  for (std::size_t k = 0; k + 1 < planned.batches.size(); ++k) EXPECT_FALSE(planned.batches[k]->is_last);
}

TEST(BatchSource, SweepsBesideTheBlockAreListedWhenWanted) {
  Path path;  // the tool of 3 mm passes 0.7 mm beside the block: 0.95 mm from the nearest centres
  path.tool(1).rapid({5, -3.7, 2}).cut({5, -3.7, -1}).cut({20, -3.7, -1}).cut({20, -30, -1});
  EXPECT_TRUE(Planned(path.path()).batches[0]->beside.empty());
  const Planned planned(path.path(), 0.95 + 0.01);
  ASSERT_EQ(planned.batches[0]->beside.size(), 3u);  // down, along, away
  EXPECT_EQ(planned.batches[0]->beside[1].sweep.step, 3u);
  EXPECT_EQ(planned.sweeps(), 0u);
}

TEST(KeptBatches, KeepShortPathsOnly) {
  Path path;
  path.tool(1).rapid({5, 5, 2});
  for (int k = 0; k < 100000; ++k) path.cut({5.0 + k % 2, 5, -1});
  const Planned part(path.path());
  sim::KeptBatches kept;
  EXPECT_FALSE(kept.complete());
  for (const auto& batch : part.batches) kept.add(batch);
  EXPECT_TRUE(kept.complete());
  EXPECT_EQ(kept.batches(), part.batches);
  for (int again = 0; again < 2; ++again)  // 300,000 sweeps are too many
    for (const auto& batch : part.batches) kept.add(batch);
  EXPECT_FALSE(kept.complete());
  EXPECT_TRUE(kept.batches().empty());
}

TEST(Planner, PlannedSweepsArePairedAgainWithAWiderMargin) {
  const Planned planned(random_job(5, 300), sim::kKeptMargin * 0.5);
  // The same sweeps as planned from the path at once.
  const sim::PlanScope wide{.margin = sim::kKeptMargin * 0.5};
  sim::BatchSource source(
      planned.workpiece.body(), planned.path, planned.setup->survey,
      {.plan = wide, .steps = {sim::StepRange{0, planned.path.size()}}, .hazard_depth = mm(0.001)});
  const auto expected = source.next();
  ASSERT_TRUE(expected->is_last);
  ASSERT_EQ(planned.batches.size(), 1u);
  sim::Planner planner(planned.workpiece.body(), planned.setup->survey.solids, mm(0.001), wide);
  sim::Batch again;
  const sim::Batch& batch = *planned.batches[0];
  auto beside = batch.beside.begin();
  for (std::size_t n = 0; n <= batch.sweeps.size(); ++n) {
    for (; beside != batch.beside.end() && beside->before == n; ++beside) planner.add(beside->sweep, again);
    if (n < batch.sweeps.size()) planner.add(batch.sweeps[n], again);
  }
  again.sort(planned.workpiece.body().tiles.size());
  ASSERT_EQ(again.sweeps.size(), expected->sweeps.size());
  for (std::size_t n = 0; n < again.sweeps.size(); ++n) {
    EXPECT_EQ(again.sweeps[n].step, expected->sweeps[n].step);
    EXPECT_EQ(again.sweeps[n].x, expected->sweeps[n].x);
  }
  EXPECT_EQ(again.busy, expected->busy);
  EXPECT_EQ(again.list, expected->list);
}

}  // namespace
}  // namespace kerf::test
