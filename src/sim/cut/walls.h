// Squares between columns that a wall goes through, counted at more than their corners.
//
// A column says what there is at its centre. Where its surroundings are smooth that is also the mean over its
// square, but a wall is known by the centres to half a pitch only. So after the cutting those squares are
// looked for that have four neighbouring columns' centres as corners and a wall between some of them, and
// points in them are cut by all sweeps and the same kernels. The mean over the points goes into the volumes,
// in place of what the quarters of the four columns say: into those of the steps, which the kernels count,
// and into Workpiece::Body::wall_volume. The columns themselves stay as they are.
//
// So that each step's part of a column is replaced too, the column's centre is cut anew beside the points,
// with a weight below 0.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/cut/cutter.h"
#include "sim/dexel/tile.h"

namespace kerf::sim {

/// A square between columns, by its place in a tile: from column x to the next one, from row y to the next.
/// At the block's border -1, or the last column or row, stands for the half of a square that is left there.
struct WallSquare {
  std::int8_t x, y;
};

/// The squares of a tile that walls go through, and which quarters they take of the columns in it.
struct WallSquares {
  struct Quarters {
    std::uint16_t column;  // by lane_index
    std::uint8_t taken;    // a bit each: of the low side, beyond the middle in X, in Y, in both
  };
  std::uint32_t tile = 0;
  double most_error = 0.0;  // what the columns' centres can say too much or too little, mm of column
  std::vector<WallSquare> squares;
  std::vector<Quarters> quarters;
};

/// In order of tiles. There are never more than the workpiece can afford: of too many those with the lowest
/// steps are left out.
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
  /// Where the parts of many tiles live.
  struct Parts {
    BlockStore<Part> store;
    std::shared_ptr<SlotPages> slots = std::make_shared<SlotPages>();
  };
  /// The more squares there are in all tiles, the fewer points each of them needs.
  WallTile(const Workpiece::Body& body, const Cutter& cutter, const WallSquares& walls,
           std::size_t all_squares, Parts& memory);

  /// Cuts with the sweeps of the job, whose tile and shares are replaced.
  void cut(TileJob job);

 private:
  std::vector<BlockStore<Part>::Pointer> parts_;
};

/// As many tiles' walls as are cut in one go. A tile's exist from its first sweep to its last, since most
/// jobs are done with a tile long before they end.
class WallGroup {
 public:
  /// Takes from `found`, from number `next` on, which is moved on. `sweeps` tells how many come to each tile;
  /// the arguments have to outlive the group.
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
  std::vector<std::uint32_t> place_;  // of a tile in walls_
  WallTile::Parts parts_;
  std::vector<Walls> walls_;
};

}  // namespace kerf::sim
