// The hazards of a laser's beam: on during a rapid, on while X and Y do not move, left on at the end.
#pragma once

#include <vector>

#include "kerf/path/check.h"

namespace kerf {

/// The hazards in the order of steps; none for a path without laser power. Without a machine in the options
/// the beam of M3 is judged as on during rapids and dwells, that of M4 as off: GRBL runs neither during
/// rapids in laser mode, and both without it.
std::vector<PathHazard> check_beam(const Toolpath& path, const CheckOptions& options);

}  // namespace kerf
