// Motions as lines: axes, feeds, arcs, chords.
#pragma once

#include <cstddef>
#include <vector>

#include "back/gcode/arc_plan.h"
#include "back/gcode/axis_words.h"
#include "back/gcode/modal_words.h"
#include "back/gcode/post_part.h"
#include "back/gcode/thread_lines.h"

namespace kerf::gcode {

/// Writes all motions but beads.
class MotionLines : PostPart {
 public:
  MotionLines(PostContext& context, AxisWords& axes, RotaryWords& rotary, ModalWords& words,
              ThreadLines& threads)
      : PostPart(context), axes_(axes), rotary_(rotary), words_(words), threads_(threads) {}

  void write(std::size_t i);
  bool fits(std::size_t i);
  bool raise_again(std::size_t k, std::size_t i);

 private:
  void cut(std::size_t i);
  void straight(int g, std::size_t i);
  void straight_to(int g, std::size_t i, const Counts& to, double fraction);
  void move_by(const std::vector<int>& codes, std::size_t i, const Counts& to);
  void arc(std::size_t i);
  void chords(std::size_t i);
  void probe(std::size_t i);
  void to_reference(int g, std::size_t i);
  void go_home(int tenths, unsigned axes, unsigned rotary, std::size_t i);
  void to_end_switches(std::size_t i);

  AxisWords& axes_;
  RotaryWords& rotary_;
  ModalWords& words_;
  ThreadLines& threads_;
  ArcPlan plan_;
  bool uncorrected_reported_ = false;
};

}  // namespace kerf::gcode
