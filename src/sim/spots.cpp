// Which sweeps are near a place: by tile, by block of columns, and by their distance.
#include "sim/spots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kerf::sim {
namespace {

/// Columns along the side of a block of columns that share a list of sweeps.
constexpr int kBlock = 8;
constexpr int kBlocksAcross = kTileColumns / kBlock;
constexpr std::uint32_t kNotYet = 0xffffffffu;

}  // namespace

void Nearby::gather(const std::vector<const Sweep*>& sweeps, Point3 place) {
  bounds_.clear();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Sweep* sweep : sweeps) {
    bounds_.push_back(bounds_of_distance(*sweep, tools_[sweep->tool], place, reach_));
    nearest = std::min(nearest, bounds_.back().high);
  }
  near_.clear();
  // A place `reach` away is nearer to each by no more than that, and further from the nearest by no more.
  for (std::size_t k = 0; k < sweeps.size(); ++k)
    if (bounds_[k].low <= std::min(nearest + 2.0 * reach_, reach_)) near_.push_back(sweeps[k]);
}

Distance Nearby::at(Point3 place) const {
  Distance nearest;
  for (const Sweep* sweep : near_) {
    const Distance distance = distance_to(*sweep, tools_[sweep->tool], place, 2.0 * reach_);
    if (distance.value < nearest.value) nearest = distance;
  }
  return nearest;
}

Spot SweepsByTile::spot_at(Point3 place, std::uint32_t number) const {
  const auto column = [&](double v, int columns) {
    return std::clamp(static_cast<int>(std::floor(v / body_.pitch)), 0, columns - 1);
  };
  const int i = column(place.x, body_.nx), j = column(place.y, body_.ny);
  const int tile = j / kTileColumns * body_.tiles_x + i / kTileColumns;
  const int block = j % kTileColumns / kBlock * kBlocksAcross + i % kTileColumns / kBlock;
  return {static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(block), number};
}

void SweepsByTile::take(const Batch& batch) {
  std::vector<std::uint32_t> number(batch.sweeps.size(), kNotYet);
  for (const Batch::Pair& pair : batch.pairs) {
    std::uint32_t& mine = number[pair.sweep];
    if (mine == kNotYet) {
      mine = static_cast<std::uint32_t>(sweeps_.size());
      sweeps_.push_back(batch.sweeps[pair.sweep]);
    }
    of_tile_[pair.tile].push_back(mine);
  }
}

std::vector<const Sweep*> SweepsByTile::near_block(const Spot& spot) const {
  const auto tiles_x = static_cast<std::uint32_t>(body_.tiles_x);
  const double i = spot.tile % tiles_x * kTileColumns + (spot.block % kBlocksAcross + 0.5) * kBlock;
  const double j = spot.tile / tiles_x * kTileColumns + (spot.block / kBlocksAcross + 0.5) * kBlock;
  const Point2 middle{i * body_.pitch, j * body_.pitch};
  const double half = std::numbers::sqrt2 * 0.5 * kBlock * body_.pitch + reach_;
  std::vector<const Sweep*> near;
  for (const std::uint32_t n : of_tile_[spot.tile]) {
    const Sweep& sweep = sweeps_[n];
    if (distance_in_plan(sweep, middle) <= tools_[sweep.tool].rim() + half) near.push_back(&sweep);
  }
  return near;
}

}  // namespace kerf::sim
