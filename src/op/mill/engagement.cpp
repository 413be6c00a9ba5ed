// The engagement of a tool beside a disc that was cleared before. The axis was everywhere in a disc D of
// radius R about b, so the disc of radius R + r about b has no material. The axis is now at p on the edge of
// another disc of radius R about b', |b' - b| <= step, and moves along that edge. With d = |p - b|, the part
// of the tool's circle outside of the cleared disc covers an angle phi on both sides of the direction from b
// to p, cos phi = ((R + r)^2 - d^2 - r^2) / (2 r d). That direction differs from the normal of the path by
// delta. Of the leading half of the circle no more than min(delta + phi, 2 phi) is in the material. The
// maximum over all positions of b at the distance `step`, the worst of those within it, is the bound. It
// needs nothing of the region, so it holds at walls, corners, islands and where cleared areas meet.
#include "op/mill/engagement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::op_detail {
namespace {

constexpr int kDirections = 64;  // of b, over half a turn; the bound changes by less than 0.1 degrees between
constexpr int kHalvings = 40;    // of the interval in which the step is searched

}  // namespace

double largest_engagement(double radius, double cleared, double step) {
  const double reach = cleared + radius;
  double largest = 0.0;
  for (int i = 0; i <= kDirections; ++i) {
    const double beta = std::numbers::pi * i / kDirections;
    const double along = cleared + step * std::cos(beta), aside = step * std::sin(beta);
    const double d = std::hypot(along, aside);
    if (d + radius <= reach) continue;
    const double cosine = (reach * reach - d * d - radius * radius) / (2.0 * radius * d);
    const double phi = std::acos(std::clamp(cosine, -1.0, 1.0));
    largest = std::max(largest, std::min(std::atan2(aside, along) + phi, 2.0 * phi));
  }
  return largest;
}

double step_within(double radius, double cleared, double limit) {
  double low = 0.0, high = std::min(radius, cleared);
  for (int i = 0; i < kHalvings; ++i) {
    const double step = 0.5 * (low + high);
    (largest_engagement(radius, cleared, step) <= limit ? low : high) = step;
  }
  return low;
}

}  // namespace kerf::op_detail
