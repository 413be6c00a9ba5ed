// The columns of a workpiece: tiles of 64 x 64 columns; each tile has 4 x 4 supers of 4 x 4 micros of 4 x 4
// columns.
//
// The 16 columns of a micro are one row of lanes, so that kernels process 16 neighbours at a time. The
// interval that starts at the floor is stored as its top; most columns have no other. Intervals above
// undercuts are in a chain of slots with one interval per column each. Heights are mm above the block's
// floor, single precision.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/dexel/blocks.h"
#include "sim/dexel/slots.h"

#include "kerf/sim/workpiece.h"

namespace kerf::sim {

inline constexpr int kMicros = 256;      // micros of a tile
inline constexpr int kSupers = 16;       // supers of a tile, and micros of a super
inline constexpr int kTileColumns = 64;  // columns along a tile's edge
inline constexpr Real kFar = 1e30f;      // "no material"; safe in arithmetic

/// Index of a column in the arrays of its tile, from its position in the tile.
constexpr int lane_index(int x, int y) {
  const int super = (y >> 4) * 4 + (x >> 4);
  const int micro = ((y >> 2) & 3) * 4 + ((x >> 2) & 3);
  return (super * kSupers + micro) * kLanes + (y & 3) * 4 + (x & 3);
}

/// Position of a column in its tile, from its lane_index.
struct ColumnInTile {
  int x, y;
};
constexpr ColumnInTile column_in_tile(int index) {
  const int super = index >> 8, micro = (index >> 4) & 15, lane = index & 15;
  return {(super & 3) * 16 + (micro & 3) * 4 + (lane & 3),
          (super >> 2) * 16 + (micro >> 2) * 4 + (lane >> 2)};
}

/// The part of an interval above the gap where a sweep has split it.
struct Remnant {
  int lane = 0;
  Real low = 0, high = 0;
  std::uint32_t low_step = 0, high_step = 0;
};

/// Column and row in its tile of a micro's first column.
constexpr int column_of(int micro) { return (micro >> 4 & 3) * 16 + (micro & 3) * 4; }
constexpr int row_of(int micro) { return (micro >> 6) * 16 + (micro >> 2 & 3) * 4; }

struct Tile {
  /// All columns full up to `height`; columns beyond `columns_x` and `columns_y` do not exist.
  Tile(Real height, int columns_x, int columns_y, std::shared_ptr<SlotPages> memory);
  /// The columns of the first micros full; the others have no material and must not be used.
  Tile(Real height, int micros, std::shared_ptr<SlotPages> memory);

  Lanes top[kMicros];  // top of the interval at the floor, 0 where there is none
  alignas(64) std::uint32_t top_step[kMicros][kLanes];
  alignas(64) Real micro_top[kMicros];  // highest and lowest material of each micro
  alignas(64) Real micro_bottom[kMicros];
  alignas(64) Real super_top[kSupers];
  alignas(64) Real super_bottom[kSupers];
  std::int32_t chain[kMicros];  // first slot of the intervals above it, or -1
  Slots slots;
  std::int32_t free_slot = -1;  // first slot of the free list
  bool was_undercut = false;    // the tile has had a chain at some time

  /// Frees the chain of a micro whose slots are all empty.
  void drop_chain(int micro);
  /// Adds an empty slot to the end of a micro's chain.
  Slot& add_slot(int micro);
  /// Stores an interval above an undercut in the first slot that is empty in its column.
  void store_remnant(int micro, const Remnant& rest);
  /// Releases memory if many slots are free: while an undercutting tool passes, columns have a slot for a
  /// moment; after it only some keep one.
  void pack_slots();
  /// Prefetches the memory that `lengths` will read of a micro, if the micro exists.
  void fetch(int micro) const {
    if (micro >= kMicros || chain[micro] < 0) return;
    const Slot& slot = slots[chain[micro]];
    __builtin_prefetch(&slot.low);
    __builtin_prefetch(&slot.high);
  }
  /// Length of material of each column of a micro.
  void lengths(int micro, Lanes& out) const;
  /// Appends the intervals of a column, lowest first.
  void intervals(int index, std::vector<Interval>& out) const;
  /// The numbers of the steps (see Workpiece::Body::step) that ended the intervals of an empty column; one
  /// per slot.
  void cut_through(int index, std::vector<std::uint32_t>& out) const;
};

}  // namespace kerf::sim

namespace kerf {

/// The data of a Workpiece.
struct Workpiece::Body {
  Body(const Box3& bounds, double pitch);

  Box3 bounds;
  double pitch = 0.0;
  int nx = 0, ny = 0;
  int tiles_x = 0, tiles_y = 0;
  sim::Real height = 0.0f;
  /// Interval ends closer than this are the same height, mm; above the rounding of single precision.
  sim::Real same_height = 0.0f;
  /// Correction of the volume for columns at walls, mm3; see walls.h.
  double wall_volume = 0.0;
  /// Null, or the step of each number that the tiles store as a step. It allows a toolpath to be edited
  /// without changes to tiles that the edit does not touch.
  std::shared_ptr<const std::vector<std::uint32_t>> step_of;
  /// The initial columns; null if the block is full. Tiles that are not full exist from the start.
  std::shared_ptr<const ColumnRuns> start;
  std::shared_ptr<sim::SlotPages> slot_pages = std::make_shared<sim::SlotPages>();
  /// A tile is null until it is first touched.
  sim::BlockStore<sim::Tile> store;
  std::vector<sim::BlockStore<sim::Tile>::Pointer> tiles;

  std::uint32_t step(std::uint32_t number) const {
    return step_of && number != kStockSurface ? (*step_of)[number] : number;
  }
  /// Appends the intervals of a column of a tile, lowest first, with their steps.
  void intervals(const sim::Tile& tile, int index, std::vector<Interval>& out) const;
  /// The step that removed the last material of a column without any; kStockSurface if it never had any.
  std::uint32_t cut_through(const sim::Tile& tile, int index) const;
  sim::Tile& touch(std::size_t tile);
  /// Resets a touched tile to its state before the first cut.
  void restore(std::size_t tile);
  int columns_x_of(std::size_t tile) const;
  int columns_y_of(std::size_t tile) const;
  /// The centre of column i (of row j), mm from the low side of the block: the centre of the part of the
  /// column inside the block.
  double column_x(int i) const;
  double column_y(int j) const;
  /// Fraction of column i (of row j) inside the block.
  double fraction_x(int i) const;
  double fraction_y(int j) const;
};

}  // namespace kerf
