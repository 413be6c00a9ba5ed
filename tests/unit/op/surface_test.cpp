// Tools on meshes, against a model that knows nothing but points of the triangles: no point may be inside of
// the tool, and one must be near it.
#include "kerf/op/surface.h"

#include <array>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "base/codes/op.h"
#include "op/mesh/drop_cutter.h"
#include "swept.h"

namespace kerf {
namespace {

using op_detail::DropCutter;

Tool tool_of(const ToolShape& shape) {
  Diagnostics diagnostics;
  auto tool = make_tool(1, shape, {}, {}, diagnostics);
  return *tool;
}
std::vector<std::pair<std::string, Tool>> end_mills() {
  return {{"ball", tool_of(shape::Ball{mm(6), mm(20)})},
          {"bull nose", tool_of(shape::BullNose{mm(6), mm(20), mm(0.5)})},
          {"square", tool_of(shape::Square{mm(6), mm(20)})},
          {"V", tool_of(shape::Vee{mm(6), mm(20), degrees(60), {}, {}})},
          {"flat V", tool_of(shape::Vee{mm(6), mm(20), degrees(90), mm(1), {}})},
          {"round V", tool_of(shape::Vee{mm(6), mm(20), degrees(60), {}, mm(0.5)})},
          {"tapered ball", tool_of(shape::TaperedBall{mm(6), mm(20), degrees(20), mm(2)})}};
}

/// How high the silhouette is at a distance from the axis, by bisection of its radius.
double height_of(const Tool& tool, double r) {
  const Profile& profile = tool.silhouette.cutting;
  if (profile.radius_at(0.0) >= r) return 0.0;
  double low = 0.0, high = profile.top();
  for (int i = 0; i < 60; ++i) {
    const double midpoint = 0.5 * (low + high);
    (profile.radius_at(midpoint) >= r ? high : low) = midpoint;
  }
  return high;
}

/// Points of all triangles, `n` along each side.
std::vector<Point3> points_on(const SurfaceMesh& mesh, int n) {
  std::vector<Point3> points;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const double u = i / double(n), v = j / double(n);
        points.push_back((1.0 - u - v) * mesh.points[t[0]] + u * mesh.points[t[1]] + v * mesh.points[t[2]]);
      }
  return points;
}
/// The height of a tip that no point is above.
double lowest_tip(const std::vector<Point3>& points, const Tool& tool, Point2 at, double floor) {
  double z = floor;
  for (const Point3& p : points)
    if (const double r = distance(p.xy(), at); r <= 0.5 * tool.diameter.mm() - 1e-9 && p.z > z)
      z = std::max(z, p.z - height_of(tool, r));
  return z;
}

void add(SurfaceMesh& mesh, Point3 a, Point3 b, Point3 c) {
  const auto n = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), {a, b, c});
  mesh.triangles.push_back({n, n + 1, n + 2});
}
/// A closed box.
void add_box(SurfaceMesh& mesh, Point3 a, Point3 b) {
  const auto corner = [&](int i) {
    return Point3{(i & 1) != 0 ? b.x : a.x, (i & 2) != 0 ? b.y : a.y, (i & 4) != 0 ? b.z : a.z};
  };
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}};
  for (const auto& f : faces) {
    add(mesh, corner(f[0]), corner(f[1]), corner(f[2]));
    add(mesh, corner(f[0]), corner(f[2]), corner(f[3]));
  }
}

SurfaceMesh random_mesh(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(0.0, 12.0), height(-4.0, 0.0), small(-0.3, 0.3);
  SurfaceMesh mesh;
  const auto point = [&] { return Point3{coordinate(random), coordinate(random), height(random)}; };
  for (int i = 0; i < 3; ++i) add(mesh, point(), point(), point());
  Point3 a = point(), b = point();
  add(mesh, a, b, a + 1e-3 * Point3{small(random), small(random), small(random)});  // a needle
  add(mesh, {a.x, a.y, -4}, {b.x, b.y, -4}, {a.x, a.y, 0});                         // vertical
  add(mesh, a, a, a);                                                               // a point
  add(mesh, a, b, 0.5 * (a + b));                                                   // a line
  a = point();
  add(mesh, {a.x, a.y, -4}, {a.x, a.y, -1}, {a.x, a.y, -2});  // a vertical line
  a.z = -1.5;
  add(mesh, a, a + Point3{3, 0, 0}, a + Point3{0, 3, 0});  // level
  a = {std::floor(coordinate(random)), std::floor(coordinate(random)), -4};
  add_box(mesh, a, a + Point3{2, 2, 2});
  add_box(mesh, a + Point3{2, 0, 0}, a + Point3{4, 1, 3});  // it touches the other one
  return mesh;
}

TEST(Surface, NoPointOfAMeshIsInsideOfATool) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> coordinate(-4.0, 16.0);
  for (int round = 0; round < 8; ++round) {
    const SurfaceMesh mesh = random_mesh(random);
    const std::vector<Point3> points = points_on(mesh, 30);
    for (const auto& [name, tool] : end_mills()) {
      const auto surface = op_detail::surface_tool(tool);
      ASSERT_TRUE(surface) << name;
      const DropCutter cutter(mesh, *surface, 1);
      for (int k = 0; k < 12; ++k) {
        Point2 at{coordinate(random), coordinate(random)};
        if (k % 4 == 0) at = {std::round(at.x), std::round(at.y)};
        const double z = cutter.at(at, -5.0), expected = lowest_tip(points, tool, at, -5.0);
        EXPECT_GE(z, expected - 1e-9) << name << " at " << at.x << ", " << at.y;
        // Points are less than 0.5 mm apart: one of them is near the tool where it touches.
        if (z < expected + 0.1) continue;
        bool near = false;
        for (const Point3& p : points) {
          const double r = distance(p.xy(), at);
          near = near || (r <= 3.5 && p.z - z > height_of(tool, std::clamp(r - 0.5, 0.0, 3.0)) - 0.5);
        }
        EXPECT_TRUE(near) << name << " at " << at.x << ", " << at.y << ": " << z << " above " << expected;
      }
    }
  }
}

/// Heights at the nodes of a grid, some of them level or the same as beside, as a closed body with vertical
/// walls.
SurfaceMesh relief(std::mt19937& random, int n, double pitch, int kind) {
  std::uniform_real_distribution<double> height(-2.0, 0.0);
  std::vector<double> z(static_cast<std::size_t>((n + 1) * (n + 1)));
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double x = static_cast<double>(i % static_cast<std::size_t>(n + 1)),
                 y = static_cast<double>(i / static_cast<std::size_t>(n + 1));
    z[i] = kind == 0   ? height(random)                                                 // rough
           : kind == 1 ? std::sin(0.9 * x) * std::cos(0.7 * y) - 1.0                    // smooth
           : kind == 2 ? std::max(-1.0, std::round(2.0 * std::sin(0.5 * x + 0.8 * y)))  // terraces
                       : 0.25 * x - 0.5 * y;                                            // a plane
  }
  SurfaceMesh mesh;
  const auto at = [&](int i, int j) {
    return Point3{i * pitch, j * pitch, z[static_cast<std::size_t>(j * (n + 1) + i)]};
  };
  const auto wall = [&](Point3 a, Point3 b) {
    const Point3 c{a.x, a.y, -9}, d{b.x, b.y, -9};
    add(mesh, c, d, b), add(mesh, c, b, a);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      add(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(mesh, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  for (int i = 0; i < n; ++i) {
    wall(at(i, 0), at(i + 1, 0)), wall(at(i + 1, n), at(i, n));
    wall(at(0, i + 1), at(0, i)), wall(at(n, i), at(n, i + 1));
  }
  return mesh;
}

TEST(Surface, NeighboursOfTrianglesChangeNoHeight) {
  // A triangle alone has no neighbours, so that nothing is known about where the tool touches it.
  std::mt19937 random(34);
  std::uniform_real_distribution<double> inside(-0.2, 1.2);
  for (int round = 0; round < 16; ++round) {
    const int n = 6;
    const double pitch = std::array{0.1, 0.5, 2.0, 0.013}[static_cast<std::size_t>(round / 4)];
    const SurfaceMesh mesh = relief(random, n, pitch, round % 4);
    for (const auto& [name, tool] : end_mills()) {
      const auto surface = op_detail::surface_tool(tool);
      const DropCutter cutter(mesh, *surface, 1);
      std::vector<Point2> at;
      std::vector<double> expected;
      for (int k = 0; k < 90; ++k) {
        Point2 p{inside(random) * n * pitch, inside(random) * n * pitch};
        if (k % 3 == 0) p = {std::round(p.x / pitch) * pitch, std::round(p.y / pitch) * pitch};
        if (k % 3 == 1) p.x = std::round(2.0 * p.x / pitch) * pitch / 2.0;
        at.push_back(p), expected.push_back(-20.0);
      }
      for (const auto& t : mesh.triangles) {
        SurfaceMesh alone;
        add(alone, mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
        const DropCutter one(alone, *surface, 1);
        for (std::size_t k = 0; k < at.size(); ++k) expected[k] = std::max(expected[k], one.at(at[k], -20.0));
      }
      for (std::size_t k = 0; k < at.size(); ++k)
        EXPECT_NEAR(cutter.at(at[k], -20.0), expected[k], 1e-6)
            << name << ", mesh " << round << " at " << at[k].x << ", " << at[k].y;
    }
  }
}

TEST(Surface, ContactsComputedByHand) {
  SurfaceMesh plane;  // rises by 3/4
  add(plane, {-50, -50, -37.5}, {50, -50, 37.5}, {50, 50, 37.5});
  add(plane, {-50, -50, -37.5}, {50, 50, 37.5}, {-50, 50, -37.5});
  const auto at = [&](const SurfaceMesh& mesh, const ToolShape& shape, Point2 p) {
    return DropCutter(mesh, *op_detail::surface_tool(tool_of(shape)), 1).at(p, -99.0);
  };
  // A ball touches at its radius times (1 / cos - 1) above the plane: cos = 0.8.
  EXPECT_NEAR(at(plane, shape::Ball{mm(6), mm(20)}, {1, 2}), 0.75 + 3.0 * 0.25, 1e-9);
  EXPECT_NEAR(at(plane, shape::Square{mm(6), mm(20)}, {1, 2}), 0.75 + 3.0 * 0.75, 1e-9);
  EXPECT_NEAR(at(plane, shape::BullNose{mm(6), mm(20), mm(1)}, {1, 2}), 0.75 + 2.0 * 0.75 + 0.25, 1e-9);
  // A cone of 45 degrees is steeper than the plane.
  EXPECT_NEAR(at(plane, shape::Vee{mm(6), mm(20), degrees(90), {}, {}}, {1, 2}), 0.75, 1e-9);
  EXPECT_NEAR(at(plane, shape::Vee{mm(6), mm(20), degrees(120), {}, {}}, {1, 2}),
              0.75 + 3.0 * 0.75 - 3.0 / std::sqrt(3.0), 1e-9);
  // A ball of 5 mm beside a level edge 3 mm away, and beside a vertical one.
  SurfaceMesh edge;
  add(edge, {-20, 0, 0}, {20, 0, 0}, {0, 10, -60});
  EXPECT_NEAR(at(edge, shape::Ball{mm(10), mm(20)}, {0, -3}), 4.0 - 5.0, 1e-9);
  SurfaceMesh wall;
  add(wall, {0, 0, -9}, {0, 0, 1}, {0, 0, 0});
  EXPECT_NEAR(at(wall, shape::Ball{mm(10), mm(20)}, {4, 0}), 1.0 - 2.0, 1e-9);
  EXPECT_EQ(at(wall, shape::Ball{mm(10), mm(20)}, {5.1, 0}), -99.0);
}

TEST(Surface, ToolsThatCannotComeDownOnAMesh) {
  EXPECT_FALSE(op_detail::surface_tool(tool_of(shape::Roundover{mm(2), mm(3), mm(10)})));
  SurfaceMesh mesh;
  add_box(mesh, {0, 0, -5}, {10, 10, 0});
  Diagnostics diagnostics;
  const Region area = test::region_of({test::rectangle(0, 0, 10, 10)});
  MeshCutOptions options;
  options.cut.feed = mm_per_min(900);
  EXPECT_FALSE(raster(mesh, area, tool_of(shape::Roundover{mm(2), mm(3), mm(10)}), options, diagnostics));
  ASSERT_FALSE(diagnostics.list().empty());
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
  const Tool ball = tool_of(shape::Ball{mm(6), mm(20)});
  EXPECT_FALSE(raster({}, area, ball, options, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_empty);
  options.cut.top = -1.0;
  EXPECT_FALSE(raster(mesh, area, ball, options, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
  options.cut.top = 0.0, options.line_distance = mm(-1);
  EXPECT_FALSE(raster(mesh, area, ball, options, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
}

/// How deep points are inside of a tool with its tip at `tip`: the way out sideways or downwards.
double inside(const std::vector<Point3>& points, const Tool& tool, Point3 tip) {
  double deepest = -INFINITY;
  for (const Point3& p : points) {
    const double r = distance(p.xy(), tip.xy()), up = p.z - tip.z;
    if (r >= 0.5 * tool.diameter.mm() || up <= 0.0) continue;
    const double sideways = tool.silhouette.cutting.radius_at(std::min(up, 19.0)) - r;
    if (sideways > deepest) deepest = std::max(deepest, std::min(sideways, up - height_of(tool, r)));
  }
  return deepest;
}

/// Calls visit(position) along all cuts of a path, at most 0.1 mm apart.
template <class Visit>
void along_cuts(const Toolpath& path, const Visit& visit) {
  Point3 here;
  for (const Step& step : path.steps()) {
    if (!step.is_motion()) continue;
    const Point3 to = step.to();
    const double whole = distance(here, to);
    const int n = step.kind() == StepKind::cut ? static_cast<int>(whole / 0.1) + 1 : 0;
    for (int i = 1; i <= n; ++i) visit(here + (i / double(n)) * (to - here));
    here = to;
  }
}

TEST(Surface, ARasterCutsNoMeshAndLeavesNoMoreThanTheTolerance) {
  std::mt19937 random(7);
  for (int round = 0; round < 4; ++round) {
    SurfaceMesh mesh = random_mesh(random);
    const std::vector<Point3> points = points_on(mesh, 25);
    const Region area = test::region_of({test::rectangle(1, 1, 9, 5)});
    for (const auto& [name, tool] : end_mills()) {
      MeshCutOptions options;
      options.cut.feed = mm_per_min(900), options.cut.depth = mm(4.5);
      options.line_distance = mm(1.7), options.angle = degrees(30 * round);
      options.cut.stepdown = round == 1 ? mm(2) : mm(0);
      Diagnostics diagnostics;
      const auto made = raster(mesh, area, tool, options, diagnostics);
      ASSERT_TRUE(made) << to_string(diagnostics.list().front());
      const DropCutter cutter(mesh, *op_detail::surface_tool(tool), 1);
      double deepest = -INFINITY;
      along_cuts(made->path, [&](Point3 p) { deepest = std::max(deepest, inside(points, tool, p)); });
      EXPECT_LT(deepest, name == "V" ? 0.01 : 0.002) << name << ", mesh " << round;
      if (options.cut.stepdown > Length{}) continue;
      // No higher than needed, but for jumps, which start a hundredth of a millimetre before a wall.
      for (std::size_t i = 1; i < made->path.size(); ++i) {
        if (made->path[i].kind() != StepKind::cut) continue;
        const Point3 p = made->path[i].to();
        double allowed = -INFINITY;
        for (int k = 0; k < 16; ++k) {
          const double angle = k * std::numbers::pi / 8.0;
          const Point2 beside = p.xy() + 0.011 * Point2{std::cos(angle), std::sin(angle)};
          allowed = std::max({allowed, cutter.at(beside, -4.5), cutter.at(p.xy(), -4.5)});
        }
        EXPECT_LE(p.z, allowed + 0.01 + 1e-6) << name << " at " << p.x << ", " << p.y;
      }
    }
  }
}

TEST(Surface, TheResultIsTheSameForAnyNumberOfThreads) {
  std::mt19937 random(3);
  const SurfaceMesh mesh = random_mesh(random);
  const Region area = test::region_of({test::rectangle(0, 0, 12, 12)});
  std::vector<Toolpath> paths;
  for (const unsigned threads : {1u, 2u, 5u}) {
    MeshCutOptions options;
    options.cut.feed = mm_per_min(900), options.threads = threads;
    Diagnostics diagnostics;
    paths.push_back(raster(mesh, area, tool_of(shape::Ball{mm(6), mm(20)}), options, diagnostics)->path);
  }
  for (std::size_t k = 1; k < paths.size(); ++k) {
    ASSERT_EQ(paths[k].size(), paths[0].size());
    for (std::size_t i = 0; i < paths[0].size(); ++i) ASSERT_EQ(paths[k][i].to(), paths[0][i].to());
  }
}

TEST(Surface, AnAllowanceKeepsTheToolAwayFromTheMesh) {
  SurfaceMesh mesh;
  add_box(mesh, {0, 0, -5}, {10, 10, -2});
  add(mesh, {0, 0, -2}, {10, 0, -1}, {10, 10, -2});
  const std::vector<Point3> points = points_on(mesh, 14);
  for (const auto& [name, tool] : end_mills()) {
    MeshCutOptions options;
    options.cut.feed = mm_per_min(900), options.cut.allowance = mm(0.3), options.line_distance = mm(1);
    Diagnostics diagnostics;
    const auto made =
        raster(mesh, test::region_of({test::rectangle(-2, -2, 12, 12)}), tool, options, diagnostics);
    ASSERT_TRUE(made);
    double nearest = INFINITY;
    along_cuts(made->path, [&](Point3 tip) {
      if (tip.z > 0.0) return;
      for (const Point3& p : points) {
        const double r = distance(p.xy(), tip.xy());
        if (r < 2.9) nearest = std::min(nearest, height_of(tool, r) + tip.z - p.z);
      }
    });
    // The vertical distance is at least the allowance.
    EXPECT_GT(nearest, 0.3 - 0.001) << name;
    EXPECT_LT(nearest, 0.61) << name;  // beside a cone of 60 degrees, at a wall
  }
}

TEST(Surface, WaterlinesTouchTheMeshAndCutNoneOfIt) {
  std::mt19937 random(11);
  for (int round = 0; round < 3; ++round) {
    const SurfaceMesh mesh = random_mesh(random);
    const std::vector<Point3> points = points_on(mesh, 25);
    for (const auto& [name, tool] : end_mills()) {
      MeshCutOptions options;
      options.cut.feed = mm_per_min(900), options.cut.stepdown = mm(1.3);
      Diagnostics diagnostics;
      const auto made = waterline(mesh, tool, options, diagnostics);
      ASSERT_TRUE(made) << name;
      const DropCutter cutter(mesh, *op_detail::surface_tool(tool), 1);
      double deepest = -INFINITY;
      std::size_t cuts = 0, away = 0;
      along_cuts(made->path, [&](Point3 p) { deepest = std::max(deepest, inside(points, tool, p)); });
      EXPECT_LT(deepest, name == "V" ? 0.01 : 0.002) << name << ", mesh " << round;
      for (std::size_t i = 0; i + 1 < made->path.size(); ++i) {
        const Step &step = made->path[i], &next = made->path[i + 1];
        if (step.kind() != StepKind::cut) continue;
        const Point3 p = step.to();
        // The way to the next level leads down from here.
        if (next.is_motion() && next.to().xy() == p.xy() && next.to().z < p.z) continue;
        bool touches = false;
        for (int k = 0; k < 16; ++k) {
          const double angle = k * std::numbers::pi / 8.0;
          const Point2 beside = p.xy() + 0.015 * Point2{std::cos(angle), std::sin(angle)};
          touches = touches || cutter.at(beside, -9.0) > p.z;
        }
        ++cuts, away += touches ? 0 : 1;
      }
      EXPECT_GT(cuts, 40u) << name;
      EXPECT_EQ(away, 0u) << name << ", mesh " << round << ": of " << cuts << " points";
    }
  }
}

TEST(Surface, AWaterlineAroundABoxIsItsOutlineWiderByTheTool) {
  SurfaceMesh mesh;
  add_box(mesh, {0, 0, -5}, {20, 10, 0});
  MeshCutOptions options;
  options.cut.feed = mm_per_min(900), options.cut.stepdown = mm(2.5);
  Diagnostics diagnostics;
  const auto made = waterline(mesh, tool_of(shape::Square{mm(6), mm(20)}), options, diagnostics);
  ASSERT_TRUE(made);
  double length = 0.0, area = 0.0;
  Point3 here;
  for (const Step& step : made->path.steps()) {
    if (!step.is_motion()) continue;
    const Point3 to = step.to();
    if (step.kind() == StepKind::cut && here.z == to.z) {
      length += distance(here, to), area += 0.5 * cross(here.xy(), to.xy());
      const Point2 out{std::max({-to.x, to.x - 20.0, 0.0}), std::max({-to.y, to.y - 10.0, 0.0})};
      EXPECT_GE(kerf::length(out), 3.0 - 1e-6);
      EXPECT_LE(kerf::length(out), 3.0 + 0.0101);
    }
    here = to;
  }
  // Twice around, clockwise: the part is on the right of a climbing tool.
  EXPECT_NEAR(length, 2.0 * (60.0 + 6.0 * std::numbers::pi), 0.2);
  EXPECT_NEAR(area, -2.0 * (200.0 + 3.0 * 60.0 + 9.0 * std::numbers::pi), 0.7);
}

/// A groove of 90 degrees along Y, 4 mm deep at X0.
SurfaceMesh groove() {
  SurfaceMesh mesh;
  const double x[5] = {-20, -4, 0, 4, 20}, z[5] = {0, 0, -4, 0, 0};
  for (int i = 0; i < 4; ++i) {
    add(mesh, {x[i], -10, z[i]}, {x[i + 1], -10, z[i + 1]}, {x[i + 1], 10, z[i + 1]});
    add(mesh, {x[i], -10, z[i]}, {x[i + 1], 10, z[i + 1]}, {x[i], 10, z[i]});
  }
  return mesh;
}

TEST(Surface, RestMachiningCutsWhatTheEarlierToolLeft) {
  const SurfaceMesh mesh = groove();
  const Tool large = tool_of(shape::Ball{mm(6), mm(20)}), small = tool_of(shape::Ball{mm(2), mm(20)});
  const Region area = test::region_of({test::rectangle(-15, -5, 15, 5)});
  MeshCutOptions options;
  options.cut.feed = mm_per_min(900), options.line_distance = mm(1), options.earlier = large;
  Diagnostics diagnostics;
  const auto made = raster(mesh, area, small, options, diagnostics);
  ASSERT_TRUE(made);
  // The large ball touches both flanks at X = -+ 3 / sqrt(2), and leaves 3 (sqrt(2) - 1) mm above the edge.
  // What is thinner than 0.1 mm ends by the flanks where the circle is that far from them.
  const double contact = 3.0 / std::sqrt(2.0);
  const double thick = contact - std::sqrt(2.0 * 3.0 * 0.1) / std::sqrt(2.0);
  std::array<double, 10> lowest{}, first{}, last{};
  along_cuts(made->path, [&](Point3 p) {
    EXPECT_LT(std::abs(p.x), contact + 2.0);  // by twice the radius of the small ball
    const auto line = static_cast<std::size_t>(std::clamp(std::floor(p.y + 5.0), 0.0, 9.0));
    lowest[line] = std::min(lowest[line], p.z);
    first[line] = std::min(first[line], p.x), last[line] = std::max(last[line], p.x);
  });
  for (std::size_t line = 0; line < 10; ++line) {
    EXPECT_NEAR(lowest[line], -4.0 + (std::sqrt(2.0) - 1.0), 0.011);
    EXPECT_LT(first[line], -(thick - 1.0 / std::sqrt(2.0)));
    EXPECT_GT(last[line], thick - 1.0 / std::sqrt(2.0));
  }
  // The same ball again finds nothing.
  options.earlier = small;
  EXPECT_FALSE(raster(mesh, area, small, options, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_empty);
  options.earlier = tool_of(shape::Roundover{mm(2), mm(3), mm(10)});
  EXPECT_FALSE(raster(mesh, area, small, options, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
  options.earlier = large, options.rest_thickness = mm(-1);
  EXPECT_FALSE(raster(mesh, area, small, options, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
}

TEST(Surface, RestMachiningByWaterlinesCutsCornersAlone) {
  SurfaceMesh mesh;  // the floor and the walls of a pocket of 20 x 20 mm
  add_box(mesh, {-5, -5, -5}, {25, 25, -4});
  add_box(mesh, {-5, -5, -4}, {0, 25, 0}), add_box(mesh, {20, -5, -4}, {25, 25, 0});
  add_box(mesh, {0, -5, -4}, {20, 0, 0}), add_box(mesh, {0, 20, -4}, {20, 25, 0});
  MeshCutOptions options;
  options.cut.feed = mm_per_min(900), options.cut.stepdown = mm(2), options.cut.depth = mm(4);
  options.earlier = tool_of(shape::Square{mm(8), mm(20)});
  Diagnostics diagnostics;
  const auto made = waterline(mesh, tool_of(shape::Square{mm(2), mm(20)}), options, diagnostics);
  ASSERT_TRUE(made);
  std::array<bool, 4> corners{};
  along_cuts(made->path, [&](Point3 p) {
    if (p.x < -1 || p.x > 21 || p.y < -1 || p.y > 21) return;  // around the whole
    // A radius of the large tool from the corner, and one of the small one further.
    const bool right = p.x > 10, back = p.y > 10;
    const Point2 corner{right ? 20.0 : 0.0, back ? 20.0 : 0.0};
    EXPECT_LT(std::abs(p.x - corner.x), 4.0 + 2.0);
    EXPECT_LT(std::abs(p.y - corner.y), 4.0 + 2.0);
    if (distance(p.xy(), corner) < 1.5 && p.z == -4.0) corners[(right ? 1u : 0u) + (back ? 2u : 0u)] = true;
  });
  for (const bool cut : corners) EXPECT_TRUE(cut);
}

TEST(Surface, AnEngravingFollowsTheMesh) {
  SurfaceMesh mesh;
  add(mesh, {0, 0, -10}, {40, 0, 0}, {40, 40, 0});
  add(mesh, {0, 0, -10}, {40, 40, 0}, {0, 40, -10});
  const Tool tool = tool_of(shape::Vee{mm(6), mm(20), degrees(60), {}, {}});
  MeshCutOptions options;
  options.cut.feed = mm_per_min(600), options.cut.depth = mm(0.4);
  Diagnostics diagnostics;
  const Outline line{{5, 5}, {{{30, 20}, {}}}};
  const auto made = project(mesh, {line}, tool, options, diagnostics);
  ASSERT_TRUE(made);
  std::vector<Point3> cuts;
  for (const Step& step : made->path.steps())
    if (step.kind() == StepKind::cut) cuts.push_back(step.to());
  ASSERT_EQ(cuts.size(), 2u);  // down, and along the slope
  EXPECT_NEAR(cuts[0].z, -10 + 5 * 0.25 - 0.4, 1e-6);
  EXPECT_NEAR(cuts[1].z, -10 + 30 * 0.25 - 0.4, 0.0101);
  EXPECT_FALSE(project(mesh, {Outline{{5, 5}, {{{50, 20}, {}}}}}, tool, options, diagnostics));
  EXPECT_EQ(diagnostics.list().back().code, codes::op_option);
}

}  // namespace
}  // namespace kerf
