// Parallel lines inside a region: the paths of a zigzag.
#pragma once

#include <vector>

#include "kerf/geom/region.h"

namespace kerf::op_detail {

struct HatchLine {
  Point2 from, to;
  std::size_t row = 0;
};
/// The parts inside the region of lines at `angle` with `spacing`, by row; each in the direction of the
/// angle. The first and the last row are at most half the spacing from the ends of the region.
std::vector<HatchLine> hatch(const Region& region, Angle angle, Length spacing, std::size_t max_lines);

}  // namespace kerf::op_detail
