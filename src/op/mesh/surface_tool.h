// A tool that touches a surface from above, as its height above the tip by the distance from the axis: a
// flat, a quarter or less of a circle, and a cone. The height is convex, so that the contact with a facet or
// an edge is the maximum of a concave function.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "kerf/geom/geometry.h"
#include "kerf/tool/tool.h"

namespace kerf::op_detail {

struct SurfaceTool {
  double flat = 0.0;      ///< mm, radius of the flat end
  double corner = 0.0;    ///< mm, radius of the circle that follows it; 0: none
  double edge = 0.0;      ///< mm, distance from the axis where the circle ends
  double edge_z = 0.0;    ///< mm, height there
  double edge_slope = 0;  ///< of the circle where it ends; infinite after a quarter
  double cone = 0.0;      ///< slope of the cone from there to `radius`; 0: none
  double radius = 0.0;    ///< mm; above it the tool is a cylinder

  /// mm above the tip, of a point `r` from the axis, 0 <= r <= radius.
  double height(double r) const {
    if (r <= flat) return 0.0;
    if (r > edge) return edge_z + cone * (std::min(r, radius) - edge);
    const double inward = std::min(r - flat, corner);
    return corner - std::sqrt((corner - inward) * (corner + inward));
  }
  /// A distance from the axis where the profile touches a plane of this slope, >= 0.
  double contact(double slope) const;
};

/// Nothing for a tool that cannot touch a surface from above with its cutting part alone, such as one with a
/// concave profile.
std::optional<SurfaceTool> surface_tool(const Tool& tool);

/// The tool larger by a distance on all sides: what touches a surface where `tool` keeps that distance from
/// it. Its tip is as much lower.
SurfaceTool grown(const SurfaceTool& tool, double by);

/// The height of the tip above the axis position 0, 0 where the tool touches the line from `a` to `b`;
/// -infinity where it does not reach it.
double touch_line(const SurfaceTool& tool, Point3 a, Point3 b);

}  // namespace kerf::op_detail
