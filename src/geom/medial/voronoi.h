// The Voronoi diagram of chords on a grid of whole numbers: the one adaptor to Boost.Polygon.
#pragma once

#include <cstdint>
#include <vector>

#include "kerf/geom/geometry.h"

namespace kerf::medial_detail {

/// Coordinates within 2^29 of 0.
struct GridPoint {
  std::int32_t x = 0, y = 0;
  bool operator==(const GridPoint&) const = default;
};
struct GridChord {
  GridPoint from, to;
};

/// What a cell belongs to: a chord between its ends, or one of its ends.
struct Site {
  enum class Kind : std::uint8_t { chord, start, end };
  std::uint32_t chord = 0;
  Kind kind = Kind::chord;
};

/// The points that have the same distance from two sites and a larger one from all others, between two
/// vertices. Chords have no such edge with their own ends.
struct VoronoiEdge {
  std::uint32_t from = 0, to = 0;  // vertices
  Site left, right;
};
struct Voronoi {
  std::vector<Point2> vertices;  // in units of the grid
  std::vector<VoronoiEdge> edges;
};

/// Edges to infinity are left out. Chords must have a length and nothing in common but ends.
Voronoi voronoi(const std::vector<GridChord>& chords);
/// Whether chords fulfil that.
bool are_separate(const std::vector<GridChord>& chords);

}  // namespace kerf::medial_detail
