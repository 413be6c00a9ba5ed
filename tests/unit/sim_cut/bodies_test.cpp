// Stock that is not a block, left-over stock turned over, and fixtures.
#include <gtest/gtest.h>

#include "../stock/solids.h"
#include "cut_jobs.h"

#include "kerf/sim/simulate.h"
#include "kerf/stock/stock.h"

namespace kerf::test {
namespace {

Stock stock_of_mesh(const Triangles& mesh) {
  Diagnostics diagnostics;
  const auto body = make_mesh_body(mesh.positions, mesh.triangles, "body.stl", diagnostics);
  EXPECT_TRUE(body && diagnostics.list().empty());
  return stock_of(body);
}

ToolTable square_6() {
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 20, 0}})));
  return tools;
}

TEST(BodyStock, ABoxAsAMeshCutsAsABlockDoes) {
  Path path;
  path.tool(1).rapid({-5, 10, 5}).cut({-5, 10, -2}).cut({45, 10.5, -3}).rapid({45, 10.5, 5});
  path.arc({.to = {45, 10.5, 5}, .centre = {35, 10.5}, .feed = mm_per_min(100)});
  Diagnostics diagnostics;
  const auto a = run(path.path(), square_6(), block({0, 0, -8}, {40, 21.03, 0}), 0.11, diagnostics);
  const auto b =
      run(path.path(), square_6(), stock_of_mesh(box_mesh({0, 0, -8}, {40, 21.03, 0})), 0.11, diagnostics);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->stock.mm3(), b->stock.mm3(), 1e-2);
  EXPECT_DOUBLE_EQ(a->removed.mm3(), b->removed.mm3());
  EXPECT_EQ(a->workpiece.column(100, 90).size(), b->workpiece.column(100, 90).size());
}

TEST(BodyStock, ASlotThroughASphereRemovesTheExactVolume) {
  // A slot 6 wide along X through the centre of a sphere of 10 mm, down to its equator.
  Path path;
  path.tool(1).rapid({-20, 0, 20}).cut({-20, 0, 0}).cut({20, 0, 0});
  Diagnostics diagnostics;
  const auto result =
      run(path.path(), square_6(), stock_of_mesh(sphere_mesh({0, 0, 0}, 10, 300)), 0.05, diagnostics);
  ASSERT_TRUE(result && diagnostics.list().empty());
  // Half of the slab |y| < 3: integral of half a disc's area pi (100 - y^2) / 2.
  const double exact = std::numbers::pi / 2.0 * (100.0 * 6.0 - 2.0 * 9.0);
  EXPECT_NEAR(result->stock.mm3(), 4.0 / 3.0 * std::numbers::pi * 1000.0, 1.5);
  EXPECT_NEAR(result->removed.mm3(), exact, 1e-3 * exact);
  EXPECT_TRUE(result->hazards.empty());
  EXPECT_NEAR(result->workpiece.volume().mm3(), result->stock.mm3() - result->removed.mm3(), 0.1);
}

TEST(BodyStock, RapidsThroughACavityTouchNothing) {
  Triangles tray = box_mesh({0, 0, 0}, {40, 40, 5});
  tray.add(box_mesh({0, 0, 5}, {5, 40, 30}));
  tray.add(box_mesh({35, 0, 5}, {40, 40, 30}));
  const Stock stock = stock_of_mesh(tray);
  Diagnostics diagnostics;
  Path inside;
  inside.tool(1).rapid({20, 20, 50}).rapid({20, 20, 6}).rapid({12, 20, 6}).rapid({12, 20, 50});
  auto result = run(inside.path(), square_6(), stock, 0.1, diagnostics);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->hazards.empty());
  EXPECT_EQ(result->removed.mm3(), 0.0);
  Path against;
  against.tool(1).rapid({20, 20, 50}).rapid({20, 20, 6}).rapid({7, 20, 6});  // 1 mm into the wall
  result = run(against.path(), square_6(), stock, 0.1, diagnostics);
  ASSERT_EQ(result->hazards.size(), 1u);
  EXPECT_EQ(result->hazards[0].kind, HazardKind::rapid_in_stock);
  EXPECT_EQ(result->hazards[0].step, 3u);
}

TEST(BodyStock, RapidsWithTheShankThroughAMeshAreReported) {
  // The flutes pass below a ball, the shank through it.
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 5, 0}})));
  Path path;
  path.tool(1).rapid({-30, 0, -40}).rapid({30, 0, -40});
  Diagnostics diagnostics;
  const auto result =
      run(path.path(), tools, stock_of_mesh(sphere_mesh({0, 0, 0}, 10, 100)), 0.1, diagnostics);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->hazards.size(), 1u);
  EXPECT_EQ(result->hazards[0].kind, HazardKind::rapid_in_stock);
  EXPECT_NEAR(result->hazards[0].depth.mm(), 20.0, 0.05);
  const double exact = std::numbers::pi * (100.0 * 6.0 - 2.0 * 9.0);  // the slab |y| < 3
  EXPECT_NEAR(result->hazards[0].removed.mm3(), exact, 0.01 * exact);
}

TEST(LeftStock, PocketsFromBothSidesMakeAThroughHole) {
  // A pocket from the top and, after half a turn about the centre of the block, the same one from below: a
  // through hole.
  Path pocket;
  pocket.tool(1).rapid({20, 10, 5}).cut({20, 10, -5}).rapid({20, 10, 5});
  Diagnostics diagnostics;
  const Stock first = block({0, 0, -8}, {40, 20, 0});
  const auto top = run(pocket.path(), square_6(), first, 0.05, diagnostics);
  ASSERT_TRUE(top);
  const Stock second = moved(stock_of(make_columns_body(left_columns(top->workpiece))),
                             {StockMove::Flip::about_x, {}, {}, {}});
  EXPECT_EQ(second.block, first.block);
  const auto both = run(pocket.path(), square_6(), second, 0.0, diagnostics);
  ASSERT_TRUE(both);
  EXPECT_EQ(both->workpiece.pitch().mm(), 0.05);  // that of the left-over stock
  const double area = std::numbers::pi * 9.0;
  EXPECT_NEAR(top->removed.mm3(), 5.0 * area, 2e-3 * area);
  EXPECT_NEAR(both->stock.mm3(), 6400.0 - 5.0 * area, 0.05 * area);
  EXPECT_NEAR(both->removed.mm3(), 3.0 * area, 1e-2 * area);
  EXPECT_TRUE(both->workpiece.column(400, 200).empty());
  EXPECT_EQ(both->workpiece.column(10, 10).size(), 1u);
}

Fixture fixture(const char* name, Box3 box) { return {name, Stock{box}}; }

TEST(Fixtures, EveryPartAtFeedAndRapid) {
  ToolTable tools;
  Tool tool = make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 10, 0}}));
  tool.silhouette.shank = profile({{5, 10, 0}, {5, 30, 0}});
  tools.set(1, tool);
  // Fixture 0 is 4 high, fixture 1 starts 12 above Z0.
  const std::vector<Fixture> fixtures{fixture("clamp", {{0, 0, 0}, {10, 10, 4}}),
                                      fixture("bridge", {{50, 0, 12}, {60, 10, 20}})};
  Path path;
  path.tool(1).rapid({-20, 5, 1}).cut({-2.5, 5, 1}).rapid({-20, 5, 1}).rapid({-20, 5, 30}).rapid({5, 5, 30});
  path.rapid({5, 5, 3}).rapid({5, 5, 30}).rapid({40, 5, 30}).rapid({40, 5, 1}).cut({46, 5, 1});
  Diagnostics diagnostics;
  const auto found = find_fixture_contacts(path.path(), tools, fixtures, {}, diagnostics);
  ASSERT_TRUE(found);
  EXPECT_TRUE(diagnostics.list().empty());
  // In and out, at feed and at rapid speed: the clamp is not cut, so each motion touches it.
  struct Expected {
    std::size_t fixture;
    std::uint32_t step;
    std::optional<ToolPart> part;
    double depth;
  };
  const std::vector<Expected> expected{
      {0, 2, ToolPart::cutting, 3}, {0, 3, {}, 3}, {0, 6, {}, 1}, {0, 7, {}, 1}, {1, 10, ToolPart::shank, 8}};
  ASSERT_EQ(found->size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    SCOPED_TRACE(k);
    EXPECT_EQ((*found)[k].fixture, expected[k].fixture);
    EXPECT_EQ((*found)[k].step, expected[k].step);
    EXPECT_EQ((*found)[k].part, expected[k].part);
    EXPECT_NEAR((*found)[k].depth.mm(), expected[k].depth, 1e-3);
  }
  EXPECT_NEAR((*found)[0].at.x, 0.0, 0.05);
  EXPECT_NEAR((*found)[0].met.mm3(), (*found)[1].met.mm3(), 0.01);
  EXPECT_NEAR((*found)[2].met.mm3(), std::numbers::pi * 9.0, 0.1);
}

TEST(Fixtures, AMotionOfManyChordsTouchesAFixtureOnce) {
  // A helix with three turns at the same position in the clamp.
  Path path;
  path.tool(1).rapid({25, 20, 10}).cut({25, 20, 4.0});
  path.arc(
      {.to = {25, 20, 3}, .centre = {20, 20}, .turn = Turn::ccw, .extra_turns = 2, .feed = mm_per_min(100)});
  Diagnostics diagnostics;
  const auto found = find_fixture_contacts(
      path.path(), square_6(), std::vector{fixture("clamp", {{0, 0, 0}, {40, 40, 4}})}, {}, diagnostics);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  const double ring = std::numbers::pi * (64 - 4);  // radii 2 and 8
  EXPECT_LT((*found)[0].met.mm3(), ring * 1.0);
  EXPECT_GT((*found)[0].met.mm3(), ring * 0.8);
}

TEST(Fixtures, TouchingWithoutDepthIsNoContact) {
  Path path;
  path.tool(1).rapid({-3, -20, 1}).cut({-3, 20, 1}).rapid({-3, 20, 4}).rapid({20, 5, 4}).cut({-20, 5, 4});
  Diagnostics diagnostics;
  const auto found = find_fixture_contacts(
      path.path(), square_6(), std::vector{fixture("clamp", {{0, 0, 0}, {10, 10, 4}})}, {}, diagnostics);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->empty());
}

TEST(Fixtures, AMeshIsAFixtureToo) {
  const std::vector<Fixture> dome{{"dome.stl", stock_of_mesh(sphere_mesh({0, 0, 0}, 10, 100))}};
  Path path;
  path.tool(1)
      .rapid({-30, 0, 12})
      .cut({30, 0, 10.01})
      .cut({30, 9.9, 9.9})
      .cut({-30, 9.9, 9.9})
      .cut({-30, 0, 9.5});
  path.cut({30, 0, 9.5});
  Diagnostics diagnostics;
  const auto found = find_fixture_contacts(path.path(), square_6(), dome, {}, diagnostics);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1u);
  EXPECT_EQ((*found)[0].step, 6u);
  EXPECT_NEAR((*found)[0].depth.mm(), 0.5, 2e-3);
}

}  // namespace
}  // namespace kerf::test
