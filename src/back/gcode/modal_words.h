// The words in force in the controller that a line need not repeat, and when all of them are unknown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "back/gcode/axis_words.h"
#include "back/gcode/post_part.h"

namespace kerf::gcode {

class ModalWords : PostPart {
 public:
  ModalWords(PostContext& context, AxisWords& axes, RotaryWords& rotary)
      : PostPart(context), axes_(axes), rotary_(rotary) {}

  void put_motion(int g);
  void put_plane(std::size_t i, Plane plane);
  void put_feed(std::size_t i);
  /// In mm per minute.
  void put_feed(Feed feed);
  /// Inverse time, if it is not in force; then the feed of a motion that takes `time`, which is not modal.
  void put_inverse_mode();
  void put_inverse_time(Duration time);
  /// Back to feeds per minute, on a line of its own, if inverse time is in force.
  void end_inverse_time(std::size_t i);
  void put_power();

  bool has_plane(Plane plane) const { return plane_ == plane; }
  void set_plane(Plane plane) { plane_ = plane; }
  void set_motion(int g) { motion_ = g; }
  void forget_motion() { motion_ = -1; }
  /// The power of a beam, for the next motion.
  void set_power(std::optional<double> power) { pending_power_ = power; }

  /// A verbatim line. Its effect is unknown: after it the whole state is written again.
  void raw_line(std::string_view text);
  void forget();

 private:
  void put_feed(Feed feed, double scale);

  AxisWords& axes_;
  RotaryWords& rotary_;
  int motion_ = -1;
  std::optional<Plane> plane_;
  std::int64_t feed_ = -1;
  bool inverse_time_ = false;  // in force
  std::optional<double> pending_power_;
  bool no_feed_reported_ = false;
};

}  // namespace kerf::gcode
