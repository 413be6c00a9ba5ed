// Motions that depend on the spindle's angle.
#pragma once

#include <cstddef>
#include <optional>

#include "back/gcode/modal_words.h"
#include "back/gcode/post_part.h"
#include "back/gcode/spindle_lines.h"

namespace kerf::gcode {

class ThreadLines : PostPart {
 public:
  ThreadLines(PostContext& context, AxisWords& axes, ModalWords& words, const SpindleLines& spindle)
      : PostPart(context), axes_(axes), words_(words), spindle_(spindle) {}

  bool locked_motion(std::size_t i);
  /// Writes the tapping cycle that starts with the rapid `i` down to its clearance and returns above it.
  bool tap_from_above(std::size_t i);
  /// Whether step `i` is part of a tap that has been written.
  bool skips(std::size_t i) const { return i < skip_to_; }

 private:
  struct Tap {
    std::size_t end = 0;  // the step after it
    Duration dwell{};
  };
  SpindleLock lock_of(std::size_t i) const;
  std::optional<Tap> tap_at(std::size_t i, Point3 start) const;
  int cycle() const;
  bool can_cycle(std::size_t i, Point3 from) const;
  bool tapping_cycle(std::size_t i);
  void put_tap(std::size_t i, const Tap& tap, std::int64_t clearance);

  AxisWords& axes_;
  ModalWords& words_;
  const SpindleLines& spindle_;
  bool reported_ = false;
  std::size_t skip_to_ = 0;
};

}  // namespace kerf::gcode
