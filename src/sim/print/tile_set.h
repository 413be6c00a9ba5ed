// The tiles of one grid of columns, and laying batches of pieces in them on several threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sim/print/print_tile.h"

namespace kerf::printing {

class TileSet {
 public:
  explicit TileSet(const Frame& frame)
      : frame_(frame),
        tiles_x_((frame.nx + kTileSide - 1) / kTileSide),
        tiles_y_((frame.ny + kTileSide - 1) / kTileSide),
        tiles_(static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_)) {}

  const Frame& frame() const { return frame_; }
  /// Adds a piece to the batch; its coordinates are relative to the frame's column 0, 0.
  void add(const BeadPiece& piece, std::uint32_t number);
  /// Pairs of tile and piece, and the columns that they can touch: how large the batch is.
  std::size_t pairs() const { return pairs_.size(); }
  std::size_t columns() const { return columns_; }

  /// Lays the batch: tile by tile, the pieces of a tile in the order of their numbers.
  void lay(const std::vector<BeadPiece>& pieces, double contact_depth, unsigned threads,
           const std::function<bool()>& stop);
  /// Calls visit(number of the piece, its sums in a tile), in an order that does not depend on threads.
  template <class Visit>
  void for_each_sum(const Visit& visit) const {
    for (std::size_t k = 0; k < pairs_.size(); ++k) visit(pairs_[k].piece, sums_[k]);
  }
  template <class Visit>
  void for_each_contact(const Visit& visit) const {
    for (const std::vector<NozzleContact>& of_tile : contacts_)
      for (const NozzleContact& contact : of_tile) visit(contact);
  }
  void clear_batch();

  std::size_t runs() const;
  bool too_deep() const;
  /// The intervals of all columns.
  ColumnGrid grid(double height) const;
  /// Calls visit(position relative to the frame's column 0, 0; its intervals, lowest first) for each column
  /// with material.
  template <class Visit>
  void for_each_column(const Visit& visit) const {
    std::vector<Interval> runs;
    for (const auto& tile : tiles_) {
      for (int column = 0; tile && column < kTileSide * kTileSide; ++column) {
        runs.clear();
        tile->intervals(column, runs);
        if (!runs.empty()) visit(tile->position(column), std::span<const Interval>(runs));
      }
    }
  }

 private:
  struct Pair {
    std::uint32_t tile, piece;
  };
  bool passes(const BeadPiece& piece, double reach, int tile_y, int& first_x, int& last_x) const;
  void sort_pairs();

  Frame frame_;
  int tiles_x_, tiles_y_;
  std::vector<std::unique_ptr<PrintTile>> tiles_;
  std::vector<Pair> pairs_, sorted_;
  std::vector<PieceSums> sums_;  // one per pair
  std::vector<std::size_t> starts_;
  std::vector<std::vector<NozzleContact>> contacts_;
  std::size_t columns_ = 0;
};

}  // namespace kerf::printing
