// The words of OpenSCAD texts.
#pragma once

#include <string>
#include <string_view>

#include "front/scad/text/source.h"

namespace kerf::scad {

enum class Word : std::uint8_t {
  end,
  name,
  number,
  string,
  file,  // of use: <name>
  key_module,
  key_function,
  key_if,
  key_else,
  key_let,
  key_assert,
  key_echo,
  key_for,
  key_each,
  key_true,
  key_false,
  key_undef,
  key_use,
  key_include,
  less_equal,
  greater_equal,
  equal,
  not_equal,
  both,
  either,
  sign,  // a single character, see Token::sign
};

struct Token {
  Word word = Word::end;
  char sign = 0;
  double number = 0.0;
  std::string text;  // of a name, the content of a string, the name of a file
  Position at;
  bool is(char c) const { return word == Word::sign && sign == c; }
};
/// For messages: "name \"x\"", "\";\"", "end of file".
std::string describe(const Token& token);

/// Reads the words of one source. Errors (a character without meaning, an open comment or string) are
/// reported, and reading continues after them.
class Lexer {
 public:
  Lexer(const Sources& sources, std::uint32_t source, Diagnostics& diagnostics);
  Token next();

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool at_end() const { return at_ >= text_.size(); }
  void advance();
  void skip_space();
  void skip_comment();
  Position position() const { return {source_, line_, column_}; }
  void error(Position at, std::string message);
  Token name_or_number();
  Token string();
  void escape(std::string& out);
  Token sign();
  Token file_name(Word keyword, Position at);

  const Sources& sources_;
  std::uint32_t source_;
  std::string_view text_;
  Diagnostics& diagnostics_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1, column_ = 1;
  Word pending_file_ = Word::end;
};

}  // namespace kerf::scad
