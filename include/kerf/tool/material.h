// Materials: the maximum chip load (mm per tooth) by tool diameter.
#pragma once

#include <string>
#include <vector>

#include "kerf/base/units.h"

namespace kerf {

struct ChipLoad {
  Length diameter;
  Length highest;  // mm per tooth
};

struct Material {
  std::string name;
  std::vector<std::string> other_names;
  std::vector<ChipLoad> chip_loads;  // by increasing diameter, at least one
  double pass_depth = 0.5;           // usual depth of a pass, in diameters of the tool
  double plunge = 0.25;              // usual feed downwards, as a fraction of the feed
};

/// The maximum chip load for a tool of `diameter`: interpolated between rows of the table, proportional to
/// the diameter below the first, and that of the last row above it.
Length highest_chip_load(const Material& material, Length diameter);

// Feeds by the chip load: what a table of materials gives for a tool and a spindle speed.

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
