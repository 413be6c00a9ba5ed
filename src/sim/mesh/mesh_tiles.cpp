// The mesh of a workpiece in tiles: rectangles of tiles are meshed with one square of columns around them, on
// which their triangles depend, and divided.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "sim/mesh/mesh_columns.h"

namespace kerf {
namespace {

using meshing::kSquare;
using meshing::SquareRange;

constexpr std::uint32_t kNoVertex = 0xffffffffu;

/// A rectangle of tiles.
struct TileRange {
  int x = 0, y = 0;
  int count_x = 0, count_y = 0;
};

/// The tiles as few rectangles: runs along the rows, joined with equal runs of the row below.
std::vector<TileRange> rectangles_of(const MeshTiling& tiling, std::span<const std::uint32_t> numbers) {
  std::vector<TileRange> rectangles;
  for (const std::uint32_t number : numbers) {
    const int x = static_cast<int>(number) % tiling.nx, y = static_cast<int>(number) / tiling.nx;
    if (!rectangles.empty() && rectangles.back().y == y &&
        rectangles.back().x + rectangles.back().count_x == x) {
      ++rectangles.back().count_x;
    } else {
      rectangles.push_back({x, y, 1, 1});
    }
  }
  std::vector<TileRange> joined;
  for (const TileRange& run : rectangles) {
    const auto below = std::find_if(joined.begin(), joined.end(), [&](const TileRange& r) {
      return r.x == run.x && r.count_x == run.count_x && r.y + r.count_y == run.y;
    });
    if (below == joined.end()) {
      joined.push_back(run);
    } else {
      ++below->count_y;
    }
  }
  return joined;
}

/// The squares of a rectangle of tiles and one more on each side.
SquareRange squares_around(const Workpiece& workpiece, const MeshTiling& tiling, const TileRange& tiles) {
  const int each = tiling.columns / kSquare;
  const auto range = [&](int first, int count, int columns) {
    const int all = (columns + kSquare - 1) / kSquare;
    const int begin = std::max(first * each - 1, 0), end = std::min((first + count) * each + 1, all);
    return std::pair(begin, end - begin);
  };
  const auto [x, count_x] = range(tiles.x, tiles.count_x, workpiece.columns_x());
  const auto [y, count_y] = range(tiles.y, tiles.count_y, workpiece.columns_y());
  return {x, y, count_x, count_y};
}

/// Finds the tile of each triangle by its centre.
class TileFinder {
 public:
  TileFinder(const Workpiece& workpiece, const MeshTiling& tiling)
      : low_(workpiece.bounds().low), tiling_(tiling), side_(tiling.columns * workpiece.pitch().mm()) {}

  std::uint32_t tile(const Mesh& mesh, std::size_t triangle) const {
    const auto centre = [&](std::size_t axis) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += static_cast<double>(mesh.positions[std::size_t{3} * mesh.triangles[3 * triangle + k] + axis]);
      return sum / 3.0;
    };
    const auto number = [&](double at, double low, int count) {
      // A wall between two tiles is rounded either way; caps are a third of a column away from the sides.
      const double upwards = 0.01 / tiling_.columns;
      return std::clamp(static_cast<int>(std::floor((at - low) / side_ + upwards)), 0, count - 1);
    };
    return static_cast<std::uint32_t>(number(centre(1), low_.y, tiling_.ny) * tiling_.nx +
                                      number(centre(0), low_.x, tiling_.nx));
  }

 private:
  Point3 low_;
  MeshTiling tiling_;
  double side_;
};

/// Adds triangles of a mesh to tiles, each with the vertices that it needs.
class Divider {
 public:
  explicit Divider(const Mesh& mesh) : mesh_(mesh), number_(mesh.positions.size() / 3, kNoVertex) {}

  void add(std::span<const std::uint32_t> triangles, Mesh& tile) {
    used_.clear();
    for (const std::uint32_t t : triangles) {
      for (std::size_t k = 0; k < 3; ++k) tile.triangles.push_back(vertex(mesh_.triangles[3 * t + k], tile));
      tile.step.push_back(mesh_.step[t]);
    }
    for (const std::uint32_t v : used_) number_[v] = kNoVertex;
  }

 private:
  std::uint32_t vertex(std::uint32_t v, Mesh& tile) {
    if (number_[v] == kNoVertex) {
      number_[v] = static_cast<std::uint32_t>(tile.positions.size() / 3);
      used_.push_back(v);
      for (std::size_t axis = 0; axis < 3; ++axis)
        tile.positions.push_back(mesh_.positions[std::size_t{3} * v + axis]);
    }
    return number_[v];
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> number_;  // of the mesh's vertices in the present tile
  std::vector<std::uint32_t> used_;
};

/// Divides the mesh of a rectangle of tiles; triangles outside of it are those at the cut sides, or belong to
/// the columns around it.
void divide(const Mesh& mesh, const TileFinder& finder, const MeshTiling& tiling, const TileRange& tiles,
            std::vector<MeshTile>& out) {
  const auto wide = static_cast<std::size_t>(tiles.count_x);
  std::vector<std::vector<std::uint32_t>> lists(wide * static_cast<std::size_t>(tiles.count_y));
  for (std::size_t t = 0; t < mesh.step.size(); ++t) {
    const std::uint32_t number = finder.tile(mesh, t);
    const int x = static_cast<int>(number) % tiling.nx - tiles.x;
    const int y = static_cast<int>(number) / tiling.nx - tiles.y;
    if (x < 0 || y < 0 || x >= tiles.count_x || y >= tiles.count_y) continue;
    lists[static_cast<std::size_t>(y) * wide + static_cast<std::size_t>(x)].push_back(
        static_cast<std::uint32_t>(t));
  }
  Divider divider(mesh);
  for (std::size_t k = 0; k < lists.size(); ++k) {
    const int x = tiles.x + static_cast<int>(k % wide), y = tiles.y + static_cast<int>(k / wide);
    MeshTile tile{static_cast<std::uint32_t>(y * tiling.nx + x), {}};
    divider.add(lists[k], tile.mesh);
    out.push_back(std::move(tile));
  }
}

}  // namespace

MeshTiling mesh_tiling(const Workpiece& workpiece, std::size_t max_tiles) {
  MeshTiling tiling;
  do {
    tiling.columns += kSquare;
    tiling.nx = (workpiece.columns_x() + tiling.columns - 1) / tiling.columns;
    tiling.ny = (workpiece.columns_y() + tiling.columns - 1) / tiling.columns;
  } while (tiling.size() > std::max<std::size_t>(max_tiles, 1));
  return tiling;
}

std::vector<MeshTile> extract_mesh_tiles(const Workpiece& workpiece, const MeshTiling& tiling,
                                         std::span<const std::uint32_t> numbers, const MeshOptions& options,
                                         Progress* progress) {
  std::vector<MeshTile> tiles;
  const TileFinder finder(workpiece, tiling);
  for (const TileRange& range : rectangles_of(tiling, numbers)) {
    const MeshColumns columns(std::make_unique<MeshColumns::Body>(
        workpiece, squares_around(workpiece, tiling, range), thread_count(options.threads)));
    const Mesh mesh = extract_mesh(columns, options, progress);
    if (stop_requested(progress)) return {};
    divide(mesh, finder, tiling, range, tiles);
  }
  std::sort(tiles.begin(), tiles.end(),
            [](const MeshTile& a, const MeshTile& b) { return a.number < b.number; });
  return tiles;
}

}  // namespace kerf
