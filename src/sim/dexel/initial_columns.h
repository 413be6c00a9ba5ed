// The initial columns of a workpiece whose stock is not a full block; see StockBody.
#pragma once

#include "sim/dexel/tile.h"

#include "kerf/base/progress.h"

namespace kerf::sim {

/// Fills the columns of the workpiece with the material of the body. False with an error appended if the body
/// has no valid columns, and false without one if stopped.
bool fill_from_body(Workpiece::Body& body, const StockBody& from, Diagnostics& diagnostics,
                    Progress* progress);

/// Stores the initial columns of a tile; the tile must be full. Without a body there is nothing to do.
void fill_start_tile(const Workpiece::Body& body, std::size_t number, Tile& tile);
/// Stores the initial material of column (i, j) in one lane of a micro that is still in its initial state.
void put_start_column(const Workpiece::Body& body, int i, int j, Tile& tile, int micro, int lane);
/// Recomputes the bounds used for culling from the columns of the first micros.
void refresh_bounds(Tile& tile, int micros = kMicros);

}  // namespace kerf::sim
