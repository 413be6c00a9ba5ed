// The workpiece's inside: tiles of 64 x 64 columns, each tile 4 x 4 supers of 4 x 4 micros of 4 x 4 columns.
//
// The 16 columns of a micro are one row of lanes, so that kernels work on 16 neighbours at a time. Of each
// column the run of material that stands on the floor is kept as its top; most have no other. What floats
// above undercuts is in a chain of slots, each with one interval a column, which is as long as needed.
// Heights are mm above the block's floor, single precision.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/dexel/blocks.h"
#include "sim/dexel/slots.h"

#include "kerf/workpiece.h"

namespace kerf::sim {

inline constexpr int kMicros = 256;      // micros of a tile
inline constexpr int kSupers = 16;       // supers of a tile, and micros of a super
inline constexpr int kTileColumns = 64;  // columns along a tile's edge
inline constexpr Real kFar = 1e30f;      // stands for "no material here", safe to calculate with

/// Number of a column in its tile's arrays, from its place in the tile.
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

/// What is left above the gap in an interval that a sweep has split.
struct Remnant {
  int lane = 0;
  Real low = 0, high = 0;
  std::uint32_t low_step = 0, high_step = 0;
};

/// Column and row in its tile of a micro's first column.
constexpr int column_of(int micro) { return (micro >> 4 & 3) * 16 + (micro & 3) * 4; }
constexpr int row_of(int micro) { return (micro >> 6) * 16 + (micro >> 2 & 3) * 4; }

struct Tile {
  /// All columns full up to `height`, but for those beyond `columns_x` and `columns_y`, which do not exist.
  Tile(Real height, int columns_x, int columns_y, std::shared_ptr<SlotPages> memory);
  /// The columns of the first micros full; the others are never to be met.
  Tile(Real height, int micros, std::shared_ptr<SlotPages> memory);

  Lanes top[kMicros];  // of what stands on the floor, 0 where nothing does
  alignas(64) std::uint32_t top_step[kMicros][kLanes];
  alignas(64) Real micro_top[kMicros];  // highest and lowest material of each micro
  alignas(64) Real micro_bottom[kMicros];
  alignas(64) Real super_top[kSupers];
  alignas(64) Real super_bottom[kSupers];
  std::int32_t chain[kMicros];  // first slot of what floats, or -1
  Slots slots;
  std::int32_t free_slot = -1;  // first of those that no chain has any more
  bool was_undercut = false;    // something has floated, if only for a moment

  /// Frees the slots of a micro in which nothing floats any more.
  void drop_chain(int micro);
  /// Adds an empty slot to the end of a micro's chain.
  Slot& add_slot(int micro);
  /// Puts an interval that floats into a free place of its column.
  void store_remnant(int micro, const Remnant& rest);
  /// Gives memory back if many slots are in no chain: in front of an undercutting tool all columns float for
  /// a moment, behind it only some.
  void pack_slots();
  /// Asks for the memory that `lengths` will read of a micro, if there is such a micro.
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
  /// The steps (see Workpiece::Body::step_of) that took material of a column without any last, one a slot.
  void cut_through(int index, std::vector<std::uint32_t>& out) const;
};

}  // namespace kerf::sim

namespace kerf {

/// What is behind Workpiece.
struct Workpiece::Body {
  Body(const Box3& bounds, double pitch);

  Box3 bounds;
  double pitch = 0.0;
  int nx = 0, ny = 0;
  int tiles_x = 0, tiles_y = 0;
  sim::Real height = 0.0f;
  /// Ends of intervals nearer than this are taken as the same height, mm: beyond what single precision tells
  /// apart.
  sim::Real same_height = 0.0f;
  /// What the columns at walls hold more (or less) than their centres say, mm3; see walls.h.
  double wall_volume = 0.0;
  /// Null, or which step each number that the tiles keep as a step stands for. Lets a toolpath be edited
  /// without a change to tiles that the edit does not touch.
  std::shared_ptr<const std::vector<std::uint32_t>> step_of;
  /// What the columns begin with; nothing where the block begins full. Tiles that begin otherwise exist from
  /// the start.
  std::shared_ptr<const ColumnRuns> start;
  std::shared_ptr<sim::SlotPages> slot_pages = std::make_shared<sim::SlotPages>();
  /// Tiles that nothing has touched yet do not exist.
  sim::BlockStore<sim::Tile> store;
  std::vector<sim::BlockStore<sim::Tile>::Pointer> tiles;

  std::uint32_t step(std::uint32_t number) const {
    return step_of && number != kStockSurface ? (*step_of)[number] : number;
  }
  /// Appends the intervals of a column of a tile, lowest first, with their steps.
  void intervals(const sim::Tile& tile, int index, std::vector<Interval>& out) const;
  /// The step that took the last material of a column without any; kStockSurface if there never was any.
  std::uint32_t cut_through(const sim::Tile& tile, int index) const;
  sim::Tile& touch(std::size_t tile);
  /// Makes a touched tile what it was before the first cut.
  void restore(std::size_t tile);
  int columns_x_of(std::size_t tile) const;
  int columns_y_of(std::size_t tile) const;
  /// Where column i (of row j) stands, mm from the block's low side: in the middle of its part in the block.
  double place_x(int i) const;
  double place_y(int j) const;
  /// Share of column i (of row j) that lies in the block, 0 to 1.
  double share_x(int i) const;
  double share_y(int j) const;
};

}  // namespace kerf
