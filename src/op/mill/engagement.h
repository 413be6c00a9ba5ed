// How far a path may advance beyond a cleared area so that the engagement angle of the tool keeps a limit.
#pragma once

namespace kerf::op_detail {

/// Where the axis of a tool of `radius` has been everywhere in a disc of radius `cleared`, it moves at a
/// right angle to the line from the centre of another disc of that radius, which is up to `step` away and on
/// whose edge it is. This is the largest engagement angle that can occur, in radians; all in mm.
double largest_engagement(double radius, double cleared, double step);

/// The largest step that keeps the engagement angle within `limit` (radians, at most a right angle).
double step_within(double radius, double cleared, double limit);

}  // namespace kerf::op_detail
