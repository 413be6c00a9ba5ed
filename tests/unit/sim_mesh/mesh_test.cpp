// The columns' surface: closed for every configuration, right in volume and position, with the steps that
// made it.
#include "kerf/sim/mesh.h"

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>

#include "base/codes/sim.h"

namespace kerf {
namespace {

using Column = std::vector<Interval>;

ColumnGrid make_grid(int nx, int ny, double pitch, double height,
                     const std::function<Column(double, double)>& at) {
  ColumnGrid grid;
  grid.bounds = {{10, 20, -height}, {10 + nx * pitch, 20 + ny * pitch, 0}};
  grid.pitch = pitch;
  grid.nx = nx;
  grid.ny = ny;
  grid.first.push_back(0);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      for (const Interval& run : at((i + 0.5) * pitch, (j + 0.5) * pitch)) grid.intervals.push_back(run);
      grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
    }
  }
  return grid;
}

double column_volume(const ColumnGrid& grid) {
  double sum = 0;
  for (const Interval& run : grid.intervals) sum += run.high - run.low;
  return sum * grid.pitch * grid.pitch;
}

/// The same numbers each time, or those of KERF_SEED. With 3835807145 one mesh keeps two triangles without
/// area: merging their corners would leave an edge with four triangles.
unsigned chosen_seed() {
  const char* given = std::getenv("KERF_SEED");
  return given != nullptr ? static_cast<unsigned>(std::strtoul(given, nullptr, 10)) : 1u;
}

Box3 bounds_of(const Mesh& mesh) {
  Box3 box;
  for (std::size_t k = 0; k < mesh.positions.size(); k += 3)
    box.add(Point3{mesh.positions[k], mesh.positions[k + 1], mesh.positions[k + 2]});
  return box;
}

/// Each vertex is used, and its triangles form one fan: the mesh is a 2-manifold.
bool one_fan_per_vertex(const Mesh& mesh) {
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(mesh.positions.size() / 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k)
      next[mesh.triangles[t + k]][mesh.triangles[t + (k + 1) % 3]] = mesh.triangles[t + (k + 2) % 3];
  for (const auto& link : next) {
    if (link.empty()) {
      std::puts("unused");
      return false;
    }
    std::size_t count = 0;
    std::uint32_t v = link.begin()->first;
    do {
      const auto found = link.find(v);
      if (found == link.end()) return false;
      v = found->second;
      ++count;
    } while (v != link.begin()->first && count <= link.size());
    if (count != link.size()) return false;
  }
  return true;
}

/// The number of triangles without area in single precision.
std::size_t degenerate_triangles(const Mesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) {
      const float* p = mesh.positions.data() + std::size_t{3} * mesh.triangles[t + k];
      return Point3{p[0], p[1], p[2]};
    };
    const Point3 u = at(1) - at(0), v = at(2) - at(0);
    const Point3 cross{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    if (length(cross) == 0.0) ++count;
  }
  return count;
}

void expect_valid(const ColumnGrid& grid, const Mesh& mesh) {
  EXPECT_EQ(mesh.triangles.size(), 3 * mesh.step.size());
  const MeshCheck check = check_mesh(mesh);
  const VolumeRange range = mesh_volume(grid, {.tolerance = mm(0.01)});
  EXPECT_EQ(check.bad_edges, 0u);
  EXPECT_NEAR(check.volume.mm3(), range.expected.mm3(), range.tolerance.mm3());
  EXPECT_TRUE(one_fan_per_vertex(mesh));
  const Box3 box = bounds_of(mesh);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(box.low[axis], grid.bounds.low[axis] - 1e-5);
    EXPECT_LE(box.high[axis], grid.bounds.high[axis] + 1e-5);
  }
}

TEST(Mesh, NoMaterialIsAnEmptyMesh) {
  const ColumnGrid grid = make_grid(3, 2, 1, 5, [](double, double) { return Column{}; });
  EXPECT_TRUE(extract_mesh(grid).triangles.empty());
  EXPECT_TRUE(extract_mesh(ColumnGrid{}).triangles.empty());
}

TEST(Mesh, OneColumnIsABox) {
  const ColumnGrid grid = make_grid(1, 1, 2, 5, [](double, double) {
    return Column{{0, 5, kStockSurface, 7}};
  });
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  EXPECT_EQ(mesh.step.size(), 12u);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), 20.0, 1e-4);
  EXPECT_EQ(std::count(mesh.step.begin(), mesh.step.end(), 7u), 2);
}

TEST(Mesh, UncutBlockIsExactAndMerged) {
  ColumnGrid grid = make_grid(300, 200, 0.1, 8, [](double, double) { return Column{{0, 8}}; });
  grid.bounds.high.x -= 0.03;  // the pitch does not divide the block
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), 29.97 * 20 * 8, 0.01);
  EXPECT_EQ(bounds_of(mesh).low, (Point3{10, 20, -8}));
  EXPECT_NEAR(bounds_of(mesh).high.x, grid.bounds.high.x, 1e-5);
  // Two triangles for each side of the 5 x 4 squares of 64 columns, above and below, and at the four sides.
  EXPECT_EQ(mesh.step.size(), 2u * (2u * 5u * 4u + 2u * (5u + 4u)));
  for (const std::uint32_t step : mesh.step) EXPECT_EQ(step, kStockSurface);
}

TEST(Mesh, PocketHasLevelFloorExactVolumeAndWallsOfTheCut) {
  const ColumnGrid grid = make_grid(100, 80, 0.1, 6, [](double x, double y) {
    const bool in = x > 2 && x < 7 && y > 3 && y < 6;
    return Column{{0, in ? 2.0f : 6.0f, kStockSurface, in ? 5u : kStockSurface}};
  });
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), column_volume(grid), 0.2 * 0.1 * 16 * 4);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), column_volume(grid), 4 * 0.1 * 0.1 * 4);
  double floor = 0, walls = 0;
  for (std::size_t t = 0; t < mesh.step.size(); ++t) {
    if (mesh.step[t] != 5) continue;
    std::array<Point3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const float* v = mesh.positions.data() + 3 * mesh.triangles[3 * t + k];
      p[k] = {v[0], v[1], v[2]};
    }
    const Point3 n = cross(p[1] - p[0], p[2] - p[0]);
    if (n.z != 0.0) {
      floor += n.z / 2;
      for (const Point3& q : p) EXPECT_NEAR(q.z, -4.0, 1e-6);
    } else {
      walls += length(n) / 2;
    }
  }
  EXPECT_NEAR(floor, 15.0, 0.02);
  EXPECT_NEAR(walls, 16 * 4.0, 1.0);
}

TEST(Mesh, SlopesAreSmooth) {
  // A roof with slopes of 1:1 and 3:1, up to the block's sides: each vertex of a cut face is on the surface.
  const auto surface = [](double x, double y) { return std::min(1.0 + x, 30.0 - 3 * x) + 0.2 * y; };
  const ColumnGrid grid = make_grid(90, 60, 0.1, 12, [&](double x, double y) {
    return Column{{0, static_cast<float>(surface(x, y)), kStockSurface, 1}};
  });
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  double worst = 0;
  for (std::size_t t = 0; t < mesh.step.size(); ++t) {
    if (mesh.step[t] != 1) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const float* v = mesh.positions.data() + 3 * mesh.triangles[3 * t + k];
      worst = std::max(worst, std::abs(v[2] + 12 - surface(v[0] - 10.0, v[1] - 20.0)));
    }
  }
  EXPECT_LT(worst, 0.11);  // at the ridge; a stair-cased face would be off by 0.15 everywhere
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), column_volume(grid), 0.2 * 0.1 * 30 * 1);
}

TEST(Mesh, BallGrooveIsRoundToColumnAccuracy) {
  const double r = 1.5;
  const ColumnGrid grid = make_grid(80, 60, 0.05, 5, [&](double x, double) {
    const double d = std::abs(x - 2.0);
    const double z = d < r ? 4.0 - std::sqrt(r * r - d * d) : 5.0;
    return Column{{0, static_cast<float>(std::min(z, 5.0)), kStockSurface, d < r ? 3u : kStockSurface}};
  });
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), column_volume(grid), 0.2 * 0.05 * 6 * 2.5);
  double worst = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); v += 3) {
    const double x = mesh.positions[v] - 12.0, z = mesh.positions[v + 2] + 5.0;
    if (z > 4.5 || z < 2 || std::abs(x) > 1.2) continue;
    worst = std::max(worst, std::abs(std::hypot(x, 4.0 - z) - r));
  }
  EXPECT_LT(worst, 0.002);
}

TEST(Mesh, KeyholeUndercutHasItsVolume) {
  // A slot 2 wide above a chamber 5 wide.
  const ColumnGrid grid = make_grid(80, 50, 0.1, 6, [](double x, double) {
    const double d = std::abs(x - 4.0);
    if (d < 1.0) return Column{{0, 1, kStockSurface, 2}};
    if (d < 2.5) return Column{{0, 1, kStockSurface, 2}, {3, 6, 2, kStockSurface}};
    return Column{{0, 6}};
  });
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), (8 * 6 - 2 * 3 - 5 * 2) * 5.0, 0.01);
}

TEST(Mesh, ThroughCutWallsHaveTheirStep) {
  ColumnGrid grid = make_grid(30, 30, 0.2, 2, [](double x, double y) {
    return std::hypot(x - 3, y - 3) < 1.5 ? Column{} : Column{{0, 2}};
  });
  grid.cut_through.assign(900, 11);
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  EXPECT_GT(std::count(mesh.step.begin(), mesh.step.end(), 11u), 20);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), column_volume(grid), 0.2 * 0.2 * 9.4 * 2);
  grid.cut_through.clear();
  for (const std::uint32_t step : extract_mesh(grid).step) EXPECT_EQ(step, kStockSurface);
}

TEST(Mesh, DiagonalContactIsSplit) {
  // Two columns that touch along a line only, free, on a common floor, under a common lid, and both.
  for (const int kind : {0, 1, 2, 3}) {
    const ColumnGrid grid = make_grid(2, 2, 1, 6, [&](double x, double y) {
      const float low = kind == 1 || kind == 3 ? 2.0f : 0.0f, high = kind >= 2 ? 4.0f : 6.0f;
      Column column;
      const bool pillar = (x < 1) == (y < 1);
      if (pillar) return Column{{0, 6}};
      if (low > 0) column.push_back({0, low});
      if (high < 6) column.push_back({high, 6});
      return column;
    });
    const Mesh mesh = extract_mesh(grid);
    SCOPED_TRACE(kind);
    expect_valid(grid, mesh);
    EXPECT_NEAR(check_mesh(mesh).volume.mm3(), column_volume(grid), 1e-4);
  }
}

TEST(Mesh, AnyColumnsGiveAClosedMesh) {
  const unsigned seed = chosen_seed();
  std::mt19937 random(seed);
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 1500; ++round) {
    const int nx = 1 + pick(9), ny = 1 + pick(9), levels = 2 + pick(9), max_ends = 1 + pick(4);
    const double pitch = std::array{0.05, 0.3, 1.0, 4.0}[static_cast<std::size_t>(pick(4))];
    const ColumnGrid grid = make_grid(nx, ny, pitch, levels, [&](double, double) {
      std::set<int> ends;
      for (int n = 2 * pick(max_ends + 1); n > 0; --n) ends.insert(pick(levels + 1));
      if (ends.size() % 2 == 1) ends.erase(ends.begin());
      Column column;
      for (auto it = ends.begin(); it != ends.end(); std::advance(it, 2)) {
        const auto low = static_cast<float>(*it), high = static_cast<float>(*std::next(it));
        column.push_back(
            {low, high, static_cast<std::uint32_t>(pick(3)), static_cast<std::uint32_t>(pick(3))});
      }
      return column;
    });
    SCOPED_TRACE(testing::Message() << "seed " << seed << " round " << round);
    const Mesh mesh = extract_mesh(grid);
    if (grid.intervals.empty()) continue;
    expect_valid(grid, mesh);
    if (HasFailure()) return;
  }
}

/// A slot in the corner of a small board, and of a large one.
TEST(Mesh, UncutSidesCostNoTriangles) {
  const auto triangles = [](int nx, int ny) {
    ColumnGrid grid = make_grid(nx, ny, 0.2, 5, [&](double x, double y) {
      const bool in = x > 4 && x < 12 && std::abs(y - 7) < 1;
      return Column{{0, in ? 3.0f : 5.0f, kStockSurface, in ? 1u : kStockSurface}};
    });
    grid.bounds.high.x -= 0.07;
    grid.bounds.high.y -= 0.11;
    const Mesh mesh = extract_mesh(grid);
    expect_valid(grid, mesh);
    return mesh.step.size();
  };
  const std::size_t small = triangles(100, 70), large = triangles(700, 370);
  // 11 x 6 squares for 2 x 2, and nothing for 900 more columns along the sides.
  EXPECT_LT(large, small + 2u * (2u * 66u + 2u * 17u));
}

/// Boxes cut out of blocks over several squares of columns: through, into the sides, as undercuts.
TEST(Mesh, AnyBoxesCutFromABlockLeaveAClosedMesh) {
  std::mt19937 random(chosen_seed());
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 200; ++round) {
    const int nx = 1 + pick(150), ny = 1 + pick(150);
    struct Box {
      int x, y, wide, deep, low, high;
    };
    std::vector<Box> boxes;
    for (int n = pick(5); n > 0; --n) {
      const int low = pick(6);
      boxes.push_back(
          {pick(nx + 4) - 4, pick(ny + 4) - 4, 1 + pick(40), 1 + pick(40), low, low + 1 + pick(6)});
    }
    const bool slopes = pick(3) == 0;
    ColumnGrid grid = make_grid(nx, ny, 0.5, 6, [&](double x, double y) {
      std::array<bool, 6> full{};
      full.fill(true);
      for (const Box& box : boxes)
        if (x > 0.5 * box.x && x < 0.5 * (box.x + box.wide) && y > 0.5 * box.y &&
            y < 0.5 * (box.y + box.deep))
          for (int z = box.low; z < std::min(box.high, 6); ++z) full[static_cast<std::size_t>(z)] = false;
      Column column;
      for (int z = 0; z < 6; ++z) {
        if (!full[static_cast<std::size_t>(z)]) continue;
        const bool on = z > 0 && full[static_cast<std::size_t>(z - 1)];
        if (!on) column.push_back({static_cast<float>(z), 0, 1, 2});
        column.back().high = static_cast<float>(z + 1);
      }
      if (!column.empty() && column.back().high == 6.0f) {
        column.back().high_step = kStockSurface;
        if (slopes) column.back().high -= static_cast<float>(0.4 * std::max(0.0, std::sin(0.07 * (x + y))));
      }
      return column;
    });
    if (pick(2) == 0) grid.bounds.high.x -= 0.2;
    if (pick(2) == 0) grid.bounds.high.y -= 0.3;
    SCOPED_TRACE(testing::Message() << "round " << round << ", " << nx << " x " << ny);
    if (grid.intervals.empty()) continue;
    for (const double tolerance : {0.0, 0.01}) {
      const Mesh mesh = extract_mesh(grid, {.tolerance = mm(tolerance)});
      expect_valid(grid, mesh);
      EXPECT_EQ(degenerate_triangles(mesh), 0u);
    }
    if (HasFailure()) return;
  }
}

TEST(Mesh, RandomHeightsKeepTheVolume) {
  std::mt19937 random(chosen_seed());
  // Random pockets of random depth, as flat tools leave them.
  struct Pocket {
    double x0, y0, x1, y1, z;
  };
  std::vector<Pocket> pockets;
  double outline_depth = 0;
  for (int n = 0; n < 40; ++n) {
    std::uniform_real_distribution<double> at(0, 18), size(0.5, 6), depth(0.5, 8);
    const double x = at(random), y = at(random);
    pockets.push_back({x, y, x + size(random), y + size(random), depth(random)});
    const Pocket& p = pockets.back();
    outline_depth += 2 * (p.x1 - p.x0 + p.y1 - p.y0) * (8 - p.z);
  }
  const ColumnGrid grid = make_grid(200, 200, 0.1, 8, [&](double x, double y) {
    Interval run{0, 8};
    for (std::size_t n = 0; n < pockets.size(); ++n) {
      const Pocket& p = pockets[n];
      if (x < p.x0 || x > p.x1 || y < p.y0 || y > p.y1 || p.z >= run.high) continue;
      run.high = static_cast<float>(p.z);
      run.high_step = static_cast<std::uint32_t>(n);
    }
    return Column{run};
  });
  const Mesh mesh = extract_mesh(grid);
  expect_valid(grid, mesh);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), column_volume(grid), 0.2 * 0.1 * outline_depth);
}

TEST(Mesh, TheSameForAnyNumberOfThreads) {
  // Slopes, walls, holes and undercuts over several bands of rows.
  const ColumnGrid grid = make_grid(150, 200, 0.1, 3, [](double x, double y) {
    const auto top = static_cast<float>(2 + std::sin(3 * x) * std::cos(4 * y));
    if (std::fmod(x, 3.0) < 0.3) return Column{};
    if (std::fmod(y, 2.0) < 0.4) return Column{{0, 0.4f, kStockSurface, 2}, {0.7f, top, 2, 1}};
    return Column{{0, top, kStockSurface, 1}};
  });
  const std::vector<std::uint8_t> one_group(3, 0);
  MeshOptions options{.tolerance = mm(0.005), .step_groups = one_group, .threads = 1};
  const Mesh a = extract_mesh(grid, options);
  EXPECT_EQ(check_mesh(a).bad_edges, 0u);
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    options.threads = threads;
    const Mesh b = extract_mesh(grid, options);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(check_mesh(a.positions, a.triangles, threads).volume, check_mesh(a).volume);
  }
}

TEST(Mesh, StopsOnRequest) {
  struct Stop : Progress {
    void phase(std::string_view) override {}
    void report(double) override {}
    bool stop_requested() override { return true; }
  } stop;
  const ColumnGrid grid = make_grid(10, 10, 1, 3, [](double, double) { return Column{{0, 3}}; });
  EXPECT_TRUE(extract_mesh(grid, &stop).triangles.empty());
}

TEST(CheckMesh, CountsOpenAndDoubledEdges) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  mesh.triangles = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  EXPECT_EQ(check_mesh(mesh).bad_edges, 0u);
  EXPECT_NEAR(check_mesh(mesh).volume.mm3(), 1.0 / 6, 1e-9);
  std::swap(mesh.triangles[0], mesh.triangles[1]);  // one reversed triangle
  for (const unsigned threads : {1u, 2u, 3u, 7u})
    EXPECT_EQ(check_mesh(mesh.positions, mesh.triangles, threads).bad_edges, 3u);
  mesh.triangles.resize(9);
  std::swap(mesh.triangles[0], mesh.triangles[1]);
  EXPECT_EQ(check_mesh(mesh).bad_edges, 3u);
  mesh.triangles[0] = 99;
  EXPECT_GT(check_mesh(mesh).bad_edges, 0u);
}

TEST(CheckMesh, FindsEdgesOfFourTriangles) {
  Mesh mesh;  // two tetrahedra with only the edge from 0 to 1 in common
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1};
  mesh.triangles = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 0, 4, 1, 0, 1, 5, 1, 4, 5, 4, 0, 5};
  for (const unsigned threads : {1u, 2u, 7u})
    EXPECT_EQ(check_mesh(mesh.positions, mesh.triangles, threads).bad_edges, 1u);
}

TEST(CheckMesh, CountsEdgesAroundVerticesOfManyTriangles) {
  constexpr std::uint32_t kCount = 40;
  Mesh mesh;  // two pyramids base to base
  mesh.positions = {0, 0, 1, 0, 0, -1};
  for (std::uint32_t n = 0; n < kCount; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / kCount;
    for (const double v : {std::cos(angle), std::sin(angle), 0.0})
      mesh.positions.push_back(static_cast<float>(v));
    const std::uint32_t here = 2 + n, next = 2 + (n + 1) % kCount;
    for (const std::uint32_t v : {0u, here, next, 1u, next, here}) mesh.triangles.push_back(v);
  }
  EXPECT_EQ(check_mesh(mesh).bad_edges, 0u);
  std::swap(mesh.triangles[0], mesh.triangles[1]);
  EXPECT_EQ(check_mesh(mesh).bad_edges, 3u);
}

/// The code of the only error; none if the mesh is valid.
std::optional<Code> refusal(const Mesh& mesh, const VolumeRange& volume) {
  Diagnostics diagnostics;
  const bool valid = verify_mesh(mesh, volume, diagnostics);
  EXPECT_EQ(valid, !diagnostics.has_errors());
  return valid ? std::nullopt : std::optional<Code>(diagnostics.list().at(0).code);
}

TEST(Mesh, OnlyValidMeshesPassVerification) {
  const ColumnGrid grid = make_grid(12, 8, 0.5, 5, [](double x, double y) {
    return Column{{0, x > 2 && x < 4 && y > 1 && y < 3 ? 2.0f : 5.0f, kStockSurface, 3}};
  });
  const Mesh valid = extract_mesh(grid);
  const VolumeRange range = mesh_volume(grid);
  EXPECT_NEAR(range.expected.mm3(), 6 * 4 * 5 - 2 * 2 * 3, 1e-9);
  EXPECT_NEAR(range.tolerance.mm3(), 0.5 * (4 * 2 * 3), 0.01);  // a pitch of the pocket's walls
  EXPECT_EQ(refusal(valid, range), std::nullopt);

  Mesh open = valid;
  open.triangles.resize(open.triangles.size() - 3);
  EXPECT_EQ(refusal(open, range), codes::mesh_unsound);
  Mesh turned = valid;
  std::swap(turned.triangles[0], turned.triangles[1]);
  EXPECT_EQ(refusal(turned, range), codes::mesh_unsound);
  Mesh inside_out = valid;
  for (std::size_t t = 0; t < inside_out.triangles.size(); t += 3)
    std::swap(inside_out.triangles[t], inside_out.triangles[t + 1]);
  EXPECT_EQ(check_mesh(inside_out).bad_edges, 0u);
  EXPECT_EQ(refusal(inside_out, range), codes::mesh_unsound);
  Mesh higher = valid;
  for (std::size_t k = 2; k < higher.positions.size(); k += 3)
    if (higher.positions[k] == 0.0f) higher.positions[k] = 1.0f;
  EXPECT_EQ(check_mesh(higher).bad_edges, 0u);
  EXPECT_EQ(refusal(higher, range), codes::mesh_unsound);
  Mesh lost = valid;
  lost.positions[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal(lost, range), codes::mesh_unsound);
  Mesh beyond = valid;
  beyond.triangles[5] = static_cast<std::uint32_t>(beyond.positions.size());
  EXPECT_EQ(refusal(beyond, range), codes::mesh_unsound);

  EXPECT_EQ(refusal(Mesh{}, mesh_volume(ColumnGrid{})), std::nullopt);
  EXPECT_EQ(refusal(Mesh{}, range), codes::mesh_unsound);
}

TEST(Mesh, NoTriangleIsDegenerate) {
  // Walls at 45 degrees put three corners of a level face on one line; a disc has walls of every direction.
  for (const double pitch : {0.1, 0.13}) {
    const ColumnGrid grid = make_grid(80, 60, pitch, 5, [&](double x, double y) {
      if (x + y > 8 && x + y < 9.5) return Column{{0, 2}};
      if (std::hypot(x - 2, y - 2) < 1.2) return Column{{0, 1.5f}, {2.5f, 5}};
      return Column{{0, 5}};
    });
    const Mesh mesh = extract_mesh(grid);
    expect_valid(grid, mesh);
    EXPECT_EQ(degenerate_triangles(mesh), 0u);
  }
}

/// Largest distance in height between the upper surface of `mesh` and `height(x, y)` at the corners of the
/// columns. Sets `seen` to their number.
template <class Height>
double worst_height(const Mesh& mesh, double pitch, const Height& height, std::size_t& seen) {
  double worst = 0.0;
  seen = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    Point3 p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float* v = mesh.positions.data() + std::size_t{3} * mesh.triangles[t + k];
      p[k] = {v[0], v[1], v[2]};
    }
    const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (!(area > 1e-9)) continue;  // a wall, or facing down
    const auto first = [&](double a, double b, double c) {
      return std::ceil(std::min({a, b, c}) / pitch - 1e-6);
    };
    const auto last = [&](double a, double b, double c) {
      return std::floor(std::max({a, b, c}) / pitch + 1e-6);
    };
    for (double j = first(p[0].y, p[1].y, p[2].y); j <= last(p[0].y, p[1].y, p[2].y); ++j) {
      for (double i = first(p[0].x, p[1].x, p[2].x); i <= last(p[0].x, p[1].x, p[2].x); ++i) {
        const double x = i * pitch, y = j * pitch;
        const double u = ((x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (y - p[0].y)) / area;
        const double v = ((p[1].x - p[0].x) * (y - p[0].y) - (x - p[0].x) * (p[1].y - p[0].y)) / area;
        if (u < -1e-6 || v < -1e-6 || u + v > 1 + 1e-6) continue;
        ++seen;
        const double z = p[0].z + u * (p[1].z - p[0].z) + v * (p[2].z - p[0].z);
        worst = std::max(worst, std::abs(z - height(i, j)));
      }
    }
  }
  return worst;
}

/// The heights of the corners of columns of 0.1 mm in a mesh without merging.
std::map<std::pair<int, int>, double> corner_heights(const Mesh& full) {
  std::map<std::pair<int, int>, double> corner;
  for (std::size_t k = 0; k < full.positions.size(); k += 3) {
    const auto i = static_cast<int>(std::lround(full.positions[k] / 0.1f));
    const auto j = static_cast<int>(std::lround(full.positions[k + 1] / 0.1f));
    const double z = full.positions[k + 2];
    const auto [it, is_new] = corner.try_emplace({i, j}, z);
    if (!is_new) it->second = std::max(it->second, z);
  }
  return corner;
}

TEST(Mesh, MergesWithinATolerance) {
  constexpr double kPitch = 0.1;
  constexpr int kX = 150, kY = 130;
  const auto surface = [](double x, double y) {
    return 4 + std::sin(0.9 * x) * std::cos(0.7 * y) + 0.003 * x;
  };
  const ColumnGrid grid = make_grid(kX, kY, kPitch, 6, [&](double x, double y) {
    return Column{{0, static_cast<float>(surface(x, y))}};
  });
  const Mesh full = extract_mesh(grid);
  const auto corner = corner_heights(full);
  const auto height = [&](double i, double j) {
    return corner.at({static_cast<int>(i), static_cast<int>(j)});
  };
  std::size_t before = full.step.size();
  for (const double tolerance : {0.001, 0.005, 0.05}) {
    const Mesh mesh = extract_mesh(grid, {.tolerance = mm(tolerance)});
    expect_valid(grid, mesh);
    std::size_t seen = 0;
    EXPECT_LE(worst_height(mesh, kPitch, height, seen), tolerance + 1e-6);
    EXPECT_GE(seen, static_cast<std::size_t>(kX * kY));
    EXPECT_LT(mesh.step.size(), before);
    before = mesh.step.size();
  }
  EXPECT_LT(before, full.step.size() / 5);
}

TEST(Mesh, MergesTheLargestSquaresWithinATolerance) {
  // Curved along one diagonal of the squares only, by a little more than the tolerance.
  const ColumnGrid grid = make_grid(192, 192, 0.1, 8, [&](double x, double y) {
    return Column{{0, static_cast<float>(2 + 0.0015 * (x + y) * (x + y))}};
  });
  const auto corner = corner_heights(extract_mesh(grid));
  const auto height = [&](double i, double j) {
    return corner.at({static_cast<int>(i), static_cast<int>(j)});
  };
  for (const double tolerance : {0.04, 0.05, 0.06, 0.07}) {
    std::size_t seen = 0;
    const Mesh mesh = extract_mesh(grid, {.tolerance = mm(tolerance)});
    EXPECT_LE(worst_height(mesh, 0.1, height, seen), tolerance + 1e-6);
    EXPECT_GE(seen, std::size_t{192 * 192});
  }
}

TEST(Mesh, MergesOnlyStepsOfOneGroup) {
  // Two level halves, cut by steps 0 and 1 alternately on the left and by 2 on the right.
  ColumnGrid grid = make_grid(64, 64, 0.1, 5, [](double, double) { return Column{{0, 3}}; });
  for (std::size_t n = 0; n < grid.intervals.size(); ++n)
    grid.intervals[n].high_step = n % 64 < 32 ? static_cast<std::uint32_t>(n / 64 % 2) : 2;
  const std::vector<std::uint8_t> groups = {7, 7, 9};
  const Mesh mesh = extract_mesh(grid, {.tolerance = mm(0.001), .step_groups = groups});
  expect_valid(grid, mesh);
  EXPECT_LT(mesh.step.size(), extract_mesh(grid, {.tolerance = mm(0.001)}).step.size());
  int tops = 0;
  for (std::size_t t = 0; t < mesh.step.size(); ++t) {
    if (mesh.step[t] == kStockSurface) continue;
    double x = 0.0;
    for (std::size_t k = 0; k < 3; ++k) x += mesh.positions[std::size_t{3} * mesh.triangles[3 * t + k]] / 3.0;
    const float* z = mesh.positions.data() + std::size_t{3} * mesh.triangles[3 * t];
    if (z[2] < grid.bounds.low.z + 2.9) continue;  // below
    EXPECT_EQ(mesh.step[t] == 2, x > grid.bounds.low.x + 3.2) << x;
    ++tops;
  }
  EXPECT_GT(tops, 0);
}

}  // namespace
}  // namespace kerf
