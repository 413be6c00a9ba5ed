// Tool comments and tool changes in the order of a program.
#include "tool/tool_comments.h"

#include <utility>

#include "base/codes/gcode.h"

namespace kerf {
namespace {

constexpr std::size_t kMaxComment = 1000;  // bytes of a comment that can describe a tool

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// True for a comment whose first letters are TOOL in any case.
bool may_describe(std::string_view text) {
  constexpr std::string_view kWord = "TOOL";
  if (text.size() < kWord.size()) return false;
  for (std::size_t i = 0; i < kWord.size(); ++i) {
    const char c = text[i] >= 'a' && text[i] <= 'z' ? static_cast<char>(text[i] - 'a' + 'A') : text[i];
    if (c != kWord[i]) return false;
  }
  return true;
}

}  // namespace

void ToolComments::read(std::string_view comment, double scale, const Origin& where,
                        Diagnostics& diagnostics) {
  while (!comment.empty() && is_blank(comment.front())) comment.remove_prefix(1);
  while (!comment.empty() && is_blank(comment.back())) comment.remove_suffix(1);
  if (comment.size() > kMaxComment || !may_describe(comment)) return;
  const std::optional<ToolShape> shape = read_tool_comment(comment, scale, where, diagnostics);
  if (!shape) return;
  if (undescribed_) {
    describe(*undescribed_, *shape, where, diagnostics);
    undescribed_.reset();
    return;
  }
  pending_ = shape;
  pending_where_ = where;
}

void ToolComments::tool_change(int number, Diagnostics& diagnostics) {
  undescribed_ = number;
  if (!pending_) return;
  describe(number, *pending_, pending_where_, diagnostics);
  pending_.reset();
  undescribed_.reset();
}

void ToolComments::finish(Diagnostics& diagnostics) {
  if (!pending_) return;
  diagnostics.warning(codes::tool_comment_unused, pending_where_,
                      "the comment describes a tool, but no tool change follows");
  pending_.reset();
}

void ToolComments::describe(int number, const ToolShape& shape, const Origin& where,
                            Diagnostics& diagnostics) {
  if (auto tool = make_tool(number, shape, ToolBody{}, where, diagnostics))
    tools_.insert_or_assign(number, std::move(*tool));
}

}  // namespace kerf
