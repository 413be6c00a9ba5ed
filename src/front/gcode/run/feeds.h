// Feeds: F words, their modes, and the feed of each motion.
#pragma once

#include "front/gcode/run/part.h"
#include "front/gcode/run/rotary_axes.h"

namespace kerf::gcode {

class Feeds : Part {
 public:
  Feeds(Context& context, const RotaryAxes& rotary) : Part(context), rotary_(rotary) {}

  void set_mode();
  void set_feed();
  /// Feed in mm/min of a motion of `length` mm; 0 with a single warning if the program has none.
  double feed_for(double length);
  double straight_length(const ToolPosition& to) const;
  double straight_feed(const ToolPosition& to);
  double cycle_feed();

  /// By which printers multiply all feeds (M220).
  double factor() const { return factor_; }
  void set_factor(double factor) { factor_ = factor; }
  /// A cut has a feed.
  void note_feed() { missing_reported_ = false; }
  /// G94 or G95 again, and no F since.
  bool mode_repeated() const { return mode_repeated_; }

 private:
  void report_missing(bool inverse);
  const RotaryAxes& rotary_;
  double factor_ = 1.0;
  bool missing_reported_ = false;
  bool mode_repeated_ = false;
};

}  // namespace kerf::gcode
