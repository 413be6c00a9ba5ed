// Columns that a wall goes through, counted at more than their centre.
//
// A column says what there is at its centre. Where its surroundings are smooth that is also the mean over its
// square, but a wall that goes through the square is known by the centre to half a pitch only. So after the
// cutting those columns are looked for and cut once more, by all sweeps and the same kernels, as 16 points
// each. The mean over the points goes into the volumes: into those of the steps, which the kernels count, and
// into Workpiece::Body::wall_volume. The columns themselves stay as they are.
//
// So that each step's part of a column is replaced too, the column's centre is cut anew beside the points,
// with a weight below 0.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/kernels.h"
#include "sim/tile.h"

namespace kerf::sim {

/// The columns of a tile, by lane_index, that walls go through.
struct WallColumns {
  std::uint32_t tile = 0;
  std::vector<std::uint16_t> columns;
};

/// In order of tiles. There are never more than the workpiece can afford: of too many those with the lowest
/// steps are left out.
std::vector<WallColumns> find_walls(const Workpiece::Body& body, unsigned threads);

/// The columns at the walls of one tile.
class WallTile {
 public:
  struct Part {
    explicit Part(Real height) : tile(height, kTileColumns, kTileColumns) {}
    Tile tile;
    PointPlaces points{};
    std::vector<Real> weights;
  };
  using Parts = BlockStore<Part>;
  WallTile(const Workpiece::Body& body, const WallColumns& walls, Parts& store);

  /// Cuts with the sweeps of the job, whose tile, shares and weights are replaced.
  void cut(TileJob job);
  /// Length of the columns' material by their points less that by their centres, border columns by their
  /// shares, mm.
  double excess() const;

 private:
  void add_point_column(Part& part, const Workpiece::Body& body, std::uint32_t tile, int number,
                        int lane) const;

  Tile centres_;
  std::vector<Real> centre_weights_;
  std::vector<Parts::Pointer> parts_;
};

/// As many tiles' walls as are kept in memory at a time.
class WallGroup {
 public:
  /// Takes from `found`, from number `next` on, which is moved on.
  WallGroup(const Workpiece::Body& body, const std::vector<WallColumns>& found, std::size_t& next,
            unsigned threads);

  const std::vector<bool>& tiles() const { return wanted_; }
  void cut(std::size_t tile, const TileJob& job) { walls_[place_[tile]]->cut(job); }
  double excess() const;

 private:
  unsigned threads_;
  std::vector<bool> wanted_;
  std::vector<std::uint32_t> place_;  // of a tile in walls_
  WallTile::Parts parts_;
  BlockStore<WallTile> store_;
  std::vector<BlockStore<WallTile>::Pointer> walls_;
};

}  // namespace kerf::sim
