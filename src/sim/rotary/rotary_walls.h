// Cells around rays in which the surface has edges or walls: their volume is the mean over several rays.
//
// A cell is as long as the distance of rays along the bar and as wide as that around it. Where the surface is
// straight its ray has the mean of the cell, but rays find a wall only to half a distance. After cutting,
// all motions cut a lattice of rays in these cells, and the ray of the cell again with a negative weight, so
// that volumes of steps are corrected too. The rays of the workpiece stay as they are.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/dexel/wall_lattice.h"
#include "sim/rotary/rotary_slab.h"

namespace kerf::sim {

class RotaryWalls {
 public:
  explicit RotaryWalls(const RotaryWorkpiece& work);

  bool empty() const { return cells_.empty(); }
  /// Cuts the cells with `first` to `last` along the bar. Returns the volume that their rays lack, mm3.
  double cut(int first, int last, const std::vector<RotaryMotion>& motions,
             const std::vector<RotaryTool>& tools, double hazard_depth, SlabResult& result) const;

 private:
  struct Cell {
    int i, j;
  };
  bool is_wall(int i, int j) const;
  const std::vector<Interval>& runs(int i, int j) const;

  const RotaryWorkpiece& work_;
  std::vector<Cell> cells_;  // by i, then j
};

}  // namespace kerf::sim
