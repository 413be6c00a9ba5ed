// A sweep in single precision in the frame of one tile: the origin lies on the path near the tile, so that
// positions are exact to 0.01 um on a stock of any size.
#pragma once

#include "sim/kernel/kernels.h"

namespace kerf::sim {

/// A sweep in the frame of a tile, see the top of this file. `slope` is 0 for level sweeps and plunges, which
/// lie between z_low and z_high; other lines have z at the origin.
struct LocalSweep {
  bool is_arc = false;
  Real x = 0, y = 0;           // of the tile's first column
  Real cx = 1, cy = 0;         // direction of a line in plan
  Real t_low = 0, t_high = 0;  // its extent along that direction
  Real slope = 0, z = 0;
  Real ball_lead = 0;          // slope / sqrt(1 + slope^2)
  Real z_low = 0, z_high = 0;  // of the whole sweep
  bool level_follow = false;   // a level line that starts where the previous sweep ended
  Real behind = -kFar;         // everything before this u of a line was cut by the previous sweep

  // Of an arc, whose centre is the origin.
  Real radius = 0;
  Real box_low_x = 0, box_high_x = 0, box_low_y = 0, box_high_y = 0;
  Real start_x = 0, start_y = 0, end_x = 0, end_y = 0;  // its ends
  bool wide = false, full = false;                      // a sweep of more than 180 degrees, of 360 degrees
};

/// Sets all but `behind` and `level_follow`, which depend on the solid.
void set_local_sweep(const Sweep& sweep, const TileJob& job, LocalSweep& view);

/// Whether columns that the previous sweep has cut may be skipped.
enum class Follow : std::uint8_t { no, yes };
/// Prepares a view for a pass with one solid: sets what need not be examined because the previous sweep has
/// cut it. `open`: the solid reaches above the block along the whole sweep.
void prepare_for(LocalSweep& view, const Sweep& sweep, const LaneSolid& solid, Follow follow, bool open);

inline Real lower_real(Real a, Real b) { return a < b ? a : b; }
inline Real higher_real(Real a, Real b) { return a > b ? a : b; }

}  // namespace kerf::sim
