// Work offsets, tool lengths and homes.
#include "back/gcode/zero_lines.h"

#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "codec/gcode/code_table.h"

namespace kerf::gcode {

/// Whether a motion after step `i` leads to the home before another position is stored there.
bool ZeroLines::is_visited_after(std::size_t i, Reference home) const {
  for (++i; i < path_.size(); ++i) {
    if (path_[i].is_motion() && path_[i].reference() == home) return true;
    if (path_[i].kind() == StepKind::store_home && path_[i].store_home().home == home) return false;
  }
  return false;
}

void ZeroLines::store_home(std::size_t i) {
  const Reference home = path_[i].store_home().home;
  const int tenths = home == Reference::home ? 281 : 301;
  if (tenths == profile_.homing && is_visited_after(i, home))
    return report_unsupported(i,
                              fmt::format("G{}.1 runs the axes to their switches on this controller, which "
                                          "cannot store the position to which G{} returns later",
                                          tenths / 10, tenths / 10));
  if (!profile_.has_g(tenths) || tenths == profile_.homing)
    return report_skipped(
        i, fmt::format("the controller has no G{}.1 that stores the position; storing it", tenths / 10));
  lines_.start_line();
  lines_.code('G', tenths);
  lines_.end_line(i);
}

void ZeroLines::select_system(std::size_t i) {
  lines_.start_line();
  lines_.code('G', work_offset_code(system_));
  lines_.end_line(i);
}

/// Whether the controller has the code for a zero; otherwise reports what that means.
bool ZeroLines::can_set_zero(std::size_t i, const step::WorkZero& zero) {
  constexpr int kFirst[] = {0, 100, 100, 920, 921, 922, 923};
  const int system_code = work_offset_code(zero.system);
  const bool selects = zero.kind == ZeroKind::select;
  const int code = selects ? system_code : kFirst[static_cast<std::size_t>(zero.kind)];
  const bool letters = code != 100 || (profile_.has_letter('L') && profile_.has_letter('P'));
  if (profile_.has_g(code) && letters) return true;
  const std::string name = code_text('G', code);
  const bool first = selects && !system_selected_ && !moved_;
  if (first && zero.system == 1) return false;
  if (first)
    report_skipped(i,
                   fmt::format("the controller has no {}; its selection, and so another work zero,", name));
  else if (zero.unknown != 0 || zero.known != 0 || zero.kind == ZeroKind::offset)
    report_unsupported(i,
                       fmt::format("the controller has no {}, on which the positions after it depend", name));
  return false;  // positions stay in the coordinates so far
}

/// The selection of a work offset, or what sets one: the same words for the controller as in the program.
void ZeroLines::work_zero(std::size_t i) {
  const step::WorkZero zero = path_[i].work_zero();
  const bool can = can_set_zero(i, zero);
  position_.pass(path_[i]);
  if (can && zero.kind == ZeroKind::select) {
    system_ = zero.system;
    system_selected_ = true;
    select_system(i);
    axes_.set_zero(zero.zero);
  } else if (can) {
    lines_.start_line();
    switch (zero.kind) {
      case ZeroKind::select: break;
      case ZeroKind::offset:
      case ZeroKind::here:
        lines_.code('G', 100);
        lines_.word('L', zero.kind == ZeroKind::offset ? 2 : 20, 0);
        lines_.word('P', zero.system, 0);
        break;
      case ZeroKind::shift: lines_.code('G', 920); break;
      case ZeroKind::shift_off: lines_.code('G', 921); break;
      case ZeroKind::shift_paused: lines_.code('G', 922); break;
      case ZeroKind::shift_on: lines_.code('G', 923); break;
    }
    const bool by_position = zero.kind == ZeroKind::here || zero.kind == ZeroKind::shift;
    axes_.put(units_.grid.counts(by_position ? zero.at - zero.zero : zero.zero), zero.axes);
    lines_.end_line(i);
    if (zero.system == system_) axes_.set_zero(zero.zero);
  }
  axes_.follow_position();
  words_.forget_motion();
}

void ZeroLines::tool_length(std::size_t i, const step::ToolLength& length) {
  axes_.lose(4u);
  const int tenths = length.kind == ToolLengthKind::none    ? 490
                     : length.kind == ToolLengthKind::table ? 430
                                                            : 431;
  if (!profile_.has_g(tenths)) {
    if (length.kind == ToolLengthKind::table)
      report_skipped(i,
                     "the controller has no tool lengths (G43): set the work zero in Z for each tool; G43");
    if (length.kind == ToolLengthKind::given)
      report_unsupported(i, "the controller has no G43.1, which states the length of the tool");
    return;
  }
  lines_.start_line();
  lines_.code('G', tenths);
  if (length.kind == ToolLengthKind::table && length.number >= 0) lines_.word('H', length.number, 0);
  if (length.kind == ToolLengthKind::given) axes_.put(units_.grid.counts(length.offset), length.axes);
  lines_.end_line(i);
}

}  // namespace kerf::gcode
