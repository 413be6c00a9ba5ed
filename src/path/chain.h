// Common to the passes: start positions, which motions can be joined, and the figures.
#pragma once

#include <algorithm>
#include <cstddef>

#include "kerf/path/passes.h"

namespace kerf::detail {

/// The start position of the next motion, as far as a pass may rely on it: an operator, or a line for the
/// controller, may have moved the tool.
struct StartPosition : PathPosition {
  void pass(const Step& s) {
    PathPosition::pass(s);
    const bool stops = s.kind() == StepKind::tool_change || s.kind() == StepKind::pause;
    if (stops || s.kind() == StepKind::verbatim || s.kind() == StepKind::unresolved) unknown = 7;
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
