// Common to the passes: start positions, which motions can be joined, and the figures.
#pragma once

#include <algorithm>
#include <cstddef>

#include "kerf/passes.h"

namespace kerf::detail {

/// The start position of the next motion.
struct StartPosition {
  Point3 at;
  unsigned unknown = 7;
  bool known() const { return unknown == 0; }
  void pass(const Step& s) {
    if (!s.is_motion()) return;
    at = s.to();
    // The end of a probe motion is unknown.
    unknown = s.kind() == StepKind::probe ? 7u : s.unknown_axes();
  }
};

PassFigures figures_of(const Toolpath& path);
PassResult finished(const Toolpath& before, Toolpath after);
/// True if the end of a motion is known in work coordinates and has no extra data.
bool is_plain(const Toolpath& path, std::size_t i);
/// True if step `i` is a plain motion of the kind and feed of step `first`.
bool chains(const Toolpath& path, std::size_t i, std::size_t first);
double distance_to_segment(Point3 p, Point3 a, Point3 b);

}  // namespace kerf::detail
