// Surfaces that are known as a height above each point: rows along X in which a tool touches them.
//
//   const HeightFunction dome = [](Point2 p) { return 10 - 0.01 * dot(p, p); };
//   const auto rows = surface_rows(dome, tool, {.low = {-20, -20}, .high = {20, 20}}, diagnostics);
//
// The tool is nowhere below the surface, as far as samples at a tenth of its radius show it. Frame: work
// coordinates, mm, Z up. Errors: options out of range (op_option), too many samples (op_limit).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/geom/geometry.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// Z above a point; a value that is not finite: there is none.
using HeightFunction = std::function<double(Point2)>;

struct SurfaceRowOptions {
  Point2 low, high;                   ///< the rectangle in which the axis of the tool moves
  double stepover = 0.1;              ///< distance of rows as a fraction of the tool's diameter, (0, 1]
  Length simplification = mm(0.005);  ///< points that deviate by less from a straight line are left out
  Origin where{};
  Progress* progress = nullptr;  ///< may stop the work: then there is no value, and no error
};

/// Positions of the tip, row by row in alternating directions, the first one from the lower left corner.
std::optional<std::vector<std::vector<Point3>>> surface_rows(const HeightFunction& surface, const Tool& tool,
                                                             const SurfaceRowOptions& options,
                                                             Diagnostics& diagnostics);

}  // namespace kerf
