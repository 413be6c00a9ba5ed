// The core of fitting arcs to chains of points: which arcs over a chord pass near the points between its
// ends, and how many points one of them reaches. fit.h (points) and passes.h (chords of a toolpath) use it.
#pragma once

#include <cstddef>

#include "geom/base/line_arc.h"

namespace kerf {

/// The arcs of at most half a turn over a chord, and the chord itself. Each is given by its height over the
/// chord's midpoint, above 0 to the left; every point that it has to pass narrows the interval of heights.
class ArcHeights {
 public:
  ArcHeights(Point2 from, Point2 to)
      : from_(from), to_(to), midpoint_(from + 0.5 * (to - from)), half_(0.5 * norm(to - from)) {
    if (half_ == 0.0) return;
    direction_ = (0.5 / half_) * (to - from);
    low_ = -half_;
    high_ = half_;
  }
  bool has_chord() const { return half_ > 0.0; }
  /// Keeps the arcs that pass within `slack` of a point, measured across the chord. False where none is left.
  bool allow(Point2 p, double slack);
  bool allows_line() const { return low_ <= 0.0 && high_ >= 0.0; }
  /// The mean of the lowest and the highest that are left.
  double mean() const { return 0.5 * (low_ + high_); }
  /// Of the arc with this height, which is not 0.
  double radius(double height) const { return 0.5 * (height * height + half_ * half_) / std::abs(height); }
  /// The point halfway along the arc.
  Point2 via(double height) const { return midpoint_ + height * left_of(direction_); }
  LineArc arc(double height) const;

 private:
  double height_through(double x, double y) const;
  Point2 from_, to_, midpoint_, direction_;
  double half_;  // of the chord
  double low_ = 0.0, high_ = 0.0;
};

/// The last index up to `end` for which `reaches` is true, found in steps that double and then halve; `good`
/// is known to be reached. About 2 log2(end - good) trials, so that one may be missed where `reaches` is true
/// again after it was false.
template <class Reaches>
std::size_t furthest(std::size_t good, std::size_t end, Reaches reaches) {
  bool grows = true;
  for (std::size_t stride = 1; stride > 0; stride = grows ? 2 * stride : stride / 2) {
    if (good + stride <= end && reaches(good + stride))
      good += stride;
    else
      grows = false;
  }
  return good;
}

}  // namespace kerf
