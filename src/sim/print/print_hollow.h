// The empty height under material: how much of it there is, layer by layer, and which part is shut in.
#pragma once

#include <vector>

#include "kerf/print.h"

namespace kerf::printing {

/// Fills in `hollow` and `enclosed` of every layer (lowest first), and of `total`. `touch`: heights no
/// farther apart are one. False if stopped.
bool measure_hollow(const ColumnGrid& grid, double touch, std::vector<PrintLayer>& layers,
                    PrintVolumes& total, Progress* progress);

}  // namespace kerf::printing
