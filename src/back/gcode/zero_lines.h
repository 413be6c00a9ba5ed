// Work offsets, tool lengths and homes.
#pragma once

#include <cstddef>

#include "back/gcode/modal_words.h"
#include "back/gcode/post_part.h"

namespace kerf::gcode {

class ZeroLines : PostPart {
 public:
  ZeroLines(PostContext& context, AxisWords& axes, ModalWords& words)
      : PostPart(context), axes_(axes), words_(words) {}

  void work_zero(std::size_t i);
  void tool_length(std::size_t i, const step::ToolLength& length);
  void store_home(std::size_t i);
  void start_file(std::size_t first_step) {
    if (system_selected_) select_system(first_step);
  }

 private:
  bool is_visited_after(std::size_t i, Reference home) const;
  void select_system(std::size_t i);
  bool can_set_zero(std::size_t i, const step::WorkZero& zero);

  AxisWords& axes_;
  ModalWords& words_;
  int system_ = 1;  // selected work offset
  bool system_selected_ = false;
};

}  // namespace kerf::gcode
