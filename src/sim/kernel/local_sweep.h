// A sweep as one tile sees it, in single precision: the origin lies on the path near the tile, so that
// numbers are good for a hundredth of a micron on a stock of any size.
#pragma once

#include "sim/kernel/kernels.h"

namespace kerf::sim {

/// A sweep in the frame of a tile's work, see the top of this file. `slope` is 0 for level sweeps and
/// plunges, which then lie between z_low and z_high; lines that are neither have z at the origin.
struct LocalSweep {
  bool is_arc = false;
  Real x = 0, y = 0;           // of the tile's first column
  Real cx = 1, cy = 0;         // direction of a line in plan
  Real t_low = 0, t_high = 0;  // its extent along that direction
  Real slope = 0, z = 0;
  Real ball_lead = 0;          // slope / sqrt(1 + slope^2)
  Real z_low = 0, z_high = 0;  // of the whole sweep
  bool level_follow = false;   // a level line that starts where the previous sweep ended
  Real behind = -kFar;         // what lies before this along a line was cut by the sweep before

  // Of an arc, whose centre is the origin.
  Real radius = 0;
  Real box_low_x = 0, box_high_x = 0, box_low_y = 0, box_high_y = 0;
  Real start_x = 0, start_y = 0, end_x = 0, end_y = 0;  // its ends
  bool wide = false, full = false;                      // it turns more than half, all the way
};

/// Fills in all but `behind` and `level_follow`, which depend on the solid.
void set_local_sweep(const Sweep& sweep, const TileJob& job, LocalSweep& view);

/// Whether what the sweep before has cut may be left out.
enum class Follow : std::uint8_t { no, yes };
/// Prepares a view for a pass with one solid: what need not be examined because the previous sweep has cut
/// it. `open`: the solid reaches above the block all along.
void prepare_for(LocalSweep& view, const Sweep& sweep, const LaneSolid& solid, Follow follow, bool open);

inline Real lower_real(Real a, Real b) { return a < b ? a : b; }
inline Real higher_real(Real a, Real b) { return a > b ? a : b; }

}  // namespace kerf::sim
