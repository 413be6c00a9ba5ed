// What the passes share: where a motion begins, which motions can be put together, and the figures.
#pragma once

#include <algorithm>
#include <cstddef>

#include "kerf/passes.h"

namespace kerf::detail {

/// Where the next motion begins.
struct Begin {
  Point3 at;
  unsigned unknown = 7;
  bool known() const { return unknown == 0; }
  void pass(const Step& s) {
    if (!s.is_motion()) return;
    at = s.to();
    // Where a probe stops is not known.
    unknown = s.kind() == StepKind::probe ? 7u : s.unknown_axes();
  }
};

PassFigures figures_of(const Toolpath& path);
PassResult finished(const Toolpath& before, Toolpath after);
/// True if a motion's end is known in work coordinates and has nothing besides.
bool is_plain(const Toolpath& path, std::size_t i);
/// True if step `i` is a plain motion of the kind and feed of step `first`.
bool chains(const Toolpath& path, std::size_t i, std::size_t first);
double distance_to_segment(Point3 p, Point3 a, Point3 b);

}  // namespace kerf::detail
