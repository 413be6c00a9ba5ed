// Tiles of columns: which of them a piece meets, laying a batch, and the columns of all.
#include "sim/print/tile_set.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace kerf::printing {

/// The tiles of a row within reach of a piece; false if there are none.
bool TileSet::passes(const BeadPiece& p, double reach, int tile_y, int& first_x, int& last_x) const {
  const double side = kTileSide * frame_.pitch;
  const double low = tile_y * side - reach - frame_.pitch, high = (tile_y + 1) * side + reach;
  double a = 0.0, b = p.length;  // range of the centre line within these y
  const double rise = p.along.y;
  if (std::abs(rise) * p.length > frame_.pitch) {
    const double at_low = (low - p.from.y) / rise, at_high = (high - p.from.y) / rise;
    a = std::max(a, std::min(at_low, at_high));
    b = std::min(b, std::max(at_low, at_high));
  }
  if (a > b) return false;
  const double xa = p.from.x + a * p.along.x, xb = p.from.x + b * p.along.x;
  const auto tile_at = [&](double x) { return std::floor(x / side); };
  const double first = tile_at(std::min(xa, xb) - reach - frame_.pitch);
  const double last = tile_at(std::max(xa, xb) + reach + frame_.pitch);
  if (last < 0.0 || first >= tiles_x_) return false;
  first_x = static_cast<int>(std::max(first, 0.0));
  last_x = static_cast<int>(std::min(last, tiles_x_ - 1.0));
  return true;
}

void TileSet::add(const BeadPiece& piece, std::uint32_t number) {
  const double reach = piece.kind == PieceKind::travel ? frame_.pitch : piece.reach();
  const double side = kTileSide * frame_.pitch, end = piece.from.y + piece.length * piece.along.y;
  const double first = std::floor((std::min(piece.from.y, end) - reach) / side);
  const double last = std::floor((std::max(piece.from.y, end) + reach) / side + 1.0 / kTileSide);
  if (last >= 0.0 && first < tiles_y_) {
    const int last_y = static_cast<int>(std::min(last, tiles_y_ - 1.0));
    for (int y = static_cast<int>(std::max(first, 0.0)); y <= last_y; ++y) {
      int first_x = 0, last_x = -1;
      if (!passes(piece, reach, y, first_x, last_x)) continue;
      for (int x = first_x; x <= last_x; ++x)
        pairs_.push_back({static_cast<std::uint32_t>(y * tiles_x_ + x), number});
    }
  }
  const double columns = (piece.length / frame_.pitch + 2.0) * (2.0 * reach / frame_.pitch + 2.0);
  columns_ += static_cast<std::size_t>(
      std::min(columns, static_cast<double>(frame_.nx) * static_cast<double>(frame_.ny)));
}

/// By tile; within a tile by time. Counting the pairs of each tile is faster than comparing.
void TileSet::sort_pairs() {
  std::vector<std::size_t> next(tiles_.size() + 1, 0);
  for (const Pair& pair : pairs_) ++next[pair.tile + 1];
  starts_.clear();
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    if (next[tile + 1] != 0) starts_.push_back(next[tile]);
    next[tile + 1] += next[tile];
  }
  starts_.push_back(pairs_.size());
  sorted_.resize(pairs_.size());
  for (const Pair& pair : pairs_) sorted_[next[pair.tile]++] = pair;
  pairs_.swap(sorted_);
}

void TileSet::lay(const std::vector<BeadPiece>& pieces, double contact_depth, unsigned threads,
                  const std::function<bool()>& stop) {
  sort_pairs();
  sums_.assign(pairs_.size(), {});
  contacts_.assign(starts_.size() - 1, {});
  const auto lay_tile = [&](std::size_t n) {
    const std::uint32_t number = pairs_[starts_[n]].tile;
    std::unique_ptr<PrintTile>& tile = tiles_[number];
    if (!tile)
      tile = std::make_unique<PrintTile>(frame_, static_cast<int>(number) % tiles_x_,
                                         static_cast<int>(number) / tiles_x_);
    for (std::size_t k = starts_[n]; k < starts_[n + 1]; ++k)
      tile->add(pieces[pairs_[k].piece], contact_depth, sums_[k], contacts_[n]);
  };
  parallel_for(threads, starts_.size() - 1, lay_tile, stop);
}

void TileSet::clear_batch() {
  pairs_.clear();
  columns_ = 0;
}

std::size_t TileSet::runs() const {
  std::size_t runs = 0;
  for (const auto& tile : tiles_) runs += tile ? tile->runs() : 0;
  return runs;
}

bool TileSet::too_deep() const {
  return std::any_of(tiles_.begin(), tiles_.end(), [](const auto& tile) { return tile && tile->too_deep(); });
}

ColumnGrid TileSet::grid(double height) const {
  ColumnGrid grid;
  grid.bounds.low = {frame_.x - 0.5 * frame_.pitch, frame_.y - 0.5 * frame_.pitch, frame_.bed};
  grid.bounds.high = grid.bounds.low + Point3{frame_.nx * frame_.pitch, frame_.ny * frame_.pitch, height};
  grid.pitch = frame_.pitch;
  grid.nx = frame_.nx;
  grid.ny = frame_.ny;
  grid.intervals.reserve(runs());
  grid.first.reserve(static_cast<std::size_t>(frame_.nx) * static_cast<std::size_t>(frame_.ny) + 1);
  for (int j = 0; j < frame_.ny; ++j) {
    for (int i = 0; i < frame_.nx; ++i) {
      grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
      const auto number = static_cast<std::size_t>(j / kTileSide * tiles_x_ + i / kTileSide);
      if (tiles_[number])
        tiles_[number]->intervals(j % kTileSide * kTileSide + i % kTileSide, grid.intervals);
    }
  }
  grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
  return grid;
}

}  // namespace kerf::printing
