// Simulated parts against the same parts shifted sideways: volumes and depths at walls in closed form.
#include <gtest/gtest.h>
#include <numbers>

#include "../sim_cut/cut_jobs.h"
#include "../stock/solids.h"

#include "kerf/sim/compare.h"

namespace kerf::test {
namespace {

constexpr double kSize = 100.0;   // mm, width and length of the block; columns are 0.1 mm apart by default
constexpr double kShift = 0.1;    // mm
constexpr double kWithin = 0.02;  // of the volumes
constexpr double kDeep = 0.003;   // mm, of the depths: the chords of the exact mesh and of the target
const Stock kBlock = block({0, 0, -10}, {kSize, kSize, 0});

/// A block with a slot along Y: half as wide as `top` at Z0 and as `bottom` on its floor.
Triangles slotted(double centre, double top, double bottom, double depth) {
  const std::vector<Point2> outline{{0, -10},
                                    {kSize, -10},
                                    {kSize, 0},
                                    {centre + top, 0},
                                    {centre + bottom, -depth},
                                    {centre - bottom, -depth},
                                    {centre - top, 0},
                                    {0, 0}};
  const auto count = static_cast<std::uint32_t>(outline.size());
  Triangles out;
  for (const double y : {0.0, kSize})
    for (const Point2 p : outline) out.point({p.x, y, p.y});
  for (std::uint32_t a = 0; a < count; ++a) {
    const std::uint32_t b = (a + 1) % count;
    out.face(a, a + count, b);
    out.face(b, a + count, b + count);
  }
  const std::uint32_t caps[][3] = {{0, 1, 5}, {1, 4, 5}, {1, 2, 4}, {2, 3, 4}, {0, 5, 6}, {0, 6, 7}};
  for (const auto& [a, b, c] : caps) {
    out.face(a, b, c);
    out.face(a + count, c + count, b + count);
  }
  return out;
}

/// A block with a round hole from Z0 down.
Triangles bored(Point2 centre, double radius, double depth) {
  Triangles out = box_mesh({0, 0, -10}, {kSize, kSize, 0});
  out.add(prism_mesh({centre.x, centre.y, -depth}, radius, depth, 720), true);
  return out;
}

Comparison compared(const Toolpath& path, const Profile& cutting, double pitch, const Triangles& target,
                    double tolerance = 0.05) {
  ToolTable tools;
  tools.set(1, make_drawn(1, cutting));
  Diagnostics diagnostics;
  const auto part = run(path, tools, kBlock, pitch, diagnostics);
  const auto body = make_mesh_body(target.positions, target.triangles, "target.stl", diagnostics);
  const auto found = compare(*part, *body, {.tolerance = mm(tolerance)}, diagnostics);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << to_string(d);
  return found ? *found : Comparison{};
}

/// Gouge and rest are alike, and all of both is beyond the tolerance.
void expect_both(const Comparison& c, double volume, double depth) {
  EXPECT_NEAR(c.gouge.mm3(), volume, kWithin * volume);
  EXPECT_NEAR(c.rest.mm3(), volume, kWithin * volume);
  EXPECT_NEAR(c.gouge_beyond.mm3(), volume, kWithin * volume);
  EXPECT_NEAR(c.rest_beyond.mm3(), volume, kWithin * volume);
  for (const DifferenceKind kind : {DifferenceKind::gouge, DifferenceKind::rest}) {
    double deepest = 0.0;
    for (const DifferenceRegion& region : c.regions)
      if (region.kind == kind) deepest = std::max(deepest, region.depth.mm());
    EXPECT_NEAR(deepest, depth, kDeep) << to_string(kind);
  }
}

Toolpath slot(double centre, double depth) {
  Path path;
  path.tool(1).rapid({centre, -10, 5}).rapid({centre, -10, -depth}).cut({centre, kSize + 10, -depth});
  return path.path();
}
const Profile kSquare = profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}});
const Profile kSloped = profile({{0, 0, 0}, {1, 0, 0}, {4, 5, 0}, {4, 12, 0}});

class ShiftedWalls : public testing::TestWithParam<double> {};  // by the pitch, mm

TEST_P(ShiftedWalls, OfASlot) {
  for (const double centre : {50.0, 50.037}) {
    SCOPED_TRACE(centre);
    expect_both(compared(slot(centre, 6), kSquare, GetParam(), slotted(centre + kShift, 3, 3, 6)),
                kShift * 6 * kSize, kShift);
  }
}

TEST_P(ShiftedWalls, OfSlopesBesideAFloor) {
  const double centre = 50.037;
  expect_both(compared(slot(centre, 5), kSloped, GetParam(), slotted(centre + kShift, 4, 1, 5)),
              kShift * 5 * kSize, kShift * 5 / std::hypot(3.0, 5.0));
}

TEST_P(ShiftedWalls, OfARoundHole) {
  const double r = 3.0, depth = 6.0;
  const Point2 centre{50.013, 50.057};
  Path path;
  path.tool(1).rapid({centre.x, centre.y, 5}).cut({centre.x, centre.y, -depth});
  const double lens =
      2 * r * r * std::acos(0.5 * kShift / r) - 0.5 * kShift * std::sqrt(4 * r * r - kShift * kShift);
  const Comparison c =
      compared(path.path(), kSquare, GetParam(), bored(centre + Point2{kShift, 0}, r, depth));
  const double volume = (std::numbers::pi * r * r - lens) * depth;
  EXPECT_NEAR(c.gouge.mm3(), volume, kWithin * volume);
  EXPECT_NEAR(c.rest.mm3(), volume, kWithin * volume);
  ASSERT_GE(c.regions.size(), 2u);
  EXPECT_NEAR(c.regions[0].depth.mm(), kShift, kDeep);
  EXPECT_NEAR(c.regions[1].depth.mm(), kShift, kDeep);
}

TEST_P(ShiftedWalls, NotShiftedAreEqual) {
  constexpr double kBound = 0.002;  // mm on all walls: the tolerance of the exact mesh
  for (const double centre : {50.0, 50.037}) {
    const Comparison c = compared(slot(centre, 6), kSquare, GetParam(), slotted(centre, 3, 3, 6), kBound);
    EXPECT_EQ(c.region_count, 0u);
    EXPECT_LT(c.gouge.mm3() + c.rest.mm3(), kBound * 2 * 6 * kSize);
    const double left = kSize * kSize * 10 - 6 * 6 * kSize;
    EXPECT_NEAR(c.part.mm3(), left, kBound * 2 * 6 * kSize);
    EXPECT_NEAR(c.target.mm3(), left, kBound * 2 * 6 * kSize);
  }
}

INSTANTIATE_TEST_SUITE_P(Pitches, ShiftedWalls, testing::Values(0.1, 0.25));

}  // namespace
}  // namespace kerf::test
