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
/// may be said to be far away (1e30).
Distance distance_to(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach);

/// From a place to a sweep's path, both seen from above, mm.
double distance_in_plan(const Sweep& sweep, Point2 place);

/// Bounds of distance_to for the time of one look at the tool; `low` is not above what distance_to tells,
/// `high` not below it.
struct DistanceBounds {
  double low = 1e30, high = 1e30;
};
DistanceBounds bounds_of_distance(const Sweep& sweep, const ToolDistance& tool, Point3 place, double reach);

}  // namespace kerf::sim
