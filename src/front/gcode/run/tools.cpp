// Tool changes and tool lengths.
#include "front/gcode/run/tools.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/gcode.h"

namespace kerf::gcode {

void Tools::select() {
  const double number = *line_.take('T');
  if (!(number >= 0.0 && number <= std::numeric_limits<int>::max()) || number != std::floor(number)) {
    reporter_.error(codes::word_out_of_range, line_.column('T'), "a tool number is an integer from 0");
    return;
  }
  modes_.selected_tool = static_cast<int>(number);
}

void Tools::change() {
  if (line_.code(Group::tool_change) == 610) {  // M61: sets the number of the tool in the spindle
    const std::optional<double> number = line_.take('Q');
    if (!number || *number < 0.0 || *number > std::numeric_limits<int>::max() ||
        *number != std::floor(*number)) {
      reporter_.error(codes::word_missing, line_.column(Group::tool_change), "M61 needs Q, a tool number");
      return;
    }
    modes_.tool = static_cast<int>(*number);
    add(step::ToolChange{*modes_.tool, ToolChangeKind::number_only});
    return;
  }
  if (!modes_.selected_tool)
    reporter_.unusual(codes::word_missing, line_.column(Group::tool_change),
                      "M6 before any T word; assuming tool 0");
  spindle_.stop();
  comments_.change_tool(modes_.selected_tool.value_or(0));
}

/// The pause after a comment "change to tool 2" of Kerf's posts is that change.
void Tools::change_at_pause() {
  spindle_.stop();
  comments_.change_tool(*comments_.change_at_pause());
}

/// G43, G43.1, G43.2, G49. The toolpath is that of the tip, but after a change of the length compensation the
/// present height of the tip in work coordinates is unknown, and so are those of the homes.
void Tools::set_length() {
  const Tenths code = line_.code(Group::tool_length);
  step::ToolLength length;
  if (code == 431) {
    length.kind = ToolLengthKind::given;
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<double> word = line_.take(static_cast<char>('X' + axis));
      if (!word) continue;
      length.offset[axis] = *word * modes_.scale;
      length.axes |= 1u << axis;
    }
    line_.use(kRotaryLetters);
  } else if (code != 490) {
    length.kind = ToolLengthKind::table;
    const std::optional<double> number = line_.take('H');
    const bool valid = number && *number == std::floor(*number) && *number >= 0.0 && *number <= 1e6;
    if (number && !valid)
      reporter_.error(codes::word_out_of_range, line_.column('H'), "H is a whole number from 0");
    if (valid) length.number = static_cast<int>(*number);
    if (valid && modes_.tool && length.number != *modes_.tool)
      reporter_.unusual(codes::tool_length_other, line_.column('H'),
                        fmt::format("H{} is the length of another tool than T{}, which is in the spindle",
                                    length.number, *modes_.tool),
                        fmt::format("should it be H{}?", *modes_.tool));
    if (code == 432) report_unresolved("a sum of tool lengths (G43.2)", line_.column(Group::tool_length));
  }
  const auto same = [&](const step::ToolLength& old) {
    return old.kind == length.kind && old.number == length.number && old.offset == length.offset &&
           old.axes == length.axes && (length.kind != ToolLengthKind::table || length_tool_ == modes_.tool);
  };
  if (length_ && same(*length_)) return;
  length_ = length;
  length_tool_ = modes_.tool;
  constexpr unsigned kZ = 4;
  if (add(length)) coordinates_.lose(kZ);
}

}  // namespace kerf::gcode
