// The medial axis of a region: the centres of the circles inside it that touch its boundary in two points or
// more, with their radii. A V-shaped tool whose tip follows it, at the depth of the radius, cuts the region
// to its boundary; a mill fits where the radius is at least its own.
//
//   Diagnostics diagnostics;
//   const auto axis = medial_axis(letter, {}, diagnostics);
//   for (const MedialEdge& edge : axis->edges) ...  // edge.points: centres and radii from end to end
//
// Frame and units as in outline.h. The axis is exact but for three errors, each with a limit of its own:
// chords of the boundary's arcs (`Tolerance::chord`), chords of the axis, and nodes that are one point.
// Errors (codes 704x) go to Diagnostics; then there is no value.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/geom/region.h"

namespace kerf {

/// The centre and radius of a circle inside the region that touches its boundary.
struct MedialPoint {
  Point2 at;      // mm
  Length radius;  // 0 in a corner of the region
};

/// A part of the axis between two nodes, whose circles touch the same two segments or corners.
struct MedialEdge {
  std::uint32_t from = 0, to = 0;   ///< nodes
  std::vector<MedialPoint> points;  ///< from node to node; chords between them within `MedialOptions::axis`
  BoundaryElement left, right;      ///< what the circles touch on both sides of the direction of travel
};

struct MedialAxis {
  std::vector<MedialPoint> nodes;  ///< ends and junctions of edges; a disc has a single node and no edge
  std::vector<MedialEdge> edges;
};

struct MedialOptions {
  RegionOptions region{};
  /// Corners that turn by less than this are smooth: the axis does not reach into them.
  Angle smooth = degrees(0.18);
  Length axis = mm(0.0005);  ///< of chords of the axis
  Length nodes = mm(0.002);  ///< vertices that far from one with a larger radius are one node with it
};

std::optional<MedialAxis> medial_axis(const Region& region, const MedialOptions& options,
                                      Diagnostics& diagnostics);

/// The largest circle inside a region: its radius is that of the largest possible, less at most a few times
/// `Tolerance::chord`, and never more. Nothing for an empty region, without an error.
std::optional<Circle> largest_inscribed_circle(const Region& region, const RegionOptions& options,
                                               Diagnostics& diagnostics);

}  // namespace kerf
