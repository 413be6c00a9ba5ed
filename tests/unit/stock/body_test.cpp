// Bodies: columns of meshes with known volume, lines through vertices and edges, faults, moves, distances.
#include "stock/body.h"

#include <gtest/gtest.h>
#include <random>

#include "base/codes/stock.h"
#include "solids.h"

#include "kerf/stock/stock.h"

namespace kerf::test {
namespace {

std::shared_ptr<const StockBody> body_of(const Triangles& mesh, Diagnostics& diagnostics) {
  return make_mesh_body(mesh.positions, mesh.triangles, "body.stl", diagnostics);
}
std::shared_ptr<const StockBody> valid_body(const Triangles& mesh) {
  Diagnostics diagnostics;
  auto body = body_of(mesh, diagnostics);
  EXPECT_TRUE(body && diagnostics.list().empty());
  return body;
}

/// Columns that cover a body, the first one `offset` pitches from its low corner.
ColumnPositions positions_over(const StockBody& body, double pitch, double offset = 0.5) {
  const Box3& b = body.bounds();
  return {b.low.x + offset * pitch,
          b.low.y + offset * pitch,
          b.low.z,
          pitch,
          static_cast<int>(std::ceil(b.size().x / pitch)) + 1,
          static_cast<int>(std::ceil(b.size().y / pitch)) + 1};
}

double volume_of(const ColumnRuns& columns, double pitch) {
  double sum = 0.0;
  for (const Run& run : columns.runs) sum += static_cast<double>(run.high - run.low);
  return sum * pitch * pitch;
}

ColumnRuns valid_columns(const StockBody& body, const ColumnPositions& positions) {
  Diagnostics diagnostics;
  auto columns = body.columns(positions, diagnostics);
  EXPECT_TRUE(columns);
  for (const Diagnostic& d : diagnostics.list()) ADD_FAILURE() << to_string(d);
  return columns ? *columns : ColumnRuns{};
}

TEST(StockBody, LinesAtAnyPointsAreThoseOfAGrid) {
  Triangles mesh = sphere_mesh({3, -2, 1}, 6, 40);
  mesh.add(box_mesh({-2, -7, 9}, {8, 3, 11}));
  const auto body = valid_body(mesh);
  const ColumnPositions grid = positions_over(*body, 0.25, 0.0);  // also on edges of the box
  const ColumnRuns expected = valid_columns(*body, grid);
  std::vector<Point2> points;
  std::vector<std::pair<int, int>> numbers;
  for (int i = 0; i < grid.nx; ++i)
    for (int j = grid.ny; j-- > 0;) {
      points.push_back({grid.x_of(i), grid.y_of(j)});
      numbers.emplace_back(i, j);
    }
  Diagnostics diagnostics;
  const auto& inside = std::get<solid::MeshSolid>(body->inside().what);
  const auto found = solid::mesh_runs(inside, points, grid.z, diagnostics, nullptr);
  ASSERT_TRUE(found && diagnostics.list().empty());
  for (std::size_t n = 0; n < points.size(); ++n) {
    const auto [i, j] = numbers[n];
    const auto a = found->column(static_cast<int>(n), 0), b = expected.column(i, j);
    ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << i << " " << j;
  }
  EXPECT_TRUE(solid::mesh_runs(inside, {}, grid.z, diagnostics, nullptr)->runs.empty());
}

TEST(StockBody, VolumesOfKnownSolids) {
  const auto box = valid_body(box_mesh({1, 2, 3}, {11, 7, 5}));
  EXPECT_NEAR(box->volume().mm3(), 100.0, 1e-6);
  EXPECT_NEAR(volume_of(valid_columns(*box, positions_over(*box, 0.1)), 0.1), 100.0, 1e-4);
  const int sides = 200;
  const auto bar = valid_body(prism_mesh({0, 0, -4}, 5, 8, sides));
  const double exact = sides / 2.0 * 25.0 * std::sin(2.0 * std::numbers::pi / sides) * 8.0;
  EXPECT_NEAR(bar->volume().mm3(), exact, 1e-3);
  EXPECT_NEAR(volume_of(valid_columns(*bar, positions_over(*bar, 0.02)), 0.02), exact, 5e-4 * exact);
  const auto ball = valid_body(sphere_mesh({3, -2, 1}, 6, 100));
  EXPECT_NEAR(ball->volume().mm3(), 4.0 / 3.0 * std::numbers::pi * 216.0, 1.0);
  EXPECT_NEAR(volume_of(valid_columns(*ball, positions_over(*ball, 0.03)), 0.03), ball->volume().mm3(), 0.02);
}

TEST(StockBody, HeightsOfASphereAreExact) {
  const auto ball = valid_body(sphere_mesh({0, 0, 0}, 10, 400));
  const ColumnPositions positions{-5, -5, 0, 0.37, 27, 27};
  const ColumnRuns columns = valid_columns(*ball, positions);
  for (int j = 0; j < 27; ++j) {
    for (int i = 0; i < 27; ++i) {
      const double x = -5 + 0.37 * i, y = -5 + 0.37 * j, z = std::sqrt(100.0 - x * x - y * y);
      ASSERT_EQ(columns.column(i, j).size(), 1u);
      EXPECT_NEAR(static_cast<double>(columns.column(i, j)[0].high), z, 5e-4);
      EXPECT_NEAR(static_cast<double>(columns.column(i, j)[0].low), -z, 5e-4);
    }
  }
}

TEST(StockBody, LinesThroughCornersAndEdgesAreCountedOnce) {
  // Every line passes through vertices and edges of the triangles.
  Triangles steps;
  for (int k = 0; k < 3; ++k)
    for (int n = 0; n < 3; ++n)
      steps.add(box_mesh({4.0 * k, 4.0 * n, 0}, {4.0 * k + 2, 4.0 * n + 2, 1.0 + k + n}));
  const auto body = valid_body(steps);
  const ColumnRuns columns = valid_columns(*body, {-1, -1, 0, 0.5, 26, 26});
  EXPECT_NEAR(volume_of(columns, 0.5), body->volume().mm3(), 1e-4);
  const auto fan = valid_body(prism_mesh({0, 0, 0}, 8, 3, 16));
  for (const auto& run : valid_columns(*fan, {-8, -8, 0, 1, 17, 17}).runs) EXPECT_EQ(run, (kerf::Run{0, 3}));
}

TEST(StockBody, LinesLeaveRandomClosedMeshesAsOftenAsTheyEnter) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    // Small integers, so that vertices, edges and lines coincide often.
    Triangles mesh;
    const auto coordinate = [&] { return static_cast<double>(random() % 6); };
    for (int k = 0; k < 5; ++k) mesh.point({coordinate(), coordinate(), coordinate()});
    Triangles one;
    one.positions = mesh.positions;
    one.triangles = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 4, 3, 2, 4, 2, 1};
    Diagnostics diagnostics;
    const auto body = body_of(one, diagnostics);
    if (!body) continue;
    for (const double offset : {0.0, 0.5}) {
      const auto columns = body->columns({offset, offset, 0, 0.5, 12, 12}, diagnostics);
      EXPECT_TRUE(columns) << round;
    }
    for (const Diagnostic& d : diagnostics.list()) EXPECT_NE(d.code, codes::mesh_open) << to_string(d);
  }
}

TEST(StockBody, CavitiesAndUndercuts) {
  Triangles shell = box_mesh({0, 0, 0}, {10, 10, 10});
  shell.add(box_mesh({2, 2, 3}, {8, 8, 7}), true);
  const auto body = valid_body(shell);
  EXPECT_NEAR(body->volume().mm3(), 1000.0 - 144.0, 1e-6);
  const ColumnRuns columns = valid_columns(*body, {5, 5, 0, 1, 1, 1});
  ASSERT_EQ(columns.runs.size(), 2u);
  EXPECT_EQ(columns.runs[0], (kerf::Run{0, 3}));
  EXPECT_EQ(columns.runs[1], (kerf::Run{7, 10}));
}

TEST(StockBody, FaultsAreReported) {
  Diagnostics open;
  Triangles lidless = box_mesh({0, 0, 0}, {10, 10, 10});
  lidless.triangles.resize(lidless.triangles.size() -
                           6);  // without one side; no line passes through the hole
  auto body = body_of(lidless, open);
  ASSERT_TRUE(body);
  ASSERT_EQ(open.list().size(), 1u);
  EXPECT_EQ(open.list()[0].code, codes::mesh_open);
  EXPECT_TRUE(body->columns(positions_over(*body, 1), open));
  lidless.triangles.erase(lidless.triangles.begin() + 6, lidless.triangles.begin() + 9);  // and half the top
  body = body_of(lidless, open);
  EXPECT_FALSE(body->columns(positions_over(*body, 1), open));
  EXPECT_TRUE(open.has_errors());

  Diagnostics inwards;
  Triangles turned;
  turned.add(box_mesh({0, 0, 0}, {10, 10, 10}), true);
  body = body_of(turned, inwards);
  ASSERT_EQ(inwards.list().size(), 1u);
  EXPECT_EQ(inwards.list()[0].code, codes::mesh_turned);
  EXPECT_NEAR(body->volume().mm3(), 1000.0, 1e-6);

  Diagnostics mixed;
  Triangles some = box_mesh({0, 0, 0}, {10, 10, 10});
  std::swap(some.triangles[6], some.triangles[7]);  // one triangle of the top
  body = body_of(some, mixed);
  EXPECT_EQ(mixed.list()[0].code, codes::mesh_turned);
  EXPECT_NEAR(volume_of(*body->columns(positions_over(*body, 1), mixed), 1), 1000.0, 1e-3);

  Diagnostics nothing;
  EXPECT_FALSE(body_of({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2, 0, 2, 1}}, nothing));
  EXPECT_EQ(nothing.list().back().code, codes::mesh_no_volume);
}

TEST(StockBody, OverlappingBodiesAreUnitedAndReported) {
  Triangles two = box_mesh({0, 0, 0}, {10, 10, 10});
  two.add(box_mesh({5, 5, 5}, {15, 15, 15}));
  Diagnostics diagnostics;
  const auto body = body_of(two, diagnostics);
  ASSERT_TRUE(body && diagnostics.list().empty());
  const auto columns = body->columns({0.5, 0.5, 0, 1, 15, 15}, diagnostics);
  ASSERT_TRUE(columns);
  EXPECT_NEAR(volume_of(*columns, 1), 2000.0 - 125.0, 1e-2);
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_EQ(diagnostics.list()[0].code, codes::mesh_crossing);
}

TEST(StockBody, FlippedMeshAndFlippedColumnsAgree) {
  Triangles part = box_mesh({0, 0, -10}, {40, 20, -4});
  part.add(box_mesh({5, 2, -4}, {15, 8, 0}));
  Diagnostics diagnostics;
  const auto mesh = body_of(part, diagnostics);
  const ColumnPositions positions{0.25, 0.25, -10, 0.5, 80, 40};
  LeftColumns left{mesh->bounds(), positions, *mesh->columns(positions, diagnostics)};
  const auto columns = make_columns_body(std::move(left));
  EXPECT_NEAR(columns->volume().mm3(), mesh->volume().mm3(), 1e-2);
  for (const auto flip : {StockMove::Flip::none, StockMove::Flip::about_x, StockMove::Flip::about_y}) {
    const StockMove move{flip, std::nullopt, -3.0, {1, 2, 3}};
    const Stock a = moved(stock_of(mesh), move), b = moved(stock_of(columns), move);
    EXPECT_EQ(a.block, b.block);
    const Point3 low = a.block.low;
    const ColumnPositions there{low.x + 0.25, low.y + 0.25, low.z, 0.5, 80, 40};
    EXPECT_EQ(a.body->columns(there, diagnostics)->runs, b.body->columns(there, diagnostics)->runs);
  }
  const Stock turned = moved(stock_of(mesh), {StockMove::Flip::about_x, 10.0, -5.0, {}});
  const auto line =
      turned.body->columns({10, 15, -10, 1, 1, 1}, diagnostics);  // above the boss, which now points down
  ASSERT_EQ(line->runs.size(), 1u);
  EXPECT_EQ(line->runs[0], (kerf::Run{0, 10}));
  EXPECT_EQ(turned.body->columns({30, 15, -10, 1, 1, 1}, diagnostics)->runs[0], (kerf::Run{4, 10}));
  EXPECT_EQ(moved(Stock{{{0, 0, -5}, {10, 4, 0}}}, {StockMove::Flip::about_y, 0.0, 0.0, {}}).block,
            (Box3{{-10, 0, 0}, {0, 4, 5}}));
}

TEST(SurfaceDistance, IsExact) {
  const auto box = valid_body(box_mesh({0, 0, 0}, {10, 10, 10}));
  const SurfaceDistance to_box(*box);
  EXPECT_NEAR(to_box.at({5, 5, 12}, 100), 2.0, 1e-9);
  EXPECT_NEAR(to_box.at({5, 4, 3}, 100), 3.0, 1e-9);
  EXPECT_NEAR(to_box.at({13, 14, 5}, 100), 5.0, 1e-9);
  EXPECT_NEAR(to_box.at({11, 12, 12}, 100), 3.0, 1e-9);
  EXPECT_NEAR(to_box.at({5, 5, 50}, 1), 1.0, 1e-9);  // not beyond the limit
  const auto ball = valid_body(sphere_mesh({0, 0, 0}, 10, 200));
  const SurfaceDistance to_ball(*ball);
  std::mt19937 random(3);
  for (int k = 0; k < 200; ++k) {
    const Point3 p{static_cast<double>(random() % 300) / 10 - 15,
                   static_cast<double>(random() % 300) / 10 - 15,
                   static_cast<double>(random() % 300) / 10 - 15};
    EXPECT_NEAR(to_ball.at(p, 100), std::abs(length(p) - 10.0), 2e-3);
  }
}

}  // namespace
}  // namespace kerf::test
