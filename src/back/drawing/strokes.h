// From a toolpath to the straight strokes and arcs of drawings, seen from above.
#pragma once

#include <cstddef>

#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/path/toolpath.h"

namespace kerf::drawings {

struct Stroke {
  std::size_t step = 0;
  Point3 from, to;               // mm
  const ArcWalk* arc = nullptr;  // in XY; nullptr: a straight line
  bool is_chord = false;         // of an arc that does not lie in XY
  bool ends_step = true;
  unsigned unknown_from = 0, unknown_to = 0;  // axes, see Step::unknown_axes
};

class StrokeSink {
 public:
  virtual ~StrokeSink() = default;
  virtual void stroke(const Stroke& stroke) = 0;
  /// A step that is not a motion.
  virtual void setting(std::size_t step) = 0;
};

struct StrokeOptions {
  Length chord = mm(0.01);  // maximum distance of chords from an arc that does not lie in XY
  int max_chords = 10'000;  // of one arc
};

/// Passes every motion of the path to the sink as one stroke, or as several chords, and all other steps
/// between them. The first motion starts at zero with all axes unknown.
void walk_strokes(const Toolpath& path, const StrokeOptions& options, StrokeSink& sink);

}  // namespace kerf::drawings
