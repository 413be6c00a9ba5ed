// Tiles that are updated after edits against those of a new mesh, and their bytes.
#include "app/shown/tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <random>

#include "app/shown/changed_tiles.h"
#include "base/system.h"

#include "kerf/job/program.h"

namespace kerf::app::view {
namespace {

std::shared_ptr<const Job> job_of(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("kerf_view_tiles_" + std::to_string(process_number()) + ".nc");
  std::ofstream(file) << text;
  Diagnostics diagnostics;
  auto program = load_program(file.string(), {}, diagnostics);
  std::filesystem::remove(file);
  return std::make_shared<const Job>(make_job(std::move(*program), {}, UnknownTool::assume, diagnostics));
}

/// Short cuts over a large plate, one of them changed at random by each call.
class Plate {
 public:
  std::string next() {
    const auto number = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random_);
    };
    if (cuts_.empty())
      for (int k = 0; k < 60; ++k) cuts_.emplace_back();
    std::string& cut = cuts_[random_() % cuts_.size()];
    const double x = number(0, 90), y = number(0, 70);
    cut = "G0 Z2\nG0 X" + std::to_string(x) + " Y" + std::to_string(y) + "\nG1 Z-" +
          std::to_string(number(0.1, 5)) + " F100\nG1 X" + std::to_string(x + number(-9, 9)) + " Y" +
          std::to_string(y + number(-9, 9)) + "\n";
    std::string text = "(stockMin:0mm, 0mm, -6mm)\n(stockMax:90mm, 70mm, 0mm)\nG21 G90\nM6 T102\nM3 S9000\n";
    for (const std::string& each : cuts_) text += each;
    return text + "G0 Z5\nM2\n";
  }

 private:
  std::mt19937 random_{3};
  std::vector<std::string> cuts_;
};

/// A tile as the sorted corners of its triangles with their steps, in tenths of a micron, and for each step
/// the sums of its triangles' areas and of what they enclose with the origin. The diagonal that divides a
/// flat quadrilateral is not part of it: it follows from the order in which triangles without area are
/// removed.
struct Surface {
  std::vector<std::array<long, 4>> corners;
  std::map<std::uint32_t, std::array<double, 2>> sums;
};
Surface surface_of(const Tile& tile) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, tile.bytes->data() + at, sizeof value);
    return value;
  };
  const std::size_t vertices = number(8), count = number(12);
  EXPECT_EQ(count, tile.triangles);
  EXPECT_EQ(tile.bytes->size(), 16 + 12 * vertices + 16 * count);
  Surface out;
  for (std::size_t t = 0; t < count; ++t) {
    const std::uint32_t step = number(16 + 12 * vertices + 12 * count + 4 * t);
    std::array<Point3, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t first = 16 + 12 * std::size_t{number(16 + 12 * vertices + 4 * (3 * t + k))};
      const auto value = [&](std::size_t axis) {
        return static_cast<double>(std::bit_cast<float>(number(first + 4 * axis)));
      };
      at[k] = {value(0), value(1), value(2)};
      out.corners.push_back({std::lround(1e4 * at[k].x), std::lround(1e4 * at[k].y),
                             std::lround(1e4 * at[k].z), static_cast<long>(step)});
    }
    const Point3 normal = cross(at[1] - at[0], at[2] - at[0]);
    out.sums[step][0] += 0.5 * length(normal);
    out.sums[step][1] += dot(normal, at[0]) / 6.0;
  }
  std::sort(out.corners.begin(), out.corners.end());
  out.corners.erase(std::unique(out.corners.begin(), out.corners.end()), out.corners.end());
  return out;
}

bool same_surface(const Tile& a, const Tile& b) {
  const Surface s = surface_of(a), t = surface_of(b);
  if (a.triangles != b.triangles || s.corners != t.corners || s.sums.size() != t.sums.size()) return false;
  for (const auto& [step, sums] : s.sums)
    for (std::size_t k = 0; k < 2; ++k)
      if (std::abs(sums[k] - t.sums.at(step)[k]) > 1e-3) return false;
  return true;
}

TEST(Tiles, AreThoseOfANewMeshAfterEveryOf200Edits) {
  Plate plate;
  LiveJob live;
  TileSet tiles;
  MeshTiling tiling;
  std::size_t changed = 0, all = 0;
  for (std::uint32_t revision = 1; revision <= 200; ++revision) {
    Diagnostics diagnostics;
    const auto change =
        live.update(job_of(plate.next()), {.resolution = mm(0.3), .threads = 1}, {}, diagnostics);
    ASSERT_TRUE(change);
    changed += update_tiles(live, *change, {revision, 1}, tiling, tiles);
    if (revision % 4 != 0) continue;  // what is wrong once stays wrong
    TileSet fresh;
    MeshTiling of_fresh;
    update_tiles(live, {.is_new = true, .columns = {}, .shifts = {}}, {revision, 1}, of_fresh, fresh);
    ASSERT_EQ(tiling, of_fresh);
    ASSERT_EQ(tiles.tiles().size(), fresh.tiles().size());
    for (std::size_t k = 0; k < fresh.tiles().size(); ++k)
      ASSERT_TRUE(same_surface(tiles.tiles()[k], fresh.tiles()[k])) << "tile " << k << ", edit " << revision;
    all += 4 * fresh.tiles().size();
  }
  EXPECT_GT(all, 200u * 10u);
  EXPECT_LT(changed, all / 2);  // most edits touch a few tiles
}

TEST(Tiles, AtAnEarlierStepAreThoseThatDifferFromTheEnd) {
  Plate plate;
  LiveJob live;
  TileSet tiles;
  MeshTiling tiling;
  Diagnostics diagnostics;
  for (int k = 0; k < 50; ++k) plate.next();
  const auto job = job_of(plate.next());
  const auto change = live.update(job, {.resolution = mm(0.3), .threads = 1}, {}, diagnostics);
  update_tiles(live, *change, {1, 1}, tiling, tiles);
  const std::size_t steps = job->program.path.size();
  for (std::size_t step = 0; step <= steps; step += 7) {
    const Workpiece part = *live.cut()->at(step);
    const auto between = tiles_between(*live.cut(), job->tools, tiling, step, steps);
    std::vector<std::uint32_t> numbers(tiling.size());
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<std::uint32_t>(k);
    const auto all = extract_mesh_tiles(part, tiling, numbers, mesh_options(1));
    for (const MeshTile& tile : all) {
      const bool listed = std::binary_search(between.begin(), between.end(), tile.number);
      if (listed) continue;
      EXPECT_TRUE(tile_bytes(tile.number, 0, tile.mesh) == *tiles.tiles()[tile.number].bytes) << step;
    }
  }
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

MeshTile triangle(std::uint32_t number, float z) {
  return {number, {.positions = {0, 0, z, 1, 0, z, 0, 1, z}, .triangles = {0, 1, 2}, .step = {5}}};
}

TEST(Tiles, AreSentToAPageThatDoesNotHaveThem) {
  TileSet tiles;
  tiles.reset(1);
  EXPECT_EQ(tiles.replace({triangle(0, 1), triangle(4, 1)}, 1), 2u);
  EXPECT_EQ(tiles.replace({triangle(0, 1), triangle(4, 2)}, 2), 1u);  // the first one is as before
  const std::string all = tiles.changed_since(0, 2), newer = tiles.changed_since(1, 2);
  EXPECT_EQ(all.substr(0, 4), "KMSH");
  EXPECT_EQ(number_at(all, 8), 2u);   // the revision
  EXPECT_EQ(number_at(all, 12), 1u);  // forget the others
  EXPECT_EQ(number_at(all, 16), kWholeJob);
  EXPECT_EQ(number_at(all, 20), 2u);  // tiles
  EXPECT_EQ(all.size(), 28u + 2u * (16u + 36u + 12u + 4u));
  EXPECT_EQ(number_at(newer, 12), 0u);
  EXPECT_EQ(number_at(newer, 20), 1u);
  EXPECT_EQ(number_at(newer, 28), 4u);  // its id
  EXPECT_EQ(tiles.changed_since(2, 2).size(), 28u);
  tiles.reset(3);
  tiles.replace({triangle(1, 0)}, 3);
  EXPECT_EQ(number_at(tiles.changed_since(2, 3), 12), 1u);  // another part
  EXPECT_EQ(tiles.triangles(), 1u);
}

TEST(Tiles, GetNewNumbersOfStepsWhereTheyAre) {
  TileSet tiles;
  tiles.reset(1);
  tiles.replace({triangle(0, 1)}, 1);  // step 5
  tiles.renumber({{3, 2}, {6, -1}}, 2);
  const std::string newer = tiles.changed_since(1, 2), all = tiles.changed_since(0, 2);
  EXPECT_EQ(number_at(newer, 20), 0u);  // no tile
  EXPECT_EQ(number_at(newer, 24), 1u);  // one table
  const std::uint32_t expected[] = {2, 2, 3, 2, 6, 0xffffffffu};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(number_at(newer, 28 + 4 * k), expected[k]);
  EXPECT_EQ(number_at(all, 24), 0u);
  EXPECT_EQ(number_at(all, all.size() - 4), 7u);
  tiles.renumber({{8, 1}}, 3);  // not this one
  EXPECT_EQ(number_at(tiles.changed_since(0, 3), all.size() - 4), 7u);
  for (std::uint32_t revision = 4; revision < 400; ++revision) tiles.renumber({{0, 1}}, revision);
  EXPECT_EQ(number_at(tiles.changed_since(1, 399), 12), 1u);  // too far behind: all again
  EXPECT_EQ(number_at(tiles.changed_since(390, 399), 24), 9u);
}

}  // namespace
}  // namespace kerf::app::view
