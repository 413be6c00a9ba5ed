// Feed modes (G93, G94, G95) of front ends: steps have feeds per minute only.
#pragma once

#include <algorithm>
#include <cstdint>

namespace kerf {

enum class FeedMode : std::uint8_t { per_minute, inverse_time, per_turn };

/// mm/min; the feed that LinuxCNC takes for a motion of length 0 in inverse time mode.
inline constexpr double kSlowestInverseFeed = 0.1;

/// The feed of a motion in mm/min: `feed` as given (mm/min, 1/min or mm per turn of the spindle), `length` of
/// the motion in mm, `speed` of the spindle in rpm. 0 where no feed can be computed.
inline double feed_per_minute(FeedMode mode, double feed, double length, double speed) {
  if (!(feed > 0.0)) return 0.0;
  if (mode == FeedMode::inverse_time) return std::max(feed * length, kSlowestInverseFeed);
  return mode == FeedMode::per_turn ? feed * speed : feed;
}

}  // namespace kerf
