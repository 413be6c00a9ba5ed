// Workpieces before the first cut.
#include <gtest/gtest.h>
#include <memory>
#include <utility>

#include "../path/jobs.h"
#include "sim/dexel/initial_columns.h"

#include "kerf/stock/stock.h"

namespace kerf::test {
namespace {

TEST(Workpiece, UntouchedStockHasItsVolume) {
  const Workpiece workpiece(block({1, 2, 3}, {8.3, 7.1, 5}), mm(0.7));
  EXPECT_NEAR(workpiece.volume().mm3(), 7.3 * 5.1 * 2, 1e-4);
  EXPECT_EQ(workpiece.columns_x(), 11);
  EXPECT_EQ(workpiece.columns_y(), 8);
}

TEST(Workpiece, TheLastColumnIsTheNarrowRestOfTheBlock) {
  const Workpiece workpiece(block({0, 0, 0}, {2.5, 1, 1}), mm(1));
  const ColumnGrid grid = workpiece.grid();
  ASSERT_EQ(grid.nx, 3);
  EXPECT_DOUBLE_EQ(grid.column_x(0), 0.5);
  EXPECT_DOUBLE_EQ(grid.column_x(2), 2.25);
  EXPECT_DOUBLE_EQ(grid.column_y(0), 0.5);
}

/// Two columns of a block of 2 x 1 x 5: a bridge with a gap from 1 to 2, and nothing.
LeftColumns bridge_and_nothing() {
  LeftColumns left;
  left.bounds = {{0, 0, 10}, {2, 1, 15}};
  left.positions = {.x = 0.5, .y = 0.5, .z = 10.0, .pitch = 1.0, .nx = 2, .ny = 1};
  left.columns.nx = 2;
  left.columns.ny = 1;
  left.columns.first = {0, 2, 2};
  left.columns.runs = {{0.0f, 1.0f}, {2.0f, 5.0f}};
  return left;
}

TEST(Workpiece, IsFilledFromLeftOverColumns) {
  const Stock stock = stock_of(make_columns_body(bridge_and_nothing()));
  Workpiece workpiece(stock, mm(1));
  Diagnostics diagnostics;
  ASSERT_TRUE(sim::fill_from_body(workpiece.body(), *stock.body, diagnostics, nullptr));
  EXPECT_NEAR(workpiece.volume().mm3(), 4.0, 1e-6);
  const auto column = workpiece.column(0, 0);
  ASSERT_EQ(column.size(), 2u);
  EXPECT_EQ(column[0].high, 1.0f);
  EXPECT_EQ(column[1].low, 2.0f);
  EXPECT_EQ(column[1].low_step, kStockSurface);
  EXPECT_TRUE(workpiece.column(1, 0).empty());
}

TEST(Tile, LengthsAddUpAllIntervalsOfAColumn) {
  const Stock stock = stock_of(make_columns_body(bridge_and_nothing()));
  Workpiece workpiece(stock, mm(1));
  Diagnostics diagnostics;
  ASSERT_TRUE(sim::fill_from_body(workpiece.body(), *stock.body, diagnostics, nullptr));
  const sim::Tile& tile = *workpiece.body().tiles.front();
  sim::Lanes lengths;
  tile.lengths(0, lengths);
  EXPECT_EQ(lengths[sim::lane_index(0, 0)], 4.0f) << "1 below the gap, 3 above";
  EXPECT_EQ(lengths[sim::lane_index(1, 0)], 0.0f) << "its slot above the floor is empty";
}

TEST(Workpiece, LeavesTheColumnsThatItWasFilledFrom) {
  const LeftColumns given = bridge_and_nothing();
  const Stock stock = stock_of(make_columns_body(given));
  Workpiece workpiece(stock, mm(1));
  Diagnostics diagnostics;
  ASSERT_TRUE(sim::fill_from_body(workpiece.body(), *stock.body, diagnostics, nullptr));
  const LeftColumns left = left_columns(workpiece);
  EXPECT_EQ(left.columns.first, given.columns.first);
  EXPECT_EQ(left.columns.runs, given.columns.runs);
  EXPECT_EQ(left.bounds.low.z, 10.0);
}

}  // namespace
}  // namespace kerf::test
