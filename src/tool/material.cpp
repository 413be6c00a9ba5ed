// Interpolation of chip loads, and feeds by them.
#include "kerf/material.h"

#include <algorithm>

namespace kerf {
namespace {

constexpr double kShare = 0.5;  // of the maximum chip load
/// Charts reduce the chip load by a quarter at a depth of two diameters, and by half at three.
constexpr double kLessPerDiameter = 0.25, kLeast = 0.5;

}  // namespace

Length highest_chip_load(const Material& material, Length diameter) {
  ChipLoad below;  // chip load 0 at diameter 0
  for (const ChipLoad& above : material.chip_loads) {
    if (diameter <= above.diameter) {
      const double fraction = (diameter - below.diameter) / (above.diameter - below.diameter);
      return below.highest + fraction * (above.highest - below.highest);
    }
    below = above;
  }
  return below.highest;
}

ChosenFeed choose_feed(const Material& material, const FeedRequest& request) {
  const double beyond = request.pass_depth / request.diameter - 1.0;
  ChosenFeed chosen;
  chosen.depth_share = std::clamp(1.0 - kLessPerDiameter * beyond, kLeast, 1.0);
  chosen.chip_load = kShare * chosen.depth_share * highest_chip_load(material, request.diameter);
  chosen.feed = static_cast<double>(request.teeth) * (chosen.chip_load * request.speed);
  return chosen;
}

}  // namespace kerf
