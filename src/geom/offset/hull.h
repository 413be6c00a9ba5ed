// Convex hulls and Minkowski sums of regions, as OpenSCAD has them. Arcs of a hull stay arcs.
//
// Frame, units, tolerance and errors as in region.h.
#pragma once

#include <optional>
#include <vector>

#include "kerf/geom/region.h"

namespace kerf {

/// The smallest convex region around all regions: of two circles, the slot between them. Straight lines that
/// are tangent to an arc end exactly where they touch it.
std::optional<Region> convex_hull(const std::vector<Region>& regions, const RegionOptions& options,
                                  Diagnostics& diagnostics);

/// All sums of a point of the one and a point of the other region. Where either is a circle, this is an
/// offset and arcs stay arcs; else arcs become chords within `chord`. An error for too many pairs of
/// segments.
std::optional<Region> minkowski_sum(const Region& first, const Region& second, Length chord,
                                    const RegionOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
