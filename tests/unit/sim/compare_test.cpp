// Comparison with targets whose differences are known.
#include "kerf/compare.h"

#include <gtest/gtest.h>

#include "../stock/solids.h"
#include "jobs.h"

namespace kerf::test {
namespace {

std::shared_ptr<const StockBody> target_of(const Triangles& mesh) {
  Diagnostics diagnostics;
  auto body = make_mesh_body(mesh.positions, mesh.triangles, "target.stl", diagnostics);
  EXPECT_TRUE(body);
  return body;
}

/// A block of 40 x 20 x 8 with a step: the half of low x is cut down to `height` above the floor.
Triangles stepped(double height) {
  Triangles out = box_mesh({0, 0, -8}, {20, 20, -8 + height});
  out.add(box_mesh({20, 0, -8}, {40, 20, 0}));
  return out;
}

/// Cuts the half of low x down to z with a square tool of 6 mm, whose wall then stands at `wall`.
std::optional<Simulation> cut_step(double z, double wall) {
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 20, 0}})));
  Path path;
  path.tool(1).rapid({-5, -5, 5});
  bool up = true;
  for (double x = wall - 3.0; x > -5.0; x -= 4.0, up = !up)
    path.cut({x, up ? -5.0 : 25.0, z}).cut({x, up ? 25.0 : -5.0, z});
  Diagnostics diagnostics;
  return run(path.path(), tools, block({0, 0, -8}, {40, 20, 0}), 0.1, diagnostics);
}

Comparison compared(const Simulation& part, const Triangles& target, double tolerance = 0.05) {
  Diagnostics diagnostics;
  const auto body = target_of(target);
  const auto result = compare(part.workpiece, *body, {.tolerance = mm(tolerance)}, diagnostics);
  EXPECT_TRUE(result && diagnostics.list().empty());
  return result ? *result : Comparison{};
}

TEST(Compare, APartThatIsItsTarget) {
  const auto part = cut_step(-3, 20);
  const Comparison c = compared(*part, stepped(5));
  EXPECT_EQ(c.region_count, 0u);
  EXPECT_NEAR(c.target.mm3(), 20 * 20 * 5 + 20 * 20 * 8, 1e-2);
  EXPECT_NEAR(c.part.mm3(), c.target.mm3(), 1e-2);
  EXPECT_NEAR(c.gouge.mm3() + c.rest.mm3(), 0.0, 1e-2);
}

TEST(Compare, AFloorCutTooDeepIsAGougeOfThatDepth) {
  const Comparison c = compared(*cut_step(-3.2, 20), stepped(5));
  ASSERT_EQ(c.region_count, 1u);
  EXPECT_EQ(c.regions[0].kind, DifferenceKind::gouge);
  EXPECT_NEAR(c.regions[0].depth.mm(), 0.2, 1e-4);
  EXPECT_NEAR(c.gouge_beyond.mm3(), 0.2 * 400, 0.1);
  EXPECT_NEAR(c.gouge.mm3(), c.gouge_beyond.mm3(), 1e-6);
  EXPECT_NEAR(c.regions[0].at.z, -3.2, 1e-3);
  EXPECT_NEAR(c.rest.mm3(), 0.0, 1e-6);
}

TEST(Compare, AWallThatStandsOffCountsByItsDistanceNotItsHeight) {
  const Comparison c = compared(*cut_step(-3, 19.5), stepped(5));
  ASSERT_EQ(c.region_count, 1u);
  EXPECT_EQ(c.regions[0].kind, DifferenceKind::rest);
  EXPECT_NEAR(c.regions[0].depth.mm(), 0.45, 1e-3);  // the last column's middle
  EXPECT_NEAR(c.rest_beyond.mm3(), 0.5 * 20 * 3, 0.2);
  EXPECT_NEAR(c.regions[0].bounds.low.x, 19.55, 1e-6);
  const std::size_t row = 100 * 400;
  EXPECT_GT(c.map[row + 197], 0.0f);
  EXPECT_EQ(c.map[row + 150], 0.0f);
  EXPECT_TRUE(c.in_target[row]);
}

TEST(Compare, DifferencesWithinTheToleranceAreCountedButNotTold) {
  const Comparison c = compared(*cut_step(-3.2, 20), stepped(5), 0.3);
  EXPECT_EQ(c.region_count, 0u);
  EXPECT_NEAR(c.gouge.mm3(), 80.0, 0.1);
  EXPECT_EQ(c.gouge_beyond.mm3(), 0.0);
}

TEST(Compare, SeparatePlacesAreSeparateAndTheDeepestIsFirst) {
  Triangles target = box_mesh({0, 0, -8}, {40, 20, 0});
  Path path;
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 20, 0}})));
  path.tool(1).rapid({10, 10, 5}).cut({10, 10, -1}).rapid({10, 10, 5}).rapid({30, 10, 5}).cut({30, 10, -2});
  Diagnostics diagnostics;
  const auto part = run(path.path(), tools, block({0, 0, -8}, {40, 20, 0}), 0.1, diagnostics);
  const Comparison c = compared(*part, target);
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

TEST(Compare, ATargetOutsideTheStockIsTold) {
  const auto part = cut_step(-3, 20);
  const auto body = target_of(box_mesh({0, 0, -8}, {41, 20, 0}));
  Diagnostics diagnostics;
  EXPECT_TRUE(compare(part->workpiece, *body, {}, diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, Code::target_outside);
}

}  // namespace
}  // namespace kerf::test
