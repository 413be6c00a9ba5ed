// Feeds by the chip load: what a table of materials gives for a tool and a spindle speed.
#pragma once

#include "kerf/material.h"
#include "kerf/units.h"

namespace kerf {

/// What a feed is chosen from.
struct FeedRequest {
  Length diameter;
  int teeth = 2;
  SpindleSpeed speed;
  Length pass_depth;  // of one pass
};
struct ChosenFeed {
  Feed feed;
  Length chip_load;     // mm per tooth
  double depth_factor;  // of the chip load that the depth permits, up to 1
};
/// Half of the maximum chip load: the low end of what charts of manufacturers recommend. Passes deeper than
/// the diameter have less: 0.75 of it at twice, 0.5 from three times the diameter.
ChosenFeed choose_feed(const Material& material, const FeedRequest& request);

}  // namespace kerf
