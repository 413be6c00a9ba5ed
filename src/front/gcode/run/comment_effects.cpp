// Comments that mean something: tools, the stock, messages for the operator.
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

/// True if `text` begins with `word` (upper case) in any case.
bool begins_with(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = text[i] >= 'a' && text[i] <= 'z' ? static_cast<char>(text[i] - 'a' + 'A') : text[i];
    if (c != word[i]) return false;
  }
  return true;
}

constexpr std::size_t kLongestComment = 1000;  // bytes of a comment that can describe something

constexpr std::size_t kMostWaiting = 1000;  // remarks before the units are known

}  // namespace

void Interpreter::read_comment(const Comment& comment) {
  const std::string_view text = trimmed(comment.text);
  if (text.size() > kLongestComment) return;
  if (is_printer()) {
    if (const auto bead = read_bead_remark(text)) {
      (bead->measure == BeadMeasure::width ? bead_width_ : bead_height_) = bead->mm;
      return;
    }
  }
  if (begins_with(text, "MSG")) {
    const std::string_view rest = trimmed(text.substr(3));
    if (rest.empty() || rest.front() != ',') return;
    origin_line_ = talker_.line();
    origin_ = path_.origins().text(file_, origin_line_, comment.column);
    add(step::Note{std::string(trimmed(rest.substr(1)))});
    return;
  }
  if (begins_with(text, "STOCK")) {
    stock_.read(text, modes_.scale, talker_.spot(comment.column), talker_.diagnostics());
    return;
  }
  if (read_tool_remark(text, talker_.spot(comment.column))) return;
  tool_comments_.read(text, modes_.scale, talker_.spot(comment.column), talker_.diagnostics());
}

/// True for a remark that tells a tool. Those of a program's head wait until its units are known.
bool Interpreter::read_tool_remark(std::string_view text, const TextSpot& where) {
  if (text.size() < 5 || !read_remark(text, modes_.scale)) return false;
  if (units_told_ || moved_) {
    use_tool_remark(text, where);
  } else if (waiting_remarks_.size() < kMostWaiting) {
    waiting_remarks_.emplace_back(std::string(text), where);
  }
  return true;
}

void Interpreter::use_waiting_remarks() {
  for (const auto& [text, where] : waiting_remarks_) use_tool_remark(text, where);
  waiting_remarks_.clear();
}

/// A remark counts where no comment that is meant for programs describes the tool. Without a number it is
/// the tool of a program that changes none: number 0.
void Interpreter::use_tool_remark(std::string_view text, const TextSpot& where) {
  const std::optional<ToolRemark> remark = read_remark(text, modes_.scale);
  const int number = remark ? remark->number.value_or(0) : 0;
  if (!remark || program_.tools.count(number) != 0) return;
  tool_comments_.describe(number, remark->shape, where, talker_.diagnostics());
  const auto tool = program_.tools.find(number);
  if (tool == program_.tools.end()) return;
  tool->second.description = std::string(text);
  talker_.diagnostics().note(Code::tool_from_remark, where,
                             fmt::format("tool {} was taken from this remark: {}, diameter {:g} mm", number,
                                         name_of(tool->second.shape), tool->second.diameter.mm()));
}

}  // namespace kerf::gcode
