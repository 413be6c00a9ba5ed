// The edges of a region's boundary in a tree, for queries.
#pragma once

#include <optional>
#include <vector>

#include "arrangement.h"

#include "kerf/geom/region.h"

namespace kerf::region_detail {

class Boundary {
 public:
  void add(const Region& region);
  /// `boundary` within `weld` of it; on which side another point lies is decided without rounding.
  Location locate(Point2 at, double weld) const;
  std::optional<BoundaryPoint> nearest(Point2 at) const;

  EdgeSet set{0.0};
  BoxTree tree;

 private:
  std::vector<BoundaryPoint> sources_;  // loop and segment by source
};

}  // namespace kerf::region_detail
