// Tiles by columns and by the boxes of motions.
#include "app/shown/changed_tiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kerf/job/outputs.h"

namespace kerf::app::view {
namespace {

constexpr std::size_t kMaxTiles = 600;
constexpr int kReach = 64;  // columns around a tile on which its mesh depends, see extract_mesh_tiles

/// Marked tiles.
class Marks {
 public:
  explicit Marks(const MeshTiling& tiling) : tiling_(tiling), marked_(tiling.size(), false) {}

  /// Marks the tiles that depend on columns from (low_i, low_j) to (high_i, high_j).
  void add(int low_i, int low_j, int high_i, int high_j) {
    const auto tile = [&](int column, int count) {
      return std::clamp(column / tiling_.columns, 0, count - 1);
    };
    const int last_x = tile(high_i + kReach, tiling_.nx), last_y = tile(high_j + kReach, tiling_.ny);
    for (int y = tile(std::max(low_j - kReach, 0), tiling_.ny); y <= last_y; ++y)
      for (int x = tile(std::max(low_i - kReach, 0), tiling_.nx); x <= last_x; ++x)
        marked_[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiling_.nx) +
                static_cast<std::size_t>(x)] = true;
  }

  std::vector<std::uint32_t> numbers() const {
    std::vector<std::uint32_t> list;
    for (std::size_t k = 0; k < marked_.size(); ++k)
      if (marked_[k]) list.push_back(static_cast<std::uint32_t>(k));
    return list;
  }

 private:
  MeshTiling tiling_;
  std::vector<bool> marked_;
};

/// The mesh of a print or of a part on the fourth axis as one tile.
std::vector<MeshTile> whole_part(const LiveJob& live, Progress* progress) {
  std::vector<MeshTile> tiles;
  if (live.run() == nullptr) return tiles;
  Diagnostics ignored;
  auto surface =
      make_surface(*live.job(), *live.run(), {.detail = SurfaceDetail::columns}, ignored, progress);
  if (surface) tiles.push_back({0, std::move(surface->mesh)});
  return tiles;
}

}  // namespace

MeshOptions mesh_options(unsigned threads) { return {.tolerance = kMeshTolerance, .threads = threads}; }

std::size_t update_tiles(const LiveJob& live, const LiveJobChange& change, const TileUpdate& how,
                         MeshTiling& tiling, TileSet& tiles, Progress* progress) {
  if (live.cut() == nullptr) {
    tiles.reset(how.revision);
    tiling = {};
    return tiles.replace(whole_part(live, progress), how.revision);
  }
  const Workpiece& workpiece = *live.cut()->workpiece();
  const MeshTiling before = std::exchange(tiling, mesh_tiling(workpiece, kMaxTiles));
  std::vector<std::uint32_t> numbers = tiles_at(tiling, change.columns);
  if (change.is_new || tiling != before) {
    tiles.reset(how.revision);
    numbers.resize(tiling.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
  } else {
    tiles.renumber(change.shifts, how.revision);
  }
  return tiles.replace(extract_mesh_tiles(workpiece, tiling, numbers, mesh_options(how.threads), progress),
                       how.revision);
}

std::vector<std::uint32_t> tiles_at(const MeshTiling& tiling, const std::vector<ColumnBlock>& blocks) {
  Marks marks(tiling);
  for (const ColumnBlock& block : blocks)
    marks.add(block.i, block.j, block.i + block.nx - 1, block.j + block.ny - 1);
  return marks.numbers();
}

std::vector<std::uint32_t> tiles_between(const LiveSimulation& live, const ToolTable& tools,
                                         const MeshTiling& tiling, std::size_t first, std::size_t last) {
  double radius = 0.0;
  for (const auto& [number, tool] : tools.tools()) radius = std::max(radius, tool.silhouette.max_radius());
  const Workpiece& workpiece = *live.workpiece();
  const double pitch = workpiece.pitch().mm();
  const Box3& bounds = workpiece.bounds();
  Marks marks(tiling);
  const auto column = [&](double at, double low, int count) {
    return static_cast<int>(std::clamp(std::floor((at - low) / pitch), -1.0, static_cast<double>(count)));
  };
  const Toolpath& path = live.path();
  for (MotionReader motion(path, first); motion.next() && motion.context().index < last;) {
    Box3 box;
    box.add(motion.context().from);
    box.add(motion.step().to());
    if (motion.step().kind() == StepKind::arc)
      box.add(walk_of(motion.step(), motion.context().from).bounds());
    const double room = radius + pitch;
    if (box.high.x + room < bounds.low.x || box.low.x - room > bounds.high.x ||
        box.high.y + room < bounds.low.y || box.low.y - room > bounds.high.y)
      continue;
    marks.add(column(box.low.x - room, bounds.low.x, workpiece.columns_x()),
              column(box.low.y - room, bounds.low.y, workpiece.columns_y()),
              column(box.high.x + room, bounds.low.x, workpiece.columns_x()),
              column(box.high.y + room, bounds.low.y, workpiece.columns_y()));
  }
  return marks.numbers();
}

}  // namespace kerf::app::view
