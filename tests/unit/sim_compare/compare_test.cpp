// Comparison with targets whose differences are known.
#include "kerf/sim/compare.h"

#include <gtest/gtest.h>
#include <numbers>
#include <utility>

#include "../stock/solids.h"
#include "base/codes/sim.h"
#include "sim/dexel/initial_columns.h"

namespace kerf::test {
namespace {

std::shared_ptr<const StockBody> target_of(const Triangles& mesh) {
  Diagnostics diagnostics;
  auto body = make_mesh_body(mesh.positions, mesh.triangles, "target.stl", diagnostics);
  EXPECT_TRUE(body);
  return body;
}

/// A block of 40 x 20 x 8 with a step: the half at low x is `height` high.
Triangles stepped(double height) {
  Triangles out = box_mesh({0, 0, -8}, {20, 20, -8 + height});
  out.add(box_mesh({20, 0, -8}, {40, 20, 0}));
  return out;
}

/// A workpiece with columns of 0.1 mm: material from the floor of the block up to top(x, y), in work
/// coordinates.
template <class Top>
Workpiece part_of(const Top& top) {
  LeftColumns left;
  left.bounds = {{0, 0, -8}, {40, 20, 0}};
  auto& grid = left.positions = {.x = 0.05, .y = 0.05, .z = -8.0, .pitch = 0.1, .nx = 400, .ny = 200};
  left.columns.nx = grid.nx;
  left.columns.ny = grid.ny;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      left.columns.first.push_back(static_cast<std::uint32_t>(left.columns.runs.size()));
      const double height = top(grid.x_of(i), grid.y_of(j)) - grid.z;
      left.columns.runs.push_back({0.0f, static_cast<float>(height)});
    }
  }
  left.columns.first.push_back(static_cast<std::uint32_t>(left.columns.runs.size()));
  const Stock stock = stock_of(make_columns_body(std::move(left)));
  Workpiece part(stock, mm(0.1));
  Diagnostics diagnostics;
  EXPECT_TRUE(sim::fill_from_body(part.body(), *stock.body, diagnostics, nullptr));
  return part;
}

/// The block, cut down to z for x below `wall`.
Workpiece cut_step(double z, double wall) {
  return part_of([=](double x, double) { return x < wall ? z : 0.0; });
}

Comparison compared(const Workpiece& part, const Triangles& target, double tolerance = 0.05) {
  Diagnostics diagnostics;
  const auto body = target_of(target);
  const auto result = compare(part, *body, {.tolerance = mm(tolerance)}, diagnostics);
  EXPECT_TRUE(result && diagnostics.list().empty());
  return result ? *result : Comparison{};
}

TEST(Compare, APartThatIsItsTarget) {
  const auto part = cut_step(-3, 20);
  const Comparison c = compared(part, stepped(5));
  EXPECT_EQ(c.region_count, 0u);
  EXPECT_NEAR(c.target.mm3(), 20 * 20 * 5 + 20 * 20 * 8, 1e-2);
  EXPECT_NEAR(c.part.mm3(), c.target.mm3(), 1e-2);
  EXPECT_NEAR(c.gouge.mm3() + c.rest.mm3(), 0.0, 1e-2);
}

TEST(Compare, AFloorCutTooDeepIsAGougeOfThatDepth) {
  const Comparison c = compared(cut_step(-3.2, 20), stepped(5));
  ASSERT_EQ(c.region_count, 1u);
  EXPECT_EQ(c.regions[0].kind, DifferenceKind::gouge);
  EXPECT_NEAR(c.regions[0].depth.mm(), 0.2, 1e-4);
  EXPECT_NEAR(c.gouge_beyond.mm3(), 0.2 * 400, 0.1);
  EXPECT_NEAR(c.gouge.mm3(), c.gouge_beyond.mm3(), 1e-6);
  EXPECT_NEAR(c.regions[0].at.z, -3.2, 1e-3);
  EXPECT_NEAR(c.rest.mm3(), 0.0, 1e-6);
}

TEST(Compare, AWallCountsByItsDistanceNotItsHeight) {
  const Comparison c = compared(cut_step(-3, 19.5), stepped(5));
  ASSERT_EQ(c.region_count, 1u);
  EXPECT_EQ(c.regions[0].kind, DifferenceKind::rest);
  EXPECT_NEAR(c.regions[0].depth.mm(), 0.45, 1e-3);  // the centre of the last column
  EXPECT_NEAR(c.rest_beyond.mm3(), 0.5 * 20 * 3, 0.2);
  EXPECT_NEAR(c.regions[0].bounds.low.x, 19.55, 1e-6);
  const std::size_t row = 100 * 400;
  EXPECT_GT(c.map[row + 197], 0.0f);
  EXPECT_EQ(c.map[row + 150], 0.0f);
  EXPECT_TRUE(c.in_target[row]);
}

TEST(Compare, DifferencesWithinTheToleranceHaveVolumeButNoRegion) {
  const Comparison c = compared(cut_step(-3.2, 20), stepped(5), 0.3);
  EXPECT_EQ(c.region_count, 0u);
  EXPECT_NEAR(c.gouge.mm3(), 80.0, 0.1);
  EXPECT_EQ(c.gouge_beyond.mm3(), 0.0);
}

TEST(Compare, TheMapHasTheDeeperOfTheDifferencesOfAColumn) {
  // A plate whose lower side is cut by `below`, with `above` left on top.
  const auto map_of = [](float below, float above) {
    LeftColumns left;
    left.bounds = {{0, 0, -8}, {40, 20, 0}};
    left.positions = {.x = 0.5, .y = 0.5, .z = -8.0, .pitch = 1.0, .nx = 40, .ny = 20};
    left.columns.nx = 40;
    left.columns.ny = 20;
    for (std::uint32_t n = 0; n < 800; ++n) {
      left.columns.first.push_back(n);
      left.columns.runs.push_back({below, 5.0f + above});
    }
    left.columns.first.push_back(800);
    const Stock stock = stock_of(make_columns_body(std::move(left)));
    Workpiece part(stock, mm(1));
    Diagnostics diagnostics;
    EXPECT_TRUE(sim::fill_from_body(part.body(), *stock.body, diagnostics, nullptr));
    return compared(part, box_mesh({0, 0, -8}, {40, 20, -3})).map[10 * 40 + 20];
  };
  EXPECT_NEAR(map_of(0.4f, 0.3f), -0.4f, 1e-4);
  EXPECT_NEAR(map_of(0.2f, 0.6f), 0.6f, 1e-4);
}

TEST(Compare, AHighWallWithinTheToleranceIsNoRegion) {
  const Comparison c = compared(cut_step(-3, 19.9), stepped(5), 0.06);  // the column's centre is 0.05 off
  EXPECT_EQ(c.region_count, 0u);
  EXPECT_NEAR(c.rest.mm3(), 0.1 * 20 * 3, 0.1);
  EXPECT_EQ(c.rest_beyond.mm3(), 0.0);
}

TEST(Compare, SeparateRegionsAreSortedByDepth) {
  Triangles target = box_mesh({0, 0, -8}, {40, 20, 0});
  const Workpiece part = part_of([](double x, double y) {  // two holes of 6 mm
    if (distance(Point2{x, y}, Point2{10, 10}) < 3.0) return -1.0;
    return distance(Point2{x, y}, Point2{30, 10}) < 3.0 ? -2.0 : 0.0;
  });
  const Comparison c = compared(part, target);
  ASSERT_EQ(c.region_count, 2u);
  EXPECT_NEAR(c.regions[0].depth.mm(), 2.0, 1e-3);
  EXPECT_NEAR(c.regions[1].depth.mm(), 1.0, 1e-3);
  EXPECT_NEAR(c.regions[0].volume.mm3(), 2 * std::numbers::pi * 9, 0.5);
  EXPECT_LT(distance(c.regions[0].at.xy(), {30, 10}), 3.0);
  const Image map = draw_map(c, mm(1), 400);
  EXPECT_EQ(map.width, 400);
  EXPECT_EQ(map.height, 200);
  const auto pixel = [&](int x, int y) { return map.rgba.data() + 4 * (y * map.width + x); };
  EXPECT_GT(pixel(300, 100)[0], 2 * pixel(300, 100)[1]);  // red where it is gouged
  EXPECT_GT(pixel(200, 100)[1], pixel(200, 100)[0]);      // green between
}

TEST(Compare, ATargetOutsideTheStockIsReported) {
  const auto part = cut_step(-3, 20);
  const auto body = target_of(box_mesh({0, 0, -8}, {41, 20, 0}));
  Diagnostics diagnostics;
  EXPECT_TRUE(compare(part, *body, {}, diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::target_outside);
}

}  // namespace
}  // namespace kerf::test
