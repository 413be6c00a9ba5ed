// Feeds by the chip load.
#include <algorithm>

#include "kerf/tool/material.h"

namespace kerf {
namespace {

constexpr double kFraction = 0.5;  // of the maximum chip load
/// Charts reduce the chip load by a quarter at a depth of two diameters, and by half at three.
constexpr double kLessPerDiameter = 0.25, kSmallest = 0.5;

}  // namespace

ChosenFeed choose_feed(const Material& material, const FeedRequest& request) {
  const double beyond = request.pass_depth / request.diameter - 1.0;
  ChosenFeed chosen;
  chosen.depth_factor = std::clamp(1.0 - kLessPerDiameter * beyond, kSmallest, 1.0);
  chosen.chip_load = kFraction * chosen.depth_factor * highest_chip_load(material, request.diameter);
  chosen.feed = static_cast<double>(request.teeth) * (chosen.chip_load * request.speed);
  return chosen;
}

}  // namespace kerf
