// Signed distance of a query point to the volume that a tool sweeps, in double precision.
//
// It is the minimum over the path of the distance to the tool at that position (tool_distance.h). For level
// sweeps and arcs the minimum is at the point of the path that is nearest in plan; for slopes and plunges it
// is searched for along the path.
#pragma once

#include "sim/exact/tool_distance.h"
#include "sim/sweep/sweep.h"

namespace kerf::sim {

/// The distance where no sweep is within reach, mm.
inline constexpr double kOutOfReach = 1e30;

/// Signed distance to a solid, mm, negative inside, and its gradient.
struct Distance {
  double value = kOutOfReach;
  Point3 gradient;
};

/// The point of a sweep's path that is nearest in plan.
Point2 nearest_in_plan(const Sweep& sweep, Point2 point);

/// Whether a sweep has a constant Z. Of several level sweeps with one tool at one Z, the one that is nearest
/// in plan is the nearest.
inline bool is_level(const Sweep& sweep) { return sweep.is_arc || sweep.z == sweep.z_end; }
/// Distance of a point (block frame) to the volume swept at height `z` by a path whose nearest point in plan
/// is `nearest`.
Distance distance_to_level(const ToolDistance& tool, Point2 nearest, double z, Point3 point);

/// The distance to a sweep that is not level, and the path parameter t of its minimum: mm along the path in
/// plan; for a plunge the Z of the tip.
struct PathDistance {
  Distance distance;
  double t = 0.0;
};
/// The result may be kOutOfReach if the distance exceeds `reach`, and need not be exact if it is not below
/// `enough`.
PathDistance distance_along(const Sweep& sweep, const ToolDistance& tool, Point3 point, double reach,
                            double enough = kOutOfReach);
/// The same, starting the search from `known`, the result for the point at `point - moved`.
PathDistance distance_beside(const Sweep& sweep, const ToolDistance& tool, Point3 point, double reach,
                             const PathDistance& known, Point3 moved, double enough = kOutOfReach);

/// Lower and upper bound of that distance, from a single evaluation of the distance to the tool.
struct DistanceBounds {
  double low = kOutOfReach, high = kOutOfReach;
};
DistanceBounds bounds_of_distance(const Sweep& sweep, const ToolDistance& tool, Point3 point, double reach);

}  // namespace kerf::sim
