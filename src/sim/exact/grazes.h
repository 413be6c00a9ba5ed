// Contacts between the columns of a simulation: rapids, necks, shanks and holders that graze the sides of the
// block or walls that earlier cuts left, by less than half a column.
#pragma once

#include <cstddef>
#include <vector>

#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/sim/simulate.h"
#include "kerf/sim/simulation_options.h"

namespace kerf {

struct GrazeOptions {
  /// Shallower contacts sideways are not reported.
  Length depth = default_tolerance::kGrazeDepth;
  /// Maximum spacing of the examined positions along a motion.
  Length spacing = mm(0.5);
  /// Maximum number of distances that are computed, and of sweeps that are kept; the search ends there.
  std::size_t max_distances = 20'000'000, max_sweeps = 2'000'000;
};

/// Examines points on the surface of the tool along each motion in the block against the exact volumes that
/// all sweeps before it removed, and the edges of the block. Returns at most one hazard per step and kind, in
/// the order of steps, without those that the simulation has found; `removed` is 0. For a block only: of
/// stock that is a body or left over, nothing is returned.
std::vector<Hazard> find_grazes(const Simulation& simulation, const GrazeOptions& options = {},
                                Progress* progress = nullptr);

}  // namespace kerf
