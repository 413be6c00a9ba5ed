// The space below material: its height by layer, and the part that is enclosed.
#pragma once

#include <vector>

#include "kerf/sim/print.h"

namespace kerf::printing {

/// Sets `hollow` and `enclosed` of every layer (lowest first), and of `total`. `touch`: gaps up to this
/// height are none. False if stopped.
bool measure_hollow(const ColumnGrid& grid, double touch, std::vector<PrintLayer>& layers,
                    PrintVolumes& total, Progress* progress);

}  // namespace kerf::printing
