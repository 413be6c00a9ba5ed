// The forms of comments: a comment has one only if all of its words fit, from the first to the last.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "front/gcode/comments/comment_words.h"

namespace kerf::gcode {

/// Kinds of tools of which a diameter and an angle or radius give the profile.
enum class ToolKind : unsigned char { square, ball, bull_nose, vee, drill };

/// What a form has found in a comment.
struct FormMatch {
  std::optional<int> number;  // of the tool
  std::optional<ToolKind> kind;
  std::vector<CommentToken> lengths;  // in the order of the form
  std::optional<double> angle;        // degrees
  std::optional<CommentToken> tip;    // a diameter or radius of the tip
};

/// Matches a comment with a form, whose elements are separated by blanks: a word or a sign; @number (of a
/// tool), @length (with a unit), @size (with or without), @count (of no meaning), @nominal (a size
/// in a name, of no meaning), @angle, @tip, @kind (the
/// name of a kind of tool), @adjectives (none or more), @quoted (up to the next quote; a kind, an angle and a
/// tip in it are found), @rest (anything). A ? before an element makes it optional.
std::optional<FormMatch> match_form(const std::vector<CommentToken>& tokens, std::string_view form);

}  // namespace kerf::gcode
