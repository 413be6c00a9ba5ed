// The distance of the columns: as given, or chosen by the stock, the tools and where they cut.
#pragma once

#include <optional>

#include "sim/sweep/survey.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/stock/stock.h"

namespace kerf::sim {

/// The column pitch, mm; nothing, with an error appended, if it is invalid. Without a resolution it follows
/// from the stock's size; where a tool cuts narrower than some columns it is finer, as far as the columns of
/// the tiles that are cut and those of the whole stock stay within bounds.
std::optional<double> choose_pitch(const Toolpath& path, const Survey& survey,
                                   const SimulationOptions& options, const Stock& stock,
                                   Diagnostics& diagnostics);

}  // namespace kerf::sim
