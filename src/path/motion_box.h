// Bounds of one motion, shared by the report, the check and the assumed stock.
#pragma once

#include "kerf/path/toolpath.h"

namespace kerf::detail {

/// All points of a straight motion or arc that starts at `from`. Axes of the start point that are unknown
/// (`unknown_from`, see Step::unknown_axes) count as those of its end.
inline Box3 bounds_of(const Step& s, Point3 from, unsigned unknown_from) {
  Box3 box;
  box.add(s.to());
  if (s.kind() == StepKind::arc) box.add(walk_of(s, from).bounds());
  for (int axis = 0; axis < 3; ++axis)
    if ((unknown_from >> axis & 1u) != 0) from[axis] = s.to()[axis];
  box.add(from);
  return box;
}

}  // namespace kerf::detail
