// How far a place is from what a tool sweeps: what exact meshes are computed from, in double precision.
#pragma once

#include "sim/exact/tool_distance.h"
#include "sim/sweep/sweep.h"

namespace kerf::sim {

/// Nothing is so far away.
inline constexpr double kNowhere = 1e30;

/// Distance to a solid, mm, negative inside, and the direction in which it grows.
struct Distance {
  double value = kNowhere;
  Point3 gradient;
};

/// The place of a sweep's path that is nearest, both seen from above.
Point2 nearest_in_plan(const Sweep& sweep, Point2 place);

/// Whether a sweep stays at one height. Of several of one tool at one height the one that is nearest in plan
/// is nearest.
inline bool is_level(const Sweep& sweep) { return sweep.is_arc || sweep.z == sweep.z_end; }
/// Of a place, in the sweeps' frame, to what a tool takes away along a level sweep at height `z` whose path
/// is nearest at `nearest`.
Distance distance_to_level(const ToolDistance& tool, Point2 nearest, double z, Point3 place);

/// The distance to what a tool takes away along a sweep that is not level, and where the tool then is: mm
/// along the path in plan, or of a plunge the height.
struct Nearest {
  Distance distance;
  double where = 0.0;
};
/// Places further than `reach` may be said to be nowhere, and distances that are not below `enough` need not
/// be exact.
Nearest nearest_along(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach,
                      double enough = kNowhere);
/// The same for a place beside another one, `moved` from it, for which it is known already.
Nearest nearest_beside(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach,
                       const Nearest& known, Point3 moved, double enough = kNowhere);

/// Bounds of that distance for the time of one look at the tool.
struct DistanceBounds {
  double low = kNowhere, high = kNowhere;
};
DistanceBounds bounds_of_distance(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach);

}  // namespace kerf::sim
