// Passes beside a path over its whole length, also where it crosses or comes near to itself.
#pragma once

#include "kerf/geom/outline.h"

namespace kerf::op_detail {

/// The other passes of the same slot: their distance from each other, and the radius of the tool.
struct NextPasses {
  double step = 0.0, radius = 0.0;  // mm
};

/// One line from beside the start of `path` to beside its end, at the distance `to_left` (mm, below 0: to the
/// right): around outer corners by arcs, up to where neighbours intersect at inner ones. Unlike the curve of
/// offset_path it is never in parts. No point of it is farther from the path than that distance; with the
/// passes before it, discs on it cover all that is near to the path on this side.
Outline beside(const Outline& path, double to_left, NextPasses passes, double weld);

}  // namespace kerf::op_detail
