// The comments of Kerf's own posts.
#include "front/gcode/comments/own_comments.h"

#include <algorithm>
#include <utility>

#include "base/ending.h"
#include "base/names.h"
#include "tool/tool_description.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxDigits = 9;
constexpr std::size_t kMaxDescription = std::size_t{64} * 1024;  // bytes, of a drawn profile

/// Removes a word and the number after it, "tool 2", from the start of a text.
std::optional<int> take_number(std::string_view& text, std::string_view before) {
  if (text.substr(0, before.size()) != before) return std::nullopt;
  const std::string_view rest = text.substr(before.size());
  const std::size_t end = std::min(rest.find_first_not_of("0123456789"), rest.size());
  if (end == 0 || end > kMaxDigits) return std::nullopt;
  text = rest.substr(end);
  return std::stoi(std::string(rest.substr(0, end)));
}

/// A comment of a post for a controller that has capital letters only; others as they are.
std::string in_small_letters(std::string_view text) {
  std::string out(text);
  const auto is_small = [](char c) { return c >= 'a' && c <= 'z'; };
  if (std::none_of(out.begin(), out.end(), is_small))
    std::transform(out.begin(), out.end(), out.begin(), small_letter);
  return out;
}

}  // namespace

std::optional<OwnComment> OwnComments::read(std::string_view text, const Origin& where,
                                            Diagnostics& diagnostics) {
  const std::string small = in_small_letters(text);
  text = small;
  std::string joined;
  if (!joined_.empty() && joined_.size() < kMaxDescription) {
    joined = std::exchange(joined_, {}) + " " + std::string(text);
    text = joined;
  }
  joined_.clear();
  std::string_view rest = text;
  if (const auto number = take_number(rest, "change to tool ")) {
    if (!trim(rest).empty()) return std::nullopt;
    OwnComment own;
    own.change_to = number;
    return own;
  }
  if (take_number(rest, "touch-off of tool ")) {
    if (rest != ": the zero in Z stays") return std::nullopt;
    OwnComment own;
    own.zero_stays = true;
    return own;
  }
  const auto number = take_number(rest, "tool ");
  constexpr std::string_view kAtStart = " at the start";
  const bool at_start = rest.starts_with(kAtStart);
  if (at_start) rest.remove_prefix(kAtStart.size());
  if (!number || rest.substr(0, 2) != ": ") return std::nullopt;
  rest = trim(rest.substr(2));
  if (!starts_tool_description(rest)) return std::nullopt;
  if (rest.back() == ',') {
    joined_ = std::string(text);
    return OwnComment{};
  }
  auto tool = read_tool_description(rest, *number, where, diagnostics);
  if (!tool) return std::nullopt;
  OwnComment own;
  own.tool = std::move(tool), own.at_start = at_start;
  return own;
}

}  // namespace kerf::gcode
