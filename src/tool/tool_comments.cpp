// Tool comments and tool changes in the order of a program.
#include "tool/tool_comments.h"

#include <fmt/format.h>
#include <utility>

#include "base/codes/gcode.h"
#include "base/codes/tools.h"
#include "tool/comment_fields.h"

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
    describe(*undescribed_, *shape, Kind::cutviewer, where, diagnostics);
    undescribed_.reset();
    return;
  }
  pending_ = shape;
  pending_where_ = where;
}

void ToolComments::tool_change(int number, Diagnostics& diagnostics) {
  undescribed_ = number;
  if (!pending_) return;
  describe(number, *pending_, Kind::cutviewer, pending_where_, diagnostics);
  pending_.reset();
  undescribed_.reset();
}

void ToolComments::finish(Diagnostics& diagnostics) {
  if (!pending_) return;
  diagnostics.warning(codes::tool_comment_unused, pending_where_,
                      "the comment describes a tool, but no tool change follows");
  pending_.reset();
}

bool ToolComments::describe(int number, const ToolShape& shape, Kind kind, const Origin& where,
                            Diagnostics& diagnostics) {
  auto tool = make_tool(number, shape, ToolBody{}, where, diagnostics);
  return tool && describe(std::move(*tool), kind, where, diagnostics);
}

bool ToolComments::describe(Tool tool, Kind kind, const Origin& where, Diagnostics& diagnostics) {
  const int number = tool.number;
  const auto known = tools_.find(number);
  if (known == tools_.end()) {
    kinds_[number] = kind;
    tools_.emplace(number, std::move(tool));
    return true;
  }
  const bool more_exact = kind > kinds_[number];
  const Tool& exact = more_exact ? tool : known->second;
  const Tool& other = more_exact ? known->second : tool;
  if (!detail::agrees(exact, other))
    diagnostics.warning(
        codes::tool_comment_differs, where,
        fmt::format(
            "tool {} is {} by one comment of the program and {} by another; the first of these two is used",
            number, detail::text_of(exact), detail::text_of(other)));
  if (!more_exact) return false;
  kinds_[number] = kind;
  known->second = std::move(tool);
  return true;
}

}  // namespace kerf
