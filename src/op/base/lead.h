// Leads: the way onto a wall and off it.
#pragma once

#include "op/base/cutter.h"

#include "kerf/op/operation.h"

namespace kerf::op_detail {

/// The centre of the arc of a lead, or the end of its line: `free` is the side without a wall, +1 left, -1
/// right.
inline Point2 beyond_wall(const Lead& lead, const Track& track, double s, double free) {
  return track.at(s) + (free * lead.size.mm()) * left_of(track.direction(s));
}
/// Whether a lead is wanted and keeps clear of the walls.
inline bool permits(const Walls& walls, const Lead& lead, const Track& track, double s, double free) {
  if (lead.kind == LeadKind::none || !(lead.size > Length{})) return false;
  const Point2 beyond = beyond_wall(lead, track, s, free);
  return lead.kind == LeadKind::arc ? walls.permits_circle(beyond, lead.size.mm())
                                    : walls.permits_line(track.at(s), beyond);
}

}  // namespace kerf::op_detail
