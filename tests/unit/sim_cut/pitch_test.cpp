// The default distance of the columns: fine enough for the narrowest cut, also on a large board.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "base/codes/sim.h"

#include "kerf/sim/live.h"
#include "kerf/sim/simulate.h"

namespace kerf {
namespace {

constexpr double kPi = std::numbers::pi;

Stock board(double width, double depth, double thickness) {
  Stock stock;
  stock.block = {{0, 0, -thickness}, {width, depth, 0}};
  return stock;
}

template <class Shape>
ToolTable one_tool(const Shape& shape) {
  ToolTable tools;
  Diagnostics diagnostics;
  tools.set(1, *make_tool(1, shape, {}, {}, diagnostics));
  return tools;
}

/// A straight cut along X from x = 20, at constant height.
Toolpath slot(double length, double depth) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Rapid{{20, 100, 5}}, OriginId::none);
  path.add(step::Cut{.to = {20, 100, -depth}, .feed = mm_per_min(100)}, OriginId::none);
  path.add(step::Cut{.to = {20 + length, 100, -depth}, .feed = mm_per_min(100)}, OriginId::none);
  path.add(step::Rapid{{20 + length, 100, 5}}, OriginId::none);
  return path;
}

Simulation cut(const Toolpath& path, const ToolTable& tools, const Stock& stock) {
  Diagnostics diagnostics;
  auto made = simulate(path, tools, stock, {}, diagnostics);
  EXPECT_TRUE(made);
  return std::move(*made);
}

const shape::Square kThin{mm(0.5), mm(5)};
/// 60 degrees.
const shape::Vee kEngraver{mm(6), mm(10), degrees(60), {}, {}};

TEST(DefaultPitch, OfAThinMillOnALargeBoard) {
  const Simulation made = cut(slot(400, 1), one_tool(kThin), board(2500, 1300, 20));
  EXPECT_LE(made.workpiece.pitch().mm(), 0.5 / 2.0);      // 0.72 mm by the size of the board
  const double expected = 400 * 0.5 + kPi * 0.25 * 0.25;  // a rectangle and two half discs, 1 mm deep
  EXPECT_NEAR(made.removed.mm3(), expected, 0.003 * expected);
}

/// A frame that fills a board of 3 m: the columns cannot be as fine as a mill of 0.3 mm needs.
TEST(DefaultPitch, TooCoarseForTheCutIsReported) {
  Toolpath path;
  path.add(step::ToolChange{1}, OriginId::none);
  path.add(step::Rapid{{5, 5, 5}}, OriginId::none);
  path.add(step::Cut{.to = {5, 5, -1}, .feed = mm_per_min(100)}, OriginId::none);
  for (const Point3 to : {Point3{2900, 2900, -1}, {5, 2900, -1}, {2900, 5, -1}, {5, 5, -1}})
    path.add(step::Cut{.to = to, .feed = mm_per_min(100)}, OriginId::none);
  for (const double diameter : {0.3, 3.0}) {
    Diagnostics diagnostics;
    const auto tools = one_tool(shape::Square{mm(diameter), mm(5)});
    const auto made = simulate(path, tools, board(3000, 3000, 18), {}, diagnostics);
    ASSERT_TRUE(made);
    const bool coarse = made->workpiece.pitch().mm() > diameter / 2.0;
    EXPECT_EQ(coarse, diameter == 0.3);
    ASSERT_EQ(diagnostics.list().size(), coarse ? 1u : 0u);
    if (coarse) {
      EXPECT_EQ(diagnostics.list()[0].code, codes::columns_coarse);
    }
  }
}

TEST(DefaultPitch, OfAnEngraving) {
  const Simulation made = cut(slot(100, 0.2), one_tool(kEngraver), board(600, 400, 10));
  const double half = 0.2 * std::tan(kPi / 6.0);  // of the width at the top
  EXPECT_LE(made.workpiece.pitch().mm(), 2.0 * half / 3.0);
  const double expected = 0.2 * half * 100 + kPi * half * half * 0.2 / 3.0;  // a prism and a cone
  EXPECT_NEAR(made.removed.mm3(), expected, 0.01 * expected);
}

TEST(DefaultPitch, FollowsTheStockWhereTheCutsAreWide) {
  const Simulation made = cut(slot(400, 1), one_tool(shape::Square{mm(6), {}}), board(2500, 1300, 20));
  EXPECT_NEAR(made.workpiece.pitch().mm(), 1.0, 1e-9);
}

TEST(DefaultPitch, ChangesWithAnEdit) {
  const Stock stock = board(150, 120, 10);
  LiveSimulation live(one_tool(kEngraver), stock, {});
  double last = 0.0;
  for (const double depth : {0.2, 2.0, 0.15}) {  // fine, coarse, fine
    const Toolpath path = slot(50, depth);
    Diagnostics diagnostics;
    ASSERT_TRUE(live.update(path, diagnostics));
    const Simulation whole = cut(path, one_tool(kEngraver), stock);
    ASSERT_EQ(live.workpiece()->pitch().mm(), whole.workpiece.pitch().mm());
    EXPECT_NE(live.workpiece()->pitch().mm(), last);
    last = live.workpiece()->pitch().mm();
    const ColumnGrid mine = live.workpiece()->grid(), other = whole.workpiece.grid();
    ASSERT_EQ(mine.first, other.first);
    for (std::size_t k = 0; k < mine.intervals.size(); ++k)
      if (std::abs(mine.intervals[k].high - other.intervals[k].high) > 1e-4F ||
          mine.intervals[k].high_step != other.intervals[k].high_step)
        FAIL() << "interval " << k << " at depth " << depth;
  }
}

}  // namespace
}  // namespace kerf
