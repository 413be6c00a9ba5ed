// Offsets of regions, and what lies within or at a distance from a path. Arcs stay arcs.
//
//   Diagnostics diagnostics;
//   const auto smaller = offset(plate, mm(-3), {}, diagnostics);  // where the centre of a 6 mm mill may be
//   const auto groove = buffer(path, mm(3), PathEnds::round, {}, diagnostics);  // what it removes
//
// Frame, units, tolerance and errors as in region.h.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/geom/region.h"

namespace kerf {

/// The shape of outer corners where a region grows, and of inner ones where it shrinks.
enum class Join : std::uint8_t {
  round,  ///< an arc: every point of the boundary is at the distance of the offset
  mitre   ///< the neighbours' tangents up to their intersection, cut off straight at the limit
};
struct JoinOptions {
  Join join = Join::round;
  /// Of a mitre: the maximum distance of its tip from the corner as a multiple of the offset, at least 1. A
  /// tip further away is cut off by a line at this distance.
  double mitre_limit = 2.0;
};

struct Offset {
  Region region;
  /// Loops of the input without a segment in the result: too narrow, or inside the others' offset.
  std::size_t vanished = 0;
  /// Of each segment, by loop: the segment of the input that it is parallel to, or the corner around which it
  /// goes.
  std::vector<std::vector<BoundaryElement>> sources{};
};
/// All points within `by` of the region (`by` > 0), or all points of the region that are at least -`by` from
/// its boundary (`by` < 0).
std::optional<Offset> offset(const Region& region, Length by, const RegionOptions& options,
                             Diagnostics& diagnostics);
/// The same with corners of another shape than round.
std::optional<Offset> offset(const Region& region, Length by, const JoinOptions& joins,
                             const RegionOptions& options, Diagnostics& diagnostics);

enum class PathEnds : std::uint8_t {
  round,  ///< as a mill leaves them
  butt    ///< square, exactly at the ends
};
/// All points within `half_width` > 0 of a path, open or closed; it may intersect itself.
std::optional<Region> buffer(const Outline& path, Length half_width, PathEnds ends,
                             const RegionOptions& options, Diagnostics& diagnostics);

/// The curve at the distance `to_left` (below 0: to the right) from a path, without the parts that are
/// closer to the path than that: the path of the centre of a mill that cuts along one side. It has the
/// direction of the path; several outlines, or none, where parts are removed.
std::optional<std::vector<Outline>> offset_path(const Outline& path, Length to_left,
                                                const RegionOptions& options, Diagnostics& diagnostics);

}  // namespace kerf
