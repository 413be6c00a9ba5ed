// Comments with an effect: tools, stock, bead sizes, messages for the operator.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/gcode/comments/cam_comments.h"
#include "front/gcode/comments/cam_stock_comments.h"
#include "front/gcode/comments/own_comments.h"
#include "front/gcode/run/part.h"
#include "tool/tool_comments.h"

#include "kerf/stock/stock.h"

namespace kerf::gcode {

/// The bead that a slicer's comments describe.
struct CommentedBead {
  double width = 0.0, height = 0.0;  // mm; 0: unknown
  BeadKind kind = BeadKind::none;

  /// False for other comments.
  bool read(std::string_view text);
};

/// Follows comments, tool changes and motions in their order in the program.
class ProgramComments : Part {
 public:
  ProgramComments(Context& context, CommentedBead& beads)
      : Part(context), tool_comments_(context.program.tools), beads_(beads) {}

  void read(const Comment& comment, bool at_tool_change);
  /// The units of the program are known from here on.
  void note_units();
  /// The tool `number` is put into the spindle.
  void change_tool(int number);
  /// The path's last step is a motion.
  void motion() {
    tool_comments_.motion();
    change_at_pause_.reset();
    changed_without_motion_ = false;
    if (described_ && path_[path_.size() - 1].is_cutting()) assign_description(modes_.tool.value_or(0));
  }
  void first_motion() { use_pending(); }
  /// The tool that a comment of Kerf's posts names for the next pause.
  const std::optional<int>& change_at_pause() const { return change_at_pause_; }
  void finish();

 private:
  struct DescribedTool {
    std::string text;
    TextLocation where;
    CamTool tool;
  };
  struct Pending {
    std::string text;
    TextLocation where;
    bool at_tool_change = false;
  };
  void use_own(const OwnComment& own, const TextLocation& where);
  void pass_on(std::string_view text, std::uint32_t column);
  void read_cam(std::string_view text, const TextLocation& where, bool at_tool_change);
  void use_pending();
  void use_cam(std::string_view text, const TextLocation& where, bool at_tool_change);
  void assign_description(int number);
  void describe_tool(int number, const DescribedTool& described);

  ToolComments tool_comments_;
  CommentedBead& beads_;
  StockComments stock_;
  OwnComments own_comments_;
  std::optional<int> change_at_pause_;  // the tool of a comment of Kerf's posts
  CamComments cam_comments_;
  CamStockComments cam_stock_comments_;
  std::vector<Pending> pending_;            // before the units are known
  std::optional<DescribedTool> described_;  // by the last comment without a number, not yet assigned
  std::string_view last_mark_;              // of Kerf's on corrected heights
  bool changed_without_motion_ = false;     // since the last tool change
  bool units_given_ = false;
};

}  // namespace kerf::gcode
