// The order in which the elements of a path are travelled.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kerf/geom/geometry.h"

namespace kerf::pathdxf {

/// An element as a connection of two points.
struct Link {
  Point2 start, end;
  double order = 0.0;  // lower ones are preferred where several continue a path, then lower ranks,
  int rank = 0;        // then those with a shorter distance of start and end, then the first
};

struct WalkStep {
  std::size_t link = 0;
  bool reversed = false;
};

struct Walk {
  std::vector<WalkStep> steps;
  Point2 end;                          // where it stopped
  std::vector<std::size_t> unreached;  // links, in their order
};

/// Follows the links from a point as long as one continues at the point reached.
Walk walk(const std::vector<Link>& links, Point2 from);

/// The open end of the given links nearest to a point, and its distance.
struct OpenEnd {
  Point2 at;
  double distance = 0.0;
};
std::optional<OpenEnd> nearest_end(const std::vector<Link>& links, const std::vector<std::size_t>& candidates,
                                   Point2 to);

}  // namespace kerf::pathdxf
