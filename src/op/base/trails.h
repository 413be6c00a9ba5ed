// Paths of three dimensions that branch: their order as few trails from end to end, and their passes.
#pragma once

#include <cstdint>
#include <vector>

#include "op/base/cutter.h"

namespace kerf::op_detail {

/// A part of the paths between two nodes; a single point is a hole.
struct TrailEdge {
  std::uint32_t from = 0, to = 0;  ///< nodes; edges with a common node are connected there
  std::vector<Point3> points;
};

/// Without points that are within `tolerance` of the chords between those that are left.
std::vector<Point3> simplified(const std::vector<Point3>& points, double tolerance);

/// With points where the path crosses one of the levels.
std::vector<Point3> with_crossings(const std::vector<Point3>& path, const std::vector<double>& levels);
/// The parts of a path that go below `before`, a level that it has points on where it crosses it.
std::vector<std::vector<Point3>> runs_below(const std::vector<Point3>& path, double before);
/// From above the first point into the material, which was removed down to `cleared` there, and along all of
/// them, no deeper than `level`.
void cut_points(Cutter& cutter, const std::vector<Point3>& points, double level, double cleared,
                const CutOptions& options);

/// Cuts all edges, each once; connected ones one after the other. With a stepdown, each trail is cut in
/// passes, the later ones only where it is deeper. Rapids between connected trails are just above the
/// surface, others on the retract plane.
void cut_trails(Cutter& cutter, const std::vector<TrailEdge>& edges, const CutOptions& options);

}  // namespace kerf::op_detail
