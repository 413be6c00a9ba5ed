// The columns of a workpiece that does not begin as a full block: see StockBody.
#pragma once

#include "sim/dexel/tile.h"

#include "kerf/progress.h"

namespace kerf::sim {

/// Gives the workpiece the material that the body has on its columns. False with an error appended where the
/// body cannot tell, and false without one if stopped.
bool fill_from_body(Workpiece::Body& body, const StockBody& from, Diagnostics& diagnostics,
                    Progress* progress);

/// Puts what the body tells of a tile into one that is full; nothing to do where the block begins full.
void fill_start_tile(const Workpiece::Body& body, std::size_t number, Tile& tile);
/// Puts the material that column (i, j) begins with into one lane of a micro, which is as made until then.
void put_start_column(const Workpiece::Body& body, int i, int j, Tile& tile, int micro, int lane);
/// Sets the bounds that culling needs from what the columns of the first micros hold.
void refresh_bounds(Tile& tile, int micros = kMicros);

}  // namespace kerf::sim
