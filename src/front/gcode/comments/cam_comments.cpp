// Tool comments in the order of a program.
#include "front/gcode/comments/cam_comments.h"

#include <algorithm>

#include "base/names.h"
#include "base/number.h"
#include "front/gcode/comments/comment_words.h"
#include "front/gcode/comments/worded_tool_comment.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxCommentBytes = 200;  // bytes

bool has_digit(std::string_view text) { return text.find_first_of("0123456789") != std::string_view::npos; }

/// The value of "name = value"; nothing for other comments.
std::optional<std::string_view> setting(std::string_view text, std::string_view name) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || trim(text.substr(0, equals)) != name) return std::nullopt;
  return trim(text.substr(equals + 1));
}

}  // namespace

/// Forms of several comments; updates the state.
std::optional<CamTool> CamComments::read_settings(std::string_view text, double scale) {
  if (const auto shape = setting(text, "shape")) spherical_ = *shape == "SphericalCutter";
  if (const auto radius = setting(text, "tool_radius")) {
    const auto value = parse_number(*radius);
    if (!value || !(*value > 0.0)) return std::nullopt;
    const Length diameter = mm(2.0 * *value * scale);
    if (spherical_) return CamTool{{}, shape::Ball{diameter, {}}};
    return CamTool{{}, shape::Square{diameter, {}}};
  }
  const bool size_here = size_follows_;
  size_follows_ = fold_name(text) == "toolsize";
  if (!size_here) return std::nullopt;
  const auto size = parse_number(text);
  if (!size || !(*size > 0.0)) return std::nullopt;
  return CamTool{{}, shape::Square{mm(*size * scale), {}}};
}

std::optional<CamTool> CamComments::read(std::string_view text, double scale, bool at_tool_change) {
  text = trim(text);
  if (text.size() > kMaxCommentBytes || comments_left_ == 0) return std::nullopt;
  --comments_left_;
  if (auto tool = read_settings(text, scale)) return tool;
  if (!has_digit(text)) return std::nullopt;
  std::optional<CamTool> tool = read_cam_tool(text, scale);
  if (!tool && !is_other_tool_form(text)) tool = read_worded_tool_comment(text, scale, at_tool_change);
  if (tool) {
    if (!tool->number) tool->number = number_;
    number_.reset();
    return tool;
  }
  const auto tokens = comment_tokens(text);
  if (tokens.size() <= 4 && contains_words(tokens, {"TOOL", "NUMBER"}))
    if (const CommentToken* number = number_after(tokens, "NUMBER"); number != nullptr && number->whole)
      number_ = static_cast<int>(std::min(number->value, 1e8));
  return std::nullopt;
}

}  // namespace kerf::gcode
