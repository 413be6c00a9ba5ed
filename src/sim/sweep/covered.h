// Turns of helices that later turns cover.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/sweep/survey.h"

#include "kerf/path/toolpath.h"

namespace kerf::sim {

/// The arcs, sorted, that leave no trace: a later arc over the same points in XY is as deep everywhere, its
/// tool is the same, and between the two there are cuts of that tool only, which touch the stock with their
/// flutes alone. `height`: of the stock, mm; no cut may go below it.
std::vector<std::size_t> covered_arcs(const Toolpath& path, const Survey& survey, double height);

}  // namespace kerf::sim
