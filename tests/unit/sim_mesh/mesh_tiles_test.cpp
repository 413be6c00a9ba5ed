// Meshes in tiles against the mesh of the whole workpiece: each triangle exactly once, wherever a tile is
// meshed from.
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
#include <random>

#include "sim/dexel/initial_columns.h"
#include "sim/dexel/tile.h"

#include "kerf/sim/mesh.h"
#include "kerf/stock/stock.h"

namespace kerf {
namespace {

/// Where a random part has material, by the number of the column.
struct Part {
  int nx, ny;
  double pitch;
  unsigned seed;
  double end_x = 0.0;  // mm that the last column is narrower
};

/// Hills, steps, holes and undercuts.
LeftColumns columns_of(const Part& part) {
  std::mt19937 random(part.seed);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  struct Feature {
    double x, y, r, depth;
    int kind;  // 0: pocket, 1: bowl, 2: hole, 3: undercut
  };
  std::vector<Feature> features;
  for (int k = 0; k < 40; ++k)
    features.push_back({part.nx * number(random), part.ny * number(random), 2.0 + 20.0 * number(random),
                        0.5 + 8.0 * number(random), k % 4});
  LeftColumns out;
  out.bounds = {{-3, 7, -10}, {-3 + part.nx * part.pitch - part.end_x, 7 + part.ny * part.pitch, 0}};
  out.positions = {out.bounds.low.x + 0.5 * part.pitch,
                   out.bounds.low.y + 0.5 * part.pitch,
                   -10,
                   part.pitch,
                   part.nx,
                   part.ny};
  if (part.end_x > 0.0) out.positions.end_x = out.bounds.high.x;
  out.columns.nx = part.nx;
  out.columns.ny = part.ny;
  out.columns.first.push_back(0);
  for (int j = 0; j < part.ny; ++j) {
    for (int i = 0; i < part.nx; ++i) {
      double top = 10.0;
      bool through = false, undercut = false;
      for (const Feature& s : features) {
        const double d = std::hypot(i - s.x, j - s.y);
        if (d > s.r) continue;
        if (s.kind == 0) top = std::min(top, 10.0 - s.depth);
        if (s.kind == 1) top = std::min(top, 10.0 - s.depth * (1.0 - d * d / (s.r * s.r)));
        if (s.kind == 2) through = through || d < 0.3 * s.r;
        if (s.kind == 3) undercut = true;
      }
      if (!through) {
        if (undercut && top > 5.0) {
          out.columns.runs.push_back({0.0f, 2.0f});
          out.columns.runs.push_back({4.0f, static_cast<float>(top)});
        } else {
          out.columns.runs.push_back({0.0f, static_cast<float>(top)});
        }
      }
      out.columns.first.push_back(static_cast<std::uint32_t>(out.columns.runs.size()));
    }
  }
  return out;
}

Workpiece workpiece_of(const LeftColumns& columns) {
  const Stock stock = stock_of(make_columns_body(columns));
  Workpiece workpiece(stock, mm(columns.positions.pitch));
  Diagnostics diagnostics;
  EXPECT_TRUE(sim::fill_from_body(workpiece.body(), *stock.body, diagnostics, nullptr));
  return workpiece;
}

/// With steps in patches of 5 x 7 columns, as if cut.
Workpiece workpiece_of(const Part& part) {
  Workpiece workpiece = workpiece_of(columns_of(part));
  Workpiece::Body& body = workpiece.body();
  for (int j = 0; j < part.ny; ++j) {
    for (int i = 0; i < part.nx; ++i) {
      const int tile = j / sim::kTileColumns * body.tiles_x + i / sim::kTileColumns;
      const int lane = sim::lane_index(i % sim::kTileColumns, j % sim::kTileColumns);
      body.touch(static_cast<std::size_t>(tile)).top_step[lane / sim::kLanes][lane % sim::kLanes] =
          static_cast<std::uint32_t>(j / 7 * 1000 + i / 5);
    }
  }
  return workpiece;
}

/// Triangles as their corners, lowest first, in tenths of a micron, and their step.
using Key = std::array<long, 10>;
void add_keys(const Mesh& mesh, std::map<Key, int>& keys) {
  for (std::size_t t = 0; t < mesh.step.size(); ++t) {
    std::array<std::array<long, 3>, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        corner[k][axis] = std::lround(
            1e4 * static_cast<double>(mesh.positions[std::size_t{3} * mesh.triangles[3 * t + k] + axis]));
    std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
    Key key{};
    for (std::size_t k = 0; k < 9; ++k) key[k] = corner[k / 3][k % 3];
    key[9] = mesh.step[t];
    ++keys[key];
  }
}

std::vector<std::uint32_t> all_numbers(const MeshTiling& tiling) {
  std::vector<std::uint32_t> numbers(tiling.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

class MeshTiles : public testing::TestWithParam<Part> {};

TEST_P(MeshTiles, EachAloneIsItsPartOfTheWholeMesh) {
  const Workpiece workpiece = workpiece_of(GetParam());
  for (const Length tolerance : {mm(0), mm(0.05)}) {
    const MeshOptions options{.tolerance = tolerance, .threads = 1};
    std::map<Key, int> whole, tiles;
    add_keys(extract_mesh(MeshColumns(workpiece), options), whole);
    const MeshTiling tiling = mesh_tiling(workpiece, 1000);
    ASSERT_GT(tiling.size(), 1u);
    for (const std::uint32_t number : all_numbers(tiling)) {
      const auto made = extract_mesh_tiles(workpiece, tiling, {&number, 1}, options);
      ASSERT_EQ(made.size(), 1u);
      EXPECT_EQ(made[0].number, number);
      add_keys(made[0].mesh, tiles);
    }
    EXPECT_GT(whole.size(), 1000u);
    EXPECT_TRUE(whole == tiles) << whole.size() << " triangles, in tiles " << tiles.size();
  }
}

TEST_P(MeshTiles, SeveralAtOnceAreTheSameTiles) {
  const Workpiece workpiece = workpiece_of(GetParam());
  const MeshTiling tiling = mesh_tiling(workpiece, 1000);
  std::vector<std::uint32_t> some;
  for (const std::uint32_t number : all_numbers(tiling))
    if (number % 3 != 1) some.push_back(number);
  const MeshOptions options{.tolerance = mm(0.01), .threads = 1};
  const auto made = extract_mesh_tiles(workpiece, tiling, some, options);
  ASSERT_EQ(made.size(), some.size());
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(made[k].number, some[k]);
    std::map<Key, int> together, alone;
    add_keys(made[k].mesh, together);
    add_keys(extract_mesh_tiles(workpiece, tiling, {&some[k], 1}, options)[0].mesh, alone);
    EXPECT_TRUE(together == alone) << "tile " << some[k];
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, MeshTiles,
                         testing::Values(Part{200, 150, 0.5, 1}, Part{129, 64, 0.37, 2},
                                         Part{65, 193, 1.0, 3, 0.4}, Part{256, 256, 0.1, 4}));

TEST(MeshTiling, AreFewerOfMoreColumnsWhereTheirNumberIsLimited) {
  const Workpiece workpiece = workpiece_of(Part{200, 150, 0.5, 1});
  EXPECT_EQ(mesh_tiling(workpiece, 1000), (MeshTiling{64, 4, 3}));
  EXPECT_EQ(mesh_tiling(workpiece, 4), (MeshTiling{128, 2, 2}));
  EXPECT_EQ(mesh_tiling(workpiece, 0), (MeshTiling{256, 1, 1}));
}

TEST(MeshTiling, OfNoMaterialAreEmpty) {
  LeftColumns columns;
  columns.bounds = {{0, 0, -1}, {100, 10, 0}};
  columns.positions = {0.5, 0.5, -1, 1.0, 100, 10};
  columns.columns.nx = 100;
  columns.columns.ny = 10;
  columns.columns.first.assign(1001, 0);
  // One column at the far end, so that the stock has material.
  columns.columns.runs.push_back({0.0f, 1.0f});
  columns.columns.first.back() = 1;
  const Workpiece workpiece = workpiece_of(columns);
  const MeshTiling tiling = mesh_tiling(workpiece, 1000);
  ASSERT_EQ(tiling.size(), 2u);
  const auto tiles = extract_mesh_tiles(workpiece, tiling, all_numbers(tiling), {});
  EXPECT_TRUE(tiles[0].mesh.triangles.empty());
  EXPECT_EQ(tiles[1].mesh.step.size(), 12u);
}

}  // namespace
}  // namespace kerf
