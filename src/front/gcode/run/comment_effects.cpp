// Comments with an effect: tools, stock, bead sizes, messages for the operator.
#include <fmt/format.h>
#include <string>

#include "front/gcode/comments/cam_tool_comments.h"
#include "front/gcode/comments/slicer_comments.h"
#include "front/gcode/run/interpreter.h"

namespace kerf::gcode {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Case-insensitive; `word` is in capitals.
bool starts_with(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = text[i] >= 'a' && text[i] <= 'z' ? static_cast<char>(text[i] - 'a' + 'A') : text[i];
    if (c != word[i]) return false;
  }
  return true;
}

constexpr std::size_t kMaxCommentBytes = 1000;  // longer ones are skipped

constexpr std::size_t kMaxPendingTools = 1000;  // before the units are known

}  // namespace

void Interpreter::read_comment(const Comment& comment) {
  const std::string_view text = trimmed(comment.text);
  if (text.size() > kMaxCommentBytes) return;
  if (is_printer()) {
    if (const auto size = read_bead_size(text)) {
      (size->measure == BeadMeasure::width ? bead_width_ : bead_height_) = size->mm;
      return;
    }
  }
  if (starts_with(text, "MSG")) {
    const std::string_view rest = trimmed(text.substr(3));
    if (rest.empty() || rest.front() != ',') return;
    origin_line_ = reporter_.line();
    origin_ = path_.origins().text(file_, origin_line_, comment.column);
    add(step::Note{std::string(trimmed(rest.substr(1)))});
    return;
  }
  if (starts_with(text, "STOCK")) {
    stock_.read(text, modes_.scale, reporter_.location(comment.column), reporter_.diagnostics());
    return;
  }
  if (take_cam_tool(text, reporter_.location(comment.column))) return;
  tool_comments_.read(text, modes_.scale, reporter_.location(comment.column), reporter_.diagnostics());
}

/// True for a tool comment of a CAM program. Those in the header are kept until the units are known.
bool Interpreter::take_cam_tool(std::string_view text, const TextLocation& where) {
  if (text.size() < 5 || !read_cam_tool(text, modes_.scale)) return false;
  if (units_given_ || moved_) {
    use_cam_tool(text, where);
  } else if (pending_tools_.size() < kMaxPendingTools) {
    pending_tools_.emplace_back(std::string(text), where);
  }
  return true;
}

void Interpreter::use_pending_tools() {
  for (const auto& [text, where] : pending_tools_) use_cam_tool(text, where);
  pending_tools_.clear();
}

/// TOOL/... comments (kerf/tool_comments.h) have precedence. A comment without a number describes
/// tool 0, the tool of a program without tool changes.
void Interpreter::use_cam_tool(std::string_view text, const TextLocation& where) {
  const std::optional<CamTool> described = read_cam_tool(text, modes_.scale);
  const int number = described ? described->number.value_or(0) : 0;
  if (!described || program_.tools.count(number) != 0) return;
  tool_comments_.describe(number, described->shape, where, reporter_.diagnostics());
  const auto tool = program_.tools.find(number);
  if (tool == program_.tools.end()) return;
  tool->second.description = std::string(text);
  reporter_.diagnostics().note(Code::tool_from_remark, where,
                               fmt::format("tool {} from this comment: {}, diameter {:g} mm", number,
                                           name_of(tool->second.shape), tool->second.diameter.mm()));
}

}  // namespace kerf::gcode
