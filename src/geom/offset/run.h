// Segments of outlines with their tangents at both ends, from which offset curves are made.
#pragma once

#include <vector>

#include "geom/region/edge.h"

#include "kerf/geom/offset.h"

namespace kerf::region_detail {

struct Run : LineArc {
  Point2 start_tangent, end_tangent;  // unit
  double reach = 0.0;                 // up to this distance from both ends it does not turn back
  std::uint32_t number = 0;           // of the segment in its outline
  Point2 right_of_start() const { return -left_of(start_tangent); }
  Point2 right_of_end() const { return -left_of(end_tangent); }
  double curvature() const { return is_arc() ? turn / radius : 0.0; }
};

/// Segments without length are left out.
std::vector<Run> runs_of(const Outline& outline);

/// +1 where a chain turns to the left from one run to the next, -1 to the right. Where it turns back, a spike
/// with the inside (on the left) within it is a turn to the left.
double turn_between(const Run& run, const Run& next);

/// The shape of outer corners: an arc, or the tangents up to their intersection or the limit.
struct Corner {
  Join join = Join::round;
  double limit = 1.0;  // how far from the corner the tangents are cut off, by the distance of the offset
};

/// The sources of the edges around a corner: of the arc or the line across a mitre's tip, and of the tangents
/// before and after it.
struct CornerSources {
  std::uint32_t corner = 0, before = 0, after = 0;
};
/// Goes around an outer corner at `at` of a curve at the distance `by` > 0 from it, from the direction `from`
/// (unit, from the corner) to `to`; counter-clockwise where `turn` is above 0. The last point of
/// the set is the first one.
void add_corner(EdgeSet& set, Point2 at, double by, Point2 from, Point2 to, double turn, const Corner& corner,
                const CornerSources& sources);

}  // namespace kerf::region_detail
