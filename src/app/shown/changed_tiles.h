// Which tiles of a mesh an edit or a motion can have changed.
#pragma once

#include <cstdint>
#include <vector>

#include "app/shown/tiles.h"

#include "kerf/job/live_job.h"
#include "kerf/sim/mesh.h"
#include "kerf/tool/tool.h"

namespace kerf::app::view {

/// The accuracy of shown meshes.
MeshOptions mesh_options(unsigned threads);

struct TileUpdate {
  std::uint32_t revision = 0;
  unsigned threads = 0;
};
/// Brings the tiles to the state of the job after a change; `tiling` is that of the tiles, empty where they
/// are the whole part. Returns the number of tiles that differ from before. If stopped, the tiles are not
/// usable.
std::size_t update_tiles(const LiveJob& live, const LiveJobChange& change, const TileUpdate& how,
                         MeshTiling& tiling, TileSet& tiles, Progress* progress = nullptr);

/// The tiles whose mesh depends on the columns of these blocks, in ascending order.
std::vector<std::uint32_t> tiles_at(const MeshTiling& tiling, const std::vector<ColumnBlock>& blocks);
/// The tiles whose mesh the steps from `first` to `last` - 1 can have changed, in ascending order.
std::vector<std::uint32_t> tiles_between(const LiveSimulation& live, const ToolTable& tools,
                                         const MeshTiling& tiling, std::size_t first, std::size_t last);

}  // namespace kerf::app::view
