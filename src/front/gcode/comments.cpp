// Comments that mean something: tools, the stock, messages for the operator.
#include <string>

#include "front/gcode/interpreter.h"

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

}  // namespace

void Interpreter::read_comment(const Comment& comment) {
  const std::string_view text = trimmed(comment.text);
  if (text.size() > kLongestComment) return;
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
  if (!begins_with(text, "TOOL")) return;
  const TextSpot where = talker_.spot(comment.column);
  const auto shape = read_tool_comment(text, modes_.scale, where, talker_.diagnostics());
  if (!shape) return;
  if (undescribed_tool_) {
    describe_tool(*undescribed_tool_, *shape, where);
    undescribed_tool_.reset();
    return;
  }
  pending_shape_ = shape;
  pending_spot_ = where;
}

void Interpreter::describe_tool(int number, const ToolShape& shape, const TextSpot& where) {
  if (auto tool = make_tool(number, shape, ToolBody{}, where, talker_.diagnostics()))
    program_.tools.insert_or_assign(number, std::move(*tool));
}

}  // namespace kerf::gcode
