// Arcs over a chord by their heights.
#include "arc_heights.h"

namespace kerf {

/// Height of the arc over the chord through a point `x` beside the chord's midpoint and `y` to its left.
double ArcHeights::height_through(double x, double y) const {
  if (y == 0.0) return 0.0;
  const double up = std::abs(y);
  const double centre = (x * x + up * up - half_ * half_) / (2.0 * up);
  const double root = std::sqrt(centre * centre + half_ * half_);
  const double height = centre > 0.0 ? root + centre : half_ * half_ / (root - centre);
  return y > 0.0 ? height : -height;
}

bool ArcHeights::allow(Point2 p, double slack) {
  const Point2 q = p - midpoint_;
  const double x = dot(q, direction_), y = cross(direction_, q);
  if (std::abs(x) >= half_) return std::abs(x) - half_ <= slack && std::abs(y) <= slack;
  low_ = std::max(low_, height_through(x, y - slack));
  high_ = std::min(high_, height_through(x, y + slack));
  return low_ <= high_;
}

LineArc ArcHeights::arc(double height) const {
  const double r = radius(height);
  const Point2 centre = midpoint_ + (height > 0.0 ? height - r : height + r) * left_of(direction_);
  return {from_, to_, centre - from_, r, height > 0.0 ? -1.0 : 1.0};
}

}  // namespace kerf
