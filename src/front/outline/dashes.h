// The dashes of a stroke along an outline.
#pragma once

#include <optional>
#include <vector>

#include "kerf/geom/outline.h"

namespace kerf::outline_front {

/// A piece of a line with the direction of its start; a dot has no segments.
struct Dash {
  Outline outline;
  Point2 direction{1.0, 0.0};
};

/// The pieces that a pattern of dashes and gaps in turn leaves, from `offset` within the pattern. The last
/// dash of a closed outline continues into the first. Nothing if there are too many.
std::optional<std::vector<Dash>> dashed(const Outline& outline, const std::vector<double>& pattern,
                                        double offset);

}  // namespace kerf::outline_front
