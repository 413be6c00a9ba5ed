// Meshes of cut workpieces.
#include <gtest/gtest.h>

#include "../sim_cut/cut_jobs.h"
#include "../stock/solids.h"

#include "kerf/sim/mesh.h"
#include "kerf/stock/stock.h"

namespace kerf::test {
namespace {

TEST(WorkpieceMesh, IsThatOfItsGrid) {
  // Uncut tiles, undercuts, holes, and narrower columns at the high sides.
  const Stock stock = block({-30, 0, -10}, {50, 40, 0});
  Path path;
  path.tool(1).rapid({10, 20, 2}).cut({10, 20, -11}).cut({30, 20, -11});
  for (const Toolpath& job : {random_job(3, 200), path.path()}) {
    Diagnostics diagnostics;
    const auto result = run(job, square_and_keyhole(), stock, 0.3, diagnostics);
    ASSERT_TRUE(result);
    const ColumnGrid grid = result->workpiece.grid();
    const MeshColumns columns(result->workpiece);
    const MeshOptions options{.tolerance = mm(0.002)};
    const Mesh a = extract_mesh(grid, options), b = extract_mesh(columns, options);
    EXPECT_FALSE(a.triangles.empty());
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(mesh_volume(grid).expected, mesh_volume(columns).expected);
    EXPECT_EQ(mesh_volume(grid).tolerance, mesh_volume(columns).tolerance);
    EXPECT_NEAR(mesh_volume(columns).expected.mm3(), result->workpiece.volume().mm3(),
                mesh_volume(columns).tolerance.mm3());
  }
}

TEST(WorkpieceMesh, OfASlotThroughASphereIsClosedAndHasTheColumnsVolume) {
  const Triangles sphere = sphere_mesh({0, 0, 0}, 10, 300);
  Diagnostics diagnostics;
  const auto body = make_mesh_body(sphere.positions, sphere.triangles, "sphere.stl", diagnostics);
  ASSERT_TRUE(body);
  Path path;
  path.tool(1).rapid({-20, 0, 20}).cut({-20, 0, 0}).cut({20, 0, 0});
  const auto result = run(path.path(), square_and_keyhole(), stock_of(body), 0.05, diagnostics);
  ASSERT_TRUE(result && diagnostics.list().empty());
  const MeshCheck check = check_mesh(extract_mesh(result->workpiece.grid()));
  EXPECT_EQ(check.bad_edges, 0u);
  EXPECT_NEAR(check.volume.mm3(), result->workpiece.volume().mm3(), 2.0);
}

}  // namespace
}  // namespace kerf::test
