// The tools that the comments of a program describe, and which tool change each comment belongs to;
// the comments of a program in inches.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "kerf/base/diagnostics.h"
#include "kerf/base/origin.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// As write_tool_comment(shape), with lengths in units of `scale` mm (25.4 for a program in inches), as
/// read_tool_comment reads them.
std::optional<std::string> write_tool_comment(const ToolShape& shape, double scale);

/// Follows a program in its order. A comment (see read_tool_comment) describes the tool of the last tool
/// change if nothing moved since, else that of the next one.
class ToolComments {
 public:
  /// Described tools are added to `tools`, which must outlive this.
  explicit ToolComments(std::map<int, Tool>& tools) : tools_(tools) {}

  /// Reads a comment without its parentheses; others than tool comments have no effect. Lengths are in mm
  /// times `scale` (25.4 in a program in inches).
  void read(std::string_view comment, double scale, const Origin& where, Diagnostics& diagnostics);
  void tool_change(int number, Diagnostics& diagnostics);
  void motion() { undescribed_.reset(); }
  /// At the end of the program: warns of a comment that no tool change follows.
  void finish(Diagnostics& diagnostics);
  /// The kinds of comments, from the least to the most exact one.
  enum class Kind : unsigned char { words, cutviewer, own };
  /// Adds a tool of that shape; an error where there can be no such tool. Of two comments about one tool the
  /// more exact one counts, else the first; a warning if they contradict each other. True if it is added.
  bool describe(int number, const ToolShape& shape, Kind kind, const Origin& where, Diagnostics& diagnostics);
  bool describe(Tool tool, Kind kind, const Origin& where, Diagnostics& diagnostics);

 private:
  std::map<int, Kind> kinds_;  // of the comments that describe `tools_`
  std::map<int, Tool>& tools_;
  std::optional<ToolShape> pending_;  // described, and no tool change since
  Origin pending_where_;
  std::optional<int> undescribed_;  // changed to, not described, no motion since
};

}  // namespace kerf
