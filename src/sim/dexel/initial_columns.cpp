// Copies the columns of a stock body into tiles.
#include "sim/dexel/initial_columns.h"

#include <algorithm>

namespace kerf::sim {
namespace {

/// A run clipped to the block. Ends within `same_height` of a face of the block are moved onto it.
Run within_block(const Run& run, const Workpiece::Body& body) {
  Run out{std::max(run.low, 0.0f), std::min(run.high, body.height)};
  if (out.low <= body.same_height) out.low = 0.0f;
  if (out.high >= body.height - body.same_height) out.high = body.height;
  return out;
}

/// Stores the runs of a column in one lane of a micro that is still in its initial state.
void put_column(std::span<const Run> runs, const Workpiece::Body& body, Tile& tile, int micro, int lane) {
  tile.top[micro][lane] = 0.0f;
  for (const Run& original : runs) {
    const Run run = within_block(original, body);
    if (!(run.high > run.low)) continue;
    if (run.low == 0.0f) {
      tile.top[micro][lane] = run.high;
    } else {
      tile.store_remnant(micro, {lane, run.low, run.high, kStockSurface, kStockSurface});
    }
  }
}

bool is_full(const Workpiece::Body& body, int column, int row, int columns, int rows) {
  for (int j = row; j < row + rows; ++j) {
    for (int i = column; i < column + columns; ++i) {
      const auto runs = body.start->column(i, j);
      if (runs.size() != 1 || within_block(runs[0], body) != Run{0.0f, body.height}) return false;
    }
  }
  return true;
}

}  // namespace

void refresh_bounds(Tile& tile, int micros) {
  for (int micro = 0; micro < micros; ++micro) {
    const Real* high = std::max_element(tile.top[micro].v, tile.top[micro].v + kLanes);
    Real highest = *high, lowest = *high > 0.0f ? 0.0f : kFar;
    for (std::int32_t k = tile.chain[micro]; k >= 0; k = tile.slots.next(k)) {
      const Slot& slot = tile.slots[k];
      for (int lane = 0; lane < kLanes; ++lane) {
        highest = std::max(highest, slot.high[lane]);
        lowest = std::min(lowest, slot.low[lane]);
      }
    }
    tile.micro_top[micro] = highest;
    tile.micro_bottom[micro] = lowest;
  }
  for (int super = 0; super < kSupers; ++super) {
    const int first = super * kSupers, last = first + kSupers;
    tile.super_top[super] = *std::max_element(tile.micro_top + first, tile.micro_top + last);
    tile.super_bottom[super] = *std::min_element(tile.micro_bottom + first, tile.micro_bottom + last);
  }
}

void put_start_column(const Workpiece::Body& body, int i, int j, Tile& tile, int micro, int lane) {
  put_column(body.start->column(i, j), body, tile, micro, lane);
}

void fill_start_tile(const Workpiece::Body& body, std::size_t number, Tile& tile) {
  if (!body.start) return;
  const int columns = body.columns_x_of(number), rows = body.columns_y_of(number);
  const auto tiles_x = static_cast<std::size_t>(body.tiles_x);
  const int column = static_cast<int>(number % tiles_x) * kTileColumns;
  const int row = static_cast<int>(number / tiles_x) * kTileColumns;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const int index = lane_index(x, y);
      put_column(body.start->column(column + x, row + y), body, tile, index / kLanes, index % kLanes);
    }
  }
  refresh_bounds(tile);
}

bool fill_from_body(Workpiece::Body& body, const StockBody& from, Diagnostics& diagnostics,
                    Progress* progress) {
  const Point3 low = body.bounds.low;
  const ColumnPositions positions{
      low.x + 0.5 * body.pitch, low.y + 0.5 * body.pitch, low.z, body.pitch, body.nx, body.ny,
      body.bounds.high.x,       body.bounds.high.y};
  auto columns = from.columns(positions, diagnostics, progress);
  if (!columns) return false;
  body.start = std::make_shared<const ColumnRuns>(std::move(*columns));
  const auto tiles_x = static_cast<std::size_t>(body.tiles_x);
  for (std::size_t tile = 0; tile < body.tiles.size(); ++tile) {
    const int column = static_cast<int>(tile % tiles_x) * kTileColumns;
    const int row = static_cast<int>(tile / tiles_x) * kTileColumns;
    if (!is_full(body, column, row, body.columns_x_of(tile), body.columns_y_of(tile)))
      fill_start_tile(body, tile, body.touch(tile));
  }
  return true;
}

}  // namespace kerf::sim

namespace kerf {

LeftColumns left_columns(const Workpiece& workpiece) {
  const Point3 low = workpiece.bounds().low;
  const double pitch = workpiece.pitch().mm();
  const ColumnGrid grid = workpiece.grid();
  LeftColumns left;
  left.bounds = workpiece.bounds();
  left.positions = {low.x + 0.5 * pitch, low.y + 0.5 * pitch, low.z, pitch, grid.nx, grid.ny};
  left.columns.nx = grid.nx;
  left.columns.ny = grid.ny;
  left.columns.first = grid.first;
  left.columns.runs.reserve(grid.intervals.size());
  for (const Interval& run : grid.intervals) left.columns.runs.push_back({run.low, run.high});
  return left;
}

}  // namespace kerf
