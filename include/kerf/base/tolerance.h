// Tolerances: permitted deviations of a job, with their defaults. They are passed in with the options of a
// function; geometry never stores one. This is the one table of defaults.
//
// Not here: limits of the input (limits.h), and numerical constants of an algorithm, which stay beside it
// with the reason for their value.
#pragma once

#include <algorithm>

#include "kerf/base/units.h"

namespace kerf {

/// The two tolerances of outlines and regions.
struct Tolerance {
  Length chord = mm(0.001);  ///< maximum distance of a polyline or fitted arc from the true curve
  Length weld = mm(1e-6);    ///< points closer than this are one point
};

/// By how much the radii at the two ends of an arc may differ. GRBL 1.1's rule: an arc is refused if they
/// differ by more than `absolute` and more than `relative` times the radius, or by more than `limit`.
struct ArcMismatch {
  Length absolute = mm(0.005);
  double relative = 0.001;
  Length limit = mm(0.5);

  /// Whether radii of an arc at its start and end point, mm, differ by no more.
  constexpr bool permits(double start, double end) const {
    const double difference = start < end ? end - start : start - end;
    return difference <= limit.mm() && difference <= std::max(absolute.mm(), relative * std::max(start, end));
  }
};

namespace default_tolerance {

inline constexpr Length kHazardDepth = mm(0.001);  // shallower contacts of the simulator are not reported
inline constexpr Length kGrazeDepth = mm(0.01);    // shallower contacts of its walls are not reported
inline constexpr Length kNozzleDepth = mm(0.01);   // likewise of a nozzle in printed material
inline constexpr Length kComparison = mm(0.05);    // smaller differences from a target are not reported
inline constexpr Length kMeshMerging = mm(0.002);  // of merged triangles, in height
inline constexpr Length kExactMesh = mm(0.002);    // of the edges of an exact mesh
inline constexpr Length kArcFitting = mm(0.005);   // of the chords that an arc replaces
inline constexpr Length kPostChord = mm(0.002);    // of chords for arcs that a controller cannot run
inline constexpr Length kDrawingChord = mm(0.01);  // of chords in DXF and SVG
inline constexpr Length kBeadChord = mm(0.01);     // of beads along an arc
inline constexpr Length kCurveChord = mm(0.002);   // of chords for splines (G5) and NURBS (G5.2)

}  // namespace default_tolerance

}  // namespace kerf
