// How far a place is from what a tool sweeps: what exact meshes are computed from, in double precision.
#pragma once

#include "sim/sweep.h"
#include "sim/tool_distance.h"

namespace kerf::sim {

/// Distance to a solid, mm, negative inside, and the direction in which it grows.
struct Distance {
  double value = 1e30;
  Point3 gradient;
};

/// Of a place, in the sweeps' frame, to what the tool takes away along a sweep. Places further than `reach`
/// may be said to be far away (1e30), and distances that are not below `enough` need not be exact.
Distance distance_to(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach,
                     double enough = 1e30);

/// The place of a sweep's path that is nearest, both seen from above.
Point2 nearest_in_plan(const Sweep& sweep, Point2 place);

/// Whether a sweep stays at one height. Of several of one tool at one height the one that is nearest in plan
/// is nearest.
inline bool is_level(const Sweep& sweep) { return sweep.is_arc || sweep.z == sweep.z_end; }
/// distance_to of a level sweep at height `z` whose path is nearest at `nearest`.
Distance distance_to_level(const ToolDistance& tool, Point2 nearest, double z, Point3 place);

/// Bounds of distance_to for the time of one look at the tool; `low` is not above what distance_to tells,
/// `high` not below it.
struct DistanceBounds {
  double low = 1e30, high = 1e30;
};
DistanceBounds bounds_of_distance(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach);

}  // namespace kerf::sim
