// Exact meshes: distances to tools and sweeps, intersections of planes, and parts with known edges.
#include "kerf/sim/exact_mesh.h"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "../sim_cut/cut_jobs.h"
#include "sim/cut/simulation_plan.h"
#include "sim/exact/quadric.h"
#include "sim/exact/sweep_distance.h"
#include "sim/exact/tool_distance.h"

namespace kerf::test {
namespace {

constexpr double kPitch = 0.1;

TEST(ToolDistance, OfASquareToolIsThatOfItsHalfProfile) {
  const sim::ToolDistance tool(make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}})).silhouette);
  EXPECT_DOUBLE_EQ(tool.at(4.0, 5.0).value, 1.0);
  EXPECT_DOUBLE_EQ(tool.at(4.0, 5.0).by_r, 1.0);
  EXPECT_DOUBLE_EQ(tool.at(1.0, -2.0).value, 2.0);
  EXPECT_DOUBLE_EQ(tool.at(1.0, -2.0).by_z, -1.0);
  EXPECT_DOUBLE_EQ(tool.at(6.0, -4.0).value, 5.0);  // from the edge
  EXPECT_DOUBLE_EQ(tool.at(2.5, 4.0).value, -0.5);
  EXPECT_DOUBLE_EQ(tool.at(3.0, 4.0).by_r, 1.0);  // on the flank
  EXPECT_LT(tool.at(1.0, 200.0).value, 0.0);      // the topmost part is extended upwards
}

TEST(ToolDistance, OfAConcaveArcIsMeasuredToTheArc) {
  const sim::ToolDistance tool(
      make_drawn(1, profile({{0, 0, 0}, {0.5, 0, -kQuarter}, {2.5, 2, 0}, {2.5, 6, 0}})).silhouette);
  const double far = std::hypot(2.0 - 2.5, 0.5 - 0.0);  // from the arc's centre
  EXPECT_NEAR(tool.at(2.0, 0.5).value, 2.0 - far, 1e-12);
}

TEST(ToolDistance, NeverChangesFasterThanThePosition) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> r(0.0, 7.0), z(-3.0, 15.0);
  for (const NamedProfile& each : all_profiles()) {
    const sim::ToolDistance tool(make_drawn(1, each.profile).silhouette);
    for (int n = 0; n < 2000; ++n) {
      const double r0 = r(random), z0 = z(random), r1 = r(random), z1 = z(random);
      const double grown = tool.at(r1, z1).value - tool.at(r0, z0).value;
      ASSERT_LE(std::abs(grown), std::hypot(r1 - r0, z1 - z0) + 1e-12) << each.name;
      const sim::ProfileDistance here = tool.at(r0, z0);
      ASSERT_NEAR(std::hypot(here.by_r, here.by_z), 1.0, 1e-9) << each.name;
      if (std::abs(here.value) > 1e-3) {
        const double away = tool.at(r0 + 1e-6 * here.by_r, z0 + 1e-6 * here.by_z).value - here.value;
        EXPECT_NEAR(away, 1e-6, 1e-9) << each.name << " at " << r0 << " " << z0;
      }
    }
  }
}

TEST(SweepDistance, TheNearestPointOfAnArcIsOnIt) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi), at(-9.0, 9.0);
  for (int n = 0; n < 3000; ++n) {
    sim::Sweep arc;
    arc.is_arc = true;
    arc.radius = 5.0;
    const double start = angle(random);
    arc.ux = std::cos(start);
    arc.uy = std::sin(start);
    arc.turn = 2.0 * angle(random);
    const Point2 query{at(random), at(random)};
    double nearest = 1e9;
    constexpr int kParts = 2000;
    for (int k = 0; k <= kParts; ++k) {
      const double a = start + arc.turn * k / kParts;
      nearest = std::min(nearest, distance(query, {5.0 * std::cos(a), 5.0 * std::sin(a)}));
    }
    const double found = distance(query, sim::nearest_in_plan(arc, query));
    EXPECT_LE(found, nearest + 1e-9) << n;
    EXPECT_GE(found, nearest - 5.0 * std::abs(arc.turn) / kParts) << n;
  }
}

struct Query {
  sim::Sweep sweep;
  Point3 at;
};
/// A straight sweep, sometimes a plunge, and a query point near what it removes.
template <class In>
Query draw(const sim::ToolDistance& tool, const In& in) {
  Query query;
  sim::Sweep& sweep = query.sweep;
  const double angle = in(0.0, 6.3);
  sweep.ux = std::cos(angle);
  sweep.uy = std::sin(angle);
  sweep.length = in(0.0, 1.0) < 0.2 ? 0.0 : in(0.1, 20.0);
  sweep.slope = sweep.length > 0.0 ? in(-1.0, 1.0) : 0.0;
  sweep.z_end = sweep.length > 0.0 ? sweep.length * sweep.slope : in(-9.0, 9.0);
  const double t = in(0.0, sweep.length), r = in(0.0, tool.rim() + 2.0), around = in(0.0, 6.3);
  query.at = {t * sweep.ux + r * std::cos(around), t * sweep.uy + r * std::sin(around),
              in(0.0, 1.0) * sweep.z_end + in(-2.0, 12.0)};
  return query;
}
double sampled_distance(const Query& query, const sim::ToolDistance& tool) {
  constexpr int kParts = 4000;
  double nearest = 1e9;
  for (int k = 0; k <= kParts; ++k) {
    const double fraction = static_cast<double>(k) / kParts, t = fraction * query.sweep.length;
    const double rho = std::hypot(query.at.x - t * query.sweep.ux, query.at.y - t * query.sweep.uy);
    nearest = std::min(nearest, tool.at(rho, query.at.z - fraction * query.sweep.z_end).value);
  }
  return nearest;
}

TEST(SweepDistance, IsTheMinimumOverAllPositionsOfTheTool) {
  constexpr double kReach = 2.0, kNear = 0.3, kMoved = 0.1;
  std::mt19937_64 random(5);
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (const NamedProfile& each : all_profiles()) {
    const sim::ToolDistance tool(make_drawn(1, each.profile).silhouette);
    for (int n = 0; n < 1000; ++n) {
      Query query = draw(tool, in);
      const double step = std::hypot(query.sweep.length, query.sweep.z_end) / 4000;
      const sim::PathDistance found = sim::distance_along(query.sweep, tool, query.at, kReach);
      const sim::DistanceBounds bounds = sim::bounds_of_distance(query.sweep, tool, query.at, kReach);
      const double nearest = sampled_distance(query, tool);
      if (std::abs(nearest) > kNear) continue;
      // Tools that are not convex may have two minima between two samples; either is accepted.
      EXPECT_LE(found.distance.value, nearest + (tool.is_convex() ? 1e-7 : 0.02)) << each.name << " " << n;
      EXPECT_GE(found.distance.value, nearest - step) << each.name << " " << n;
      EXPECT_LE(bounds.low, nearest + 1e-7) << each.name << " " << n;
      EXPECT_GE(bounds.high, found.distance.value - 1e-7) << each.name << " " << n;
      const Point3 moved{in(-kMoved, kMoved), in(-kMoved, kMoved), in(-kMoved, kMoved)};
      query.at = query.at + moved;
      const double afresh = sim::distance_along(query.sweep, tool, query.at, kReach).distance.value;
      const double beside =
          sim::distance_beside(query.sweep, tool, query.at, kReach, found, moved).distance.value;
      EXPECT_LE(std::min(beside, kReach), std::min(afresh, kReach) + 1e-7) << each.name << " " << n;
    }
  }
}

TEST(Quadric, StepsToTheIntersectionOfPlanes) {
  sim::Quadric quadric;
  quadric.add({1, 0, 0}, 2.0);
  EXPECT_EQ(quadric.rank(0.01), 1);
  EXPECT_NEAR(distance(quadric.solve(3, 0.01), {2, 0, 0}), 0.0, 1e-12);
  const double half = std::sqrt(0.5);
  quadric.add({half, half, 0}, 0.0);
  EXPECT_NEAR(distance(quadric.solve(3, 0.01), {2, -2, 0}), 0.0, 1e-12);
  quadric.add({0, 0, -1}, 3.0);
  EXPECT_EQ(quadric.rank(0.01), 3);
  EXPECT_NEAR(distance(quadric.solve(3, 0.01), {2, -2, -3}), 0.0, 1e-12);
  quadric.fix(0);
  EXPECT_NEAR(quadric.solve(3, 0.01).x, 0.0, 1e-12);
}

struct Part {
  Mesh rough, exact;
};
Part part_of(const Toolpath& path, const Profile& cutting, const Stock& stock) {
  ToolTable tools;
  tools.set(1, make_drawn(1, cutting));
  Diagnostics diagnostics;
  const auto result = run(path, tools, stock, kPitch, diagnostics);
  Part part;
  if (!result) return part;
  part.rough = part.exact = extract_mesh(result->workpiece.grid());
  EXPECT_TRUE(make_mesh_exact(part.exact, *result));
  return part;
}

Point3 vertex_of(const Mesh& mesh, std::size_t v) {
  const float* p = &mesh.positions[3 * v];
  return {p[0], p[1], p[2]};
}

/// The largest error of the vertices; `error` has none for vertices that do not count.
template <class Error>
double largest_error(const Mesh& mesh, const Error& error) {
  double largest = 0.0;
  for (std::size_t v = 0; v < mesh.positions.size() / 3; ++v)
    largest = std::max(largest, error(vertex_of(mesh, v)).value_or(0.0));
  return largest;
}

const Stock kBlock = block({0, 0, -10}, {40, 30, 0});

TEST(ExactMesh, WallsAndFloorOfASlotAreExact) {
  Path path;
  path.tool(1).rapid({7.013, 6.027, 5}).cut({7.013, 6.027, -4}).cut({31.31, 22.77, -4});
  const Part part = part_of(path.path(), profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}}), kBlock);
  const Point2 a{7.013, 6.027}, way = (1.0 / distance(a, {31.31, 22.77})) * (Point2{31.31, 22.77} - a);
  // All vertices below the top belong to the slot: on its wall, or on its floor within it.
  const auto off_wall = [&](Point3 p) -> std::optional<double> {
    if (p.z > -1e-4 || p.z < -9.0) return std::nullopt;
    const double along = std::clamp(dot(p.xy() - a, way), 0.0, distance(a, {31.31, 22.77}));
    const double rho = distance(p.xy(), a + along * way);
    return rho < 3.0 ? std::min(std::abs(p.z + 4.0), 3.0 - rho) : rho - 3.0;
  };
  EXPECT_GT(largest_error(part.rough, off_wall), 0.03);
  EXPECT_LT(largest_error(part.exact, off_wall), 2e-3);
  EXPECT_EQ(check_mesh(part.exact).bad_edges, 0u);
}

TEST(ExactMesh, AWallInANarrowLastColumnStaysInTheBlock) {
  constexpr double kWide = 12.02;  // the last column has a fifth of its width
  Path path;
  path.tool(1).rapid({-5, 8.027, 5}).cut({-5, 8.027, -2}).cut({9.02, 8.027, -2});
  const Part part =
      part_of(path.path(), profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}}), block({0, 0, -8}, {kWide, 16, 0}));
  for (const Mesh* mesh : {&part.rough, &part.exact}) {
    double largest = 0.0;
    for (std::size_t v = 0; v < mesh->positions.size() / 3; ++v)
      largest = std::max(largest, vertex_of(*mesh, v).x);
    EXPECT_LE(largest, kWide + 1e-6);
    EXPECT_EQ(check_mesh(*mesh).bad_edges, 0u);
  }
}

TEST(ExactMesh, TheBottomOfAGrooveIsSharp) {
  Path path;
  path.tool(1).rapid({5, 6.027, 5}).cut({5, 6.027, -2}).cut({31.31, 13.77, -2});
  const Part part = part_of(path.path(), profile({{0, 0, 0}, {4, 4, 0}, {4, 12, 0}}), kBlock);
  const Point2 a{5, 6.027}, b{31.31, 13.77}, way = (1.0 / distance(a, b)) * (b - a);
  // Nearly every section of four pitches along the groove has a vertex at the bottom.
  const auto lowest_along = [&](const Mesh& mesh) {
    std::vector<double> lowest(50, 0.0);
    for (std::size_t v = 0; v < mesh.positions.size() / 3; ++v) {
      const Point3 p = vertex_of(mesh, v);
      const double along = dot(p.xy() - a, way) - 1.0;
      if (p.z < -9.0 || std::abs(cross(way, p.xy() - a)) > 0.1 || along < 0.0 || along >= 20.0) continue;
      double& here = lowest[static_cast<std::size_t>(along / 0.4)];
      here = std::min(here, p.z);
    }
    std::sort(lowest.begin(), lowest.end());
    return lowest;
  };
  const std::vector<double> rough = lowest_along(part.rough), exact = lowest_along(part.exact);
  EXPECT_GT(rough[25], -1.99);
  EXPECT_LT(exact[45], -1.999);
  EXPECT_LT(exact[49], -1.99);
}

TEST(ExactMesh, NothingIsBelowTheDeepestCut) {
  Path path;
  path.tool(1).rapid({10, 10.03, 5}).cut({10, 10.03, -4}).cut({20.07, 10.03, -4}).cut({20.07, 14.33, -4});
  for (const double degrees : {20.0, 60.0, 90.0}) {
    const double high = 4.5 / std::tan(degrees / 2 * std::numbers::pi / 180.0);
    const Part part = part_of(path.path(), profile({{0, 0, 0}, {4.5, high, 0}, {4.5, high + 12, 0}}), kBlock);
    double lowest = 0.0;
    for (std::size_t v = 0; v < part.exact.positions.size() / 3; ++v)
      if (const double z = vertex_of(part.exact, v).z; z > -9.0) lowest = std::min(lowest, z);
    EXPECT_LT(lowest, -3.9) << degrees;
    EXPECT_GT(lowest, -4.00001) << degrees;
  }
}

TEST(ExactMesh, WhatIsOnTheBlockStaysOnIt) {
  Path path;
  path.tool(1).rapid({-5, 6.027, 5}).cut({-5, 6.027, -2}).cut({46, 13.77, -3.3});
  const Part part = part_of(path.path(), profile({{0, 0, kQuarter}, {3, 3, 0}, {3, 12, 0}}), kBlock);
  const auto outside = [](Point3 p) -> std::optional<double> {
    return std::max({-p.x, p.x - 40, -p.y, p.y - 30, -10 - p.z, p.z, 0.0});
  };
  EXPECT_LT(largest_error(part.exact, outside), 1e-6);
  const auto sides = [](const Mesh& mesh) {
    std::size_t count = 0;
    for (std::size_t v = 0; v < mesh.positions.size() / 3; ++v) {
      const Point3 p = vertex_of(mesh, v);
      count += p.x == 0 || p.x == 40 || p.y == 0 || p.y == 30;
    }
    return count;
  };
  EXPECT_GE(sides(part.exact), sides(part.rough));
  EXPECT_EQ(check_mesh(part.exact).bad_edges, 0u);
}

/// A ball so deep that its flanks are vertical at the top.
Path steep_rims() {
  Path path;
  path.tool(1).rapid({10, 8, 5}).cut({10, 8, -5}).cut({31, 13.77, -3});
  return path;
}
const Profile kDeepBall = profile({{0, 0, kQuarter}, {3, 3, 0}, {3, 12, 0}});

/// The number of oblique triangles with the step of the stock's surface.
std::size_t oblique(const Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.step.size(); ++t) {
    if (mesh.step[t] != kStockSurface) continue;
    const Point3 a = vertex_of(mesh, mesh.triangles[3 * t]), b = vertex_of(mesh, mesh.triangles[3 * t + 1]),
                 c = vertex_of(mesh, mesh.triangles[3 * t + 2]);
    const Point3 n = cross(b - a, c - a);
    const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
    count += largest < 0.999 * length(n);
  }
  return count;
}

TEST(ExactMesh, SteepRimsBelongToTheCut) {
  const Part part = part_of(steep_rims().path(), kDeepBall, kBlock);
  EXPECT_GT(oblique(part.rough), 50u);
  EXPECT_LE(oblique(part.exact), 2u);
}

TEST(RelabelledMesh, SteepRimsBelongToTheCutToo) {
  Path path = steep_rims();
  ToolTable tools;
  tools.set(1, make_drawn(1, kDeepBall));
  Diagnostics diagnostics;
  const auto result = run(path.path(), tools, kBlock, kPitch, diagnostics);
  ASSERT_TRUE(result);
  const Mesh rough = extract_mesh(MeshColumns(result->workpiece), {});
  Mesh mesh = rough;
  relabel_mesh(mesh, result->workpiece);
  EXPECT_GT(oblique(rough), 50u);
  EXPECT_EQ(oblique(mesh), 0u);
  EXPECT_EQ(mesh.positions, rough.positions);
  EXPECT_EQ(mesh.triangles, rough.triangles);
}

TEST(ExactMesh, IsTheSameFromKeptSweepsAndFromThePath) {
  Diagnostics diagnostics;
  auto result =
      run(random_job(6, 150), square_and_keyhole(), block({0, 0, -10}, {50, 40, 0}), 0.5, diagnostics);
  ASSERT_TRUE(result && result->plan->batches.complete());
  const Mesh rough = extract_mesh(MeshColumns(result->workpiece), {});
  Mesh kept = rough, planned = rough;
  ASSERT_TRUE(make_mesh_exact(kept, *result));
  const auto without_batches = std::make_shared<Simulation::Plan>();
  without_batches->survey = result->plan->survey;
  result->plan = without_batches;
  ASSERT_TRUE(make_mesh_exact(planned, *result));
  EXPECT_NE(kept.positions, rough.positions);
  EXPECT_EQ(kept.positions, planned.positions);
  EXPECT_EQ(kept.triangles, planned.triangles);
  EXPECT_EQ(kept.step, planned.step);
}

TEST(ExactMesh, ADiscardedRunLeavesTheMeshAsItWas) {
  class Stopped : public Progress {
   public:
    void phase(std::string_view) override {}
    void report(double) override {}
    bool stop_requested() override { return true; }
  } stopped;
  Path path;
  path.tool(1).rapid({7, 6, 5}).cut({7, 6, -4}).cut({31, 22, -4});
  ToolTable tools;
  tools.set(1, make_drawn(1, profile({{0, 0, 0}, {3, 0, 0}, {3, 12, 0}})));
  Diagnostics diagnostics;
  const auto result = run(path.path(), tools, kBlock, kPitch, diagnostics);
  ASSERT_TRUE(result);
  const Mesh rough = extract_mesh(result->workpiece.grid());
  Mesh mesh = rough;
  EXPECT_FALSE(make_mesh_exact(mesh, *result, {}, &stopped));
  EXPECT_EQ(mesh.positions, rough.positions);
  EXPECT_EQ(mesh.triangles, rough.triangles);
}

}  // namespace
}  // namespace kerf::test
