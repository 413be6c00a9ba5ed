// Words and lengths of the comments that CAM programs write for the operator.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::gcode {

enum class CommentUnit : std::uint8_t { none, mm, inch, degrees };

/// A word in capitals, a number with its unit, or a sign.
struct CommentToken {
  enum class Kind : std::uint8_t { word, number, sign };
  Kind kind{};
  std::string text;  // of a word or a sign
  double value = 0.0;
  CommentUnit unit = CommentUnit::none;
  bool whole = false;  // a number of digits only

  bool is(std::string_view word) const { return kind != Kind::number && text == word; }
  bool is_number() const { return kind == Kind::number; }
};

/// Splits a comment: "1-1/4" in Mill" is the number 31.75 mm in inches and the word MILL; "D10" is D and 10,
/// "0.3mm30degree" two numbers. Fractions are in inches. Values of lengths with a unit are in mm, those
/// without one as written.
std::vector<CommentToken> comment_tokens(std::string_view text);

/// True if the words follow each other, with signs between them allowed.
bool contains_words(const std::vector<CommentToken>& tokens, std::initializer_list<std::string_view> words);

/// The number after a word and its signs, as in "Diameter: 3.0 mm", "D=10" and "Diam = 3mm".
const CommentToken* number_after(const std::vector<CommentToken>& tokens, std::string_view word);
/// The number before a word, as in "10.0 dia.".
const CommentToken* number_before(const std::vector<CommentToken>& tokens, std::string_view word);

}  // namespace kerf::gcode
