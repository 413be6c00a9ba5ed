// Squares between columns that a wall passes through, measured at more points than their corners.
//
// A column has the material at its centre. Where its surroundings are smooth that is also the mean over its
// square, but the centres locate a wall only to half a pitch. After cutting, a search finds the squares
// between four neighbouring column centres that contain a wall, and all sweeps cut points in them with the
// same kernels. In volumes the mean over the points replaces the four quarters of columns: in those of the
// steps, which the kernels sum, and in Workpiece::Body::wall_volume. The columns themselves stay as they are.
//
// To replace the contribution of a column to each step too, its centre is cut again among the points, with a
// negative weight.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/cut/cutter.h"
#include "sim/dexel/tile.h"

namespace kerf::sim {

/// A square between columns, by its position in a tile: from column x to the next one, from row y to the
/// next. At the border of the block, -1 or the last column or row is the half square that is left there.
struct WallSquare {
  std::int8_t x, y;
};

/// The squares of a tile that walls pass through, and the quarters of columns that they cover.
struct WallSquares {
  struct Quarters {
    std::uint16_t column;  // by lane_index
    std::uint8_t taken;    // one bit each: low side; high side in X; in Y; in both
  };
  std::uint32_t tile = 0;
  double max_error = 0.0;  // maximum error of the column centres, mm of column
  std::vector<WallSquare> squares;
  std::vector<Quarters> quarters;
};

/// Sorted by tile. If there are too many squares, those with the lowest steps are omitted.
std::vector<WallSquares> find_walls(const Workpiece::Body& body, unsigned threads);

/// The walls of one tile.
class WallTile {
 public:
  struct Part {
    Part(Real height, int micros, std::shared_ptr<SlotPages> memory)
        : tile(height, micros, std::move(memory)) {}
    Tile tile;
    PointTile points;
  };
  /// Memory for the parts of many tiles.
  struct Parts {
    BlockStore<Part> store;
    std::shared_ptr<SlotPages> slots = std::make_shared<SlotPages>();
  };
  /// The more squares in all tiles, the fewer points per square.
  WallTile(const Workpiece::Body& body, const Cutter& cutter, const WallSquares& walls,
           std::size_t all_squares, Parts& memory);

  /// Cuts with the sweeps of the job, whose tile and fractions are replaced.
  void cut(TileJob job);

 private:
  std::vector<BlockStore<Part>::Pointer> parts_;
};

/// The walls of as many tiles as are cut at once. Those of a tile exist from its first sweep to its last, as
/// most jobs finish a tile long before their end.
class WallGroup {
 public:
  /// Uses entries of `found` from `next` on, and advances `next`. `sweeps`: number of sweeps per tile. The
  /// arguments must outlive the group.
  WallGroup(const Workpiece::Body& body, const Cutter& cutter, const std::vector<WallSquares>& found,
            std::size_t all_squares, std::size_t& next, const std::vector<std::size_t>& sweeps);

  const std::vector<bool>& tiles() const { return wanted_; }
  void cut(std::size_t tile, const TileJob& job);

 private:
  struct Walls {
    std::optional<WallTile> tile;
    std::size_t sweeps_left = 0;
  };
  const Workpiece::Body& body_;
  const Cutter& cutter_;
  const WallSquares* found_;
  std::size_t all_squares_;
  std::vector<bool> wanted_;
  std::vector<std::uint32_t> index_;  // of a tile in walls_
  WallTile::Parts parts_;
  std::vector<Walls> walls_;
};

}  // namespace kerf::sim
