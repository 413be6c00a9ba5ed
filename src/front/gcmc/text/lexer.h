// Words of a gcmc program. The lexer continues after an error, so that one run reports all of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "front/gcmc/value/value.h"

#include "kerf/base/diagnostics.h"

namespace kerf::gcmc {

/// A location in a source: index of the file, line and column from 1.
struct SourceLocation {
  std::uint32_t line = 0;
  std::uint16_t file = 0;
  std::uint16_t column = 0;  // 65535: that or more
};

enum class Token : std::uint8_t {
  end,
  identifier,
  integer,
  real,
  string,
  // keywords
  kw_break,
  kw_const,
  kw_continue,
  kw_deg,
  kw_do,
  kw_elif,
  kw_else,
  kw_for,
  kw_foreach,
  kw_function,
  kw_if,
  kw_in,
  kw_include,
  kw_local,
  kw_mil,
  kw_mm,
  kw_rad,
  kw_repeat,
  kw_return,
  kw_while,
  // punctuation
  plus,
  minus,
  star,
  slash,
  percent,
  plus_plus,
  minus_minus,
  add_or,
  sub_or,
  bang,
  tilde,
  amp,
  pipe,
  caret,
  shift_left,
  shift_right,
  and_and,
  or_or,
  equal,
  not_equal,
  less,
  greater,
  less_equal,
  greater_equal,
  assign,
  plus_assign,
  minus_assign,
  star_assign,
  slash_assign,
  percent_assign,
  shift_left_assign,
  shift_right_assign,
  amp_assign,
  pipe_assign,
  caret_assign,
  add_or_assign,
  sub_or_assign,
  question,
  colon,
  comma,
  semicolon,
  dot,
  left_paren,
  right_paren,
  left_bracket,
  right_bracket,
  left_brace,
  right_brace,
};

/// A token with its location; `after` is the column after it, where syntax errors are reported.
struct Word {
  Token token = Token::end;
  SourceLocation at;
  SourceLocation after;
  std::string_view text;  // of identifiers, and for messages
  Scalar number;          // integer and real
  std::u32string string;
  bool unterminated = false;  // a string without closing quote, which may contain the words that follow
};

/// Receives the messages of lexer and parser.
struct SourceReport {
  virtual ~SourceReport() = default;
  virtual void error(SourceLocation at, Code code, std::string message, std::string hint = {}) = 0;
  virtual void warning(SourceLocation at, Code code, std::string message) = 0;
  /// An error after which the source cannot be read any further.
  virtual void fatal(SourceLocation at, Code code, std::string message) = 0;
};

class Lexer {
 public:
  Lexer(std::string_view source, std::uint16_t file, SourceReport& report);
  Word next();
  SourceLocation location() const;

 private:
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0';
  }
  bool ended() const { return at_ >= source_.size(); }
  void skip_space();
  void skip_block_comment();
  bool number(Word& word);
  bool hexadecimal(Word& word);
  bool real(Word& word, std::size_t start);
  void string(Word& word);
  bool string_piece(std::string& bytes);
  void unterminated_string();
  void escape(std::string& bytes, std::size_t& zeros_from);
  void octal(std::string& bytes, std::size_t& zeros_from);
  void check_utf8(const std::string& bytes);
  void identifier(Word& word);
  bool punctuation(Word& word);
  void bad_character();
  void newline();

  std::string_view source_;
  SourceReport& report_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  std::uint32_t line_ = 1;
  std::uint16_t file_;
};

/// True for reserved words.
bool is_keyword(std::string_view word);

}  // namespace kerf::gcmc
