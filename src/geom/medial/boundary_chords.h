// The boundary of a region as chords on a grid of whole numbers that have nothing in common but ends.
#pragma once

#include <optional>
#include <vector>

#include "geom/medial/medial_axis.h"
#include "voronoi.h"

namespace kerf::medial_detail {

/// A segment of the region, numbered through all loops.
struct SourceSegment {
  std::uint32_t loop = 0, segment = 0;
  double step = 0.0;        // angle of each of its chords, where it is an arc
  bool smooth_end = false;  // it and the next segment of the loop are tangent, nearly
  std::uint32_t next = 0;   // the next segment of the loop
  Point2 end;               // where it meets that
};

struct BoundaryChords {
  std::vector<GridChord> chords;              // the region on their left
  std::vector<std::uint32_t> segments;        // of each chord
  std::vector<std::uint32_t> next, previous;  // chords in their loop
  std::vector<SourceSegment> sources;
  Point2 origin;      // of the grid
  double unit = 1.0;  // mm by step of the grid

  Point2 at(Point2 on_grid) const { return origin + unit * on_grid; }
};

/// Nothing, with an error appended or after a stop, where that cannot be done; no chords for an empty region.
std::optional<BoundaryChords> boundary_chords(const Region& region, const MedialOptions& options,
                                              Diagnostics& diagnostics);

}  // namespace kerf::medial_detail
