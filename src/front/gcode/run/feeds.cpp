// Feeds: F words, their modes, and the feed of each motion.
#include "front/gcode/run/feeds.h"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"

namespace kerf::gcode {

void Feeds::set_mode() {
  const Tenths code = line_.code(Group::feed_mode);
  const FeedMode mode = code == 930   ? FeedMode::inverse_time
                        : code == 950 ? FeedMode::per_turn
                                      : FeedMode::per_minute;
  mode_repeated_ = mode == modes_.feed_mode && modes_.feed > 0.0 && !line_.has('F');
  if (mode == modes_.feed_mode) return;
  modes_.feed_mode = mode;
  modes_.feed = 0.0;  // the number of one mode has no meaning in another
  missing_reported_ = false;
}

void Feeds::set_feed() {
  const double feed = *line_.take('F');
  mode_repeated_ = false;
  if (feed < 0.0) {
    reporter_.error(codes::word_out_of_range, line_.column('F'), "a feed cannot be negative; skipped");
    return;
  }
  modes_.feed = modes_.feed_mode == FeedMode::inverse_time ? feed : feed * modes_.scale;
  modes_.feed_scale = modes_.scale;
}

/// Feed in mm/min of a motion of `length` mm; 0 with a single warning if the program has none.
double Feeds::feed_for(double length) {
  const bool inverse = modes_.feed_mode == FeedMode::inverse_time;
  const double given = inverse && !line_.has('F') ? 0.0 : modes_.feed;  // in inverse time F is not modal
  const double feed = feed_per_minute(modes_.feed_mode, given, length, modes_.rpm());
  if (!(feed > 0.0)) {
    if (!missing_reported_) report_missing(inverse);
    missing_reported_ = true;
    return 0.0;
  }
  missing_reported_ = false;
  if (std::exchange(mode_repeated_, false) && !inverse)
    reporter_.unusual(codes::word_missing, line_.column(),
                      "a cut without an F word since the last G94 or G95, after which LinuxCNC has no feed",
                      "put an F word on the line of the G94");
  return factor_ * feed;
}

void Feeds::report_missing(bool inverse) {
  if (modes_.feed_mode == FeedMode::per_turn && modes_.feed > 0.0)
    return reporter_.unusual(codes::no_feed, line_.column(),
                             "a feed per turn (G95) of a spindle whose speed is unknown",
                             "put an S word in rpm (G97) before it");
  reporter_.unusual(
      codes::no_feed, line_.column(),
      inverse ? "in inverse time (G93) each cut needs an F word on its own line" : "a cut before any feed",
      inverse ? "put an F word on the line" : "put an F word before the first G1");
}

/// Length in mm, from which an inverse time feed is computed; 0 in the other feed modes.
double Feeds::straight_length(const ToolPosition& to) const {
  if (modes_.feed_mode != FeedMode::inverse_time) return 0.0;
  return distance(position_.at, to.at);
}

/// Feed of a straight motion. If only rotary axes move, it is in degrees per minute, whatever the unit of
/// lengths; in inverse time it is unknown (0) if the angle is.
double Feeds::straight_feed(const ToolPosition& to) {
  const double square = rotary_.square_of_turn();
  const bool from_unknown = rotary_.from_unknown();
  const bool turns = square > 0.0 || from_unknown;
  if (!turns || !(to.at == position_.at) || to.unknown != position_.unknown)
    return feed_for(straight_length(to));
  if (modes_.feed_mode == FeedMode::per_minute) return feed_for(0.0) / modes_.scale;
  if (!from_unknown || modes_.feed_mode == FeedMode::per_turn) return feed_for(std::sqrt(square));
  reporter_.unusual(codes::no_feed, line_.column(),
                    "an inverse time feed (G93) from an unknown angle: the feed is unknown",
                    "move the rotary axis to a known angle first (G0 A0)");
  missing_reported_ = true;
  return 0.0;
}

/// Feed of a cycle in mm/min; 0 if there is none.
double Feeds::cycle_feed() {
  if (modes_.feed_mode != FeedMode::inverse_time) return feed_for(0.0);
  if (!missing_reported_)
    reporter_.unusual(codes::no_feed, line_.column(),
                      "a canned cycle cannot have an inverse time feed; it has no feed");
  missing_reported_ = true;
  return 0.0;
}

}  // namespace kerf::gcode
