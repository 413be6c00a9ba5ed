// The lexer of gcmc programs.
#include "front/gcmc/text/lexer.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <iterator>

#include "base/codes/gcmc.h"
#include "base/number.h"

namespace kerf::gcmc {
namespace {

struct Keyword {
  std::string_view text;
  Token token;
};
constexpr Keyword kKeywords[] = {
    {"break", Token::kw_break},
    {"const", Token::kw_const},
    {"continue", Token::kw_continue},
    {"deg", Token::kw_deg},
    {"do", Token::kw_do},
    {"elif", Token::kw_elif},
    {"else", Token::kw_else},
    {"for", Token::kw_for},
    {"foreach", Token::kw_foreach},
    {"function", Token::kw_function},
    {"if", Token::kw_if},
    {"in", Token::kw_in},
    {"include", Token::kw_include},
    {"local", Token::kw_local},
    {"mil", Token::kw_mil},
    {"mm", Token::kw_mm},
    {"rad", Token::kw_rad},
    {"repeat", Token::kw_repeat},
    {"return", Token::kw_return},
    {"while", Token::kw_while},
};

/// The longer first where one is a prefix of another.
constexpr Keyword kPunctuation[] = {
    {"<<=", Token::shift_left_assign},
    {">>=", Token::shift_right_assign},
    {"+|=", Token::add_or_assign},
    {"-|=", Token::sub_or_assign},
    {"++", Token::plus_plus},
    {"--", Token::minus_minus},
    {"+|", Token::add_or},
    {"-|", Token::sub_or},
    {"&&", Token::and_and},
    {"||", Token::or_or},
    {"<<", Token::shift_left},
    {">>", Token::shift_right},
    {"==", Token::equal},
    {"!=", Token::not_equal},
    {"<=", Token::less_equal},
    {">=", Token::greater_equal},
    {"+=", Token::plus_assign},
    {"-=", Token::minus_assign},
    {"*=", Token::star_assign},
    {"/=", Token::slash_assign},
    {"%=", Token::percent_assign},
    {"&=", Token::amp_assign},
    {"|=", Token::pipe_assign},
    {"^=", Token::caret_assign},
    {"+", Token::plus},
    {"-", Token::minus},
    {"*", Token::star},
    {"/", Token::slash},
    {"%", Token::percent},
    {"!", Token::bang},
    {"~", Token::tilde},
    {"&", Token::amp},
    {"|", Token::pipe},
    {"^", Token::caret},
    {"<", Token::less},
    {">", Token::greater},
    {"=", Token::assign},
    {"?", Token::question},
    {":", Token::colon},
    {",", Token::comma},
    {";", Token::semicolon},
    {".", Token::dot},
    {"(", Token::left_paren},
    {")", Token::right_paren},
    {"[", Token::left_bracket},
    {"]", Token::right_bracket},
    {"{", Token::left_brace},
    {"}", Token::right_brace},
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_octal(char c) { return c >= '0' && c <= '7'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\r'; }
bool is_name_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name(char c) { return is_name_start(c) || is_digit(c); }
unsigned hex_value(char c) {
  return static_cast<unsigned>(is_digit(c) ? c - '0' : c >= 'a' ? c - 'a' + 10 : c - 'A' + 10);
}

}  // namespace

bool is_keyword(std::string_view word) {
  return std::any_of(std::begin(kKeywords), std::end(kKeywords),
                     [&](const Keyword& k) { return k.text == word; });
}

Lexer::Lexer(std::string_view source, std::uint16_t file, SourceReport& report)
    : source_(source), report_(report), file_(file) {
  if (source_.substr(0, 3) == "\xEF\xBB\xBF")
    at_ = line_start_ = 3;  // a byte order mark is not part of the program
}

SourceLocation Lexer::location() const {
  const std::size_t column = at_ - line_start_ + 1;
  return {line_, file_, static_cast<std::uint16_t>(std::min<std::size_t>(column, 65535))};
}

void Lexer::newline() {
  ++at_;
  ++line_;
  line_start_ = at_;
}

void Lexer::skip_block_comment() {
  at_ += 2;
  while (!ended()) {
    if (peek() == '*' && peek(1) == '/') {
      at_ += 2;
      return;
    }
    if (peek() == '\n')
      newline();
    else
      ++at_;
  }
  report_.fatal(location(), codes::gcmc_text_end, "Unexpected EOF");
}

void Lexer::skip_space() {
  while (!ended()) {
    if (peek() == '\n')
      newline();
    else if (is_space(peek()))
      ++at_;
    else if (peek() == '/' && peek(1) == '/')
      at_ = std::min(source_.find('\n', at_), source_.size());
    else if (peek() == '/' && peek(1) == '*')
      skip_block_comment();
    else
      return;
  }
}

Word Lexer::next() {
  Word word;
  for (;;) {
    skip_space();
    word.at = location();
    const std::size_t start = at_;
    bool good = true;
    if (ended())
      word.token = Token::end;
    else if (is_name_start(peek()))
      identifier(word);
    else if (is_digit(peek()) || (peek() == '.' && is_digit(peek(1))))
      good = number(word);
    else if (peek() == '"')
      string(word);
    else
      good = punctuation(word);
    word.after = location();
    if (word.token != Token::identifier) word.text = source_.substr(start, at_ - start);
    if (good) return word;
  }
}

void Lexer::identifier(Word& word) {
  const std::size_t start = at_;
  while (is_name(peek())) ++at_;
  word.text = source_.substr(start, at_ - start);
  word.token = Token::identifier;
  for (const Keyword& k : kKeywords)
    if (k.text == word.text) word.token = k.token;
}

bool Lexer::punctuation(Word& word) {
  for (const Keyword& p : kPunctuation) {
    if (source_.substr(at_, p.text.size()) != p.text) continue;
    at_ += p.text.size();
    word.token = p.token;
    return true;
  }
  bad_character();
  return false;
}

void Lexer::bad_character() {
  const char c = peek();
  ++at_;
  const auto code = static_cast<unsigned char>(c);
  const std::string shown = code >= 0x20 && code < 0x7F ? std::string(1, c) : fmt::format("\\x{:02x}", code);
  report_.error(location(), codes::gcmc_word,
                fmt::format("Illegal character in text '{}' (0x{:02x})", shown, code));
}

// ---- numbers

bool Lexer::hexadecimal(Word& word) {
  const std::size_t start = at_;
  at_ += 2;
  std::uint64_t value = 0;
  bool wide = false;
  while (is_hex(peek())) {
    value = value << 4 | hex_value(peek());
    wide = wide || value > 0xFFFFFFFFu;
    value &= 0xFFFFFFFFu;
    ++at_;
  }
  if (at_ == start + 2 || is_name(peek())) {
    while (!ended() && !is_space(peek()) && peek() != '\n') ++at_;
    report_.error(location(), codes::gcmc_word,
                  fmt::format("Bad hexadecimal number '{}'", source_.substr(start, at_ - start)));
    return false;
  }
  if (wide)
    report_.warning(location(), codes::gcmc_number_wraps,
                    "Hexadecimal number does not fit 32 bits, upper bits lost");
  word.token = Token::integer;
  word.number = Scalar::integer(static_cast<std::int32_t>(static_cast<std::uint32_t>(value)));
  return true;
}

bool Lexer::real(Word& word, std::size_t start) {
  if (peek() == '.') ++at_;
  while (is_digit(peek())) ++at_;
  if (peek() == 'e' || peek() == 'E') {
    ++at_;
    if (peek() == '+' || peek() == '-') ++at_;
    if (!is_digit(peek())) {
      report_.error(location(), codes::gcmc_word,
                    fmt::format("Bad floating point number '{}', missing exponent magnitude",
                                source_.substr(start, at_ - start)));
      return false;
    }
    while (is_digit(peek())) ++at_;
  }
  const std::optional<double> value = parse_number(source_.substr(start, at_ - start));
  if (!value) {
    report_.error(location(), codes::gcmc_word,
                  fmt::format("Number '{}' is too large",
                              source_.substr(start, std::min<std::size_t>(at_ - start, 40))));
    return false;
  }
  word.token = Token::real;
  word.number = Scalar::real(*value);
  return true;
}

bool Lexer::number(Word& word) {
  if (peek() == '0' && peek(1) == 'x') return hexadecimal(word);
  const std::size_t start = at_;
  std::uint32_t value = 0;
  bool wide = false;
  while (is_digit(peek())) {
    const std::uint64_t more = std::uint64_t{value} * 10 + static_cast<unsigned>(peek() - '0');
    wide = wide || more > 0x7FFFFFFFu;
    value = static_cast<std::uint32_t>(more);
    ++at_;
  }
  if (peek() == '.' || peek() == 'e' || peek() == 'E') return real(word, start);
  if (wide) {
    report_.warning(location(), codes::gcmc_number_wraps,
                    fmt::format("Integer '{}' does not fit 32 bits and becomes {}",
                                source_.substr(start, std::min<std::size_t>(at_ - start, 40)),
                                static_cast<std::int32_t>(value)));
  }
  word.token = Token::integer;
  word.number = Scalar::integer(static_cast<std::int32_t>(value));
  return true;
}

// ---- strings

void Lexer::octal(std::string& bytes, std::size_t& zeros_from) {
  unsigned value = 0;
  int digits = 0;
  for (; digits < 3 && is_octal(peek()); ++digits, ++at_)
    value = value * 8 + static_cast<unsigned>(peek() - '0');
  if (is_digit(peek())) {
    while (is_digit(peek())) ++at_;
    report_.error(location(), codes::gcmc_word, "Bad escape sequence");
    return;
  }
  if (value == 0) report_.error(location(), codes::gcmc_word, "Embedded '\\0' character not allowed");
  if (value > 255) report_.error(location(), codes::gcmc_word, "Character constant out of range");
  if ((value & 255) == 0) zeros_from = std::min(zeros_from, bytes.size());
  bytes += static_cast<char>(value & 255);
}

void Lexer::escape(std::string& bytes, std::size_t& zeros_from) {
  static constexpr std::string_view kLetters = "abfnrtv";
  static constexpr std::string_view kMeanings = "\a\b\f\n\r\t\v";
  ++at_;
  const char c = peek();
  if (is_octal(c)) return octal(bytes, zeros_from);
  if (c == '\n') {
    newline();
    while (is_space(peek())) ++at_;
    return;
  }
  ++at_;
  if (c == 'x') {
    if (is_hex(peek()) && is_hex(peek(1))) {
      const auto value = static_cast<char>(hex_value(peek()) << 4 | hex_value(peek(1)));
      at_ += 2;
      if (value == '\0') {
        report_.error(location(), codes::gcmc_word, "Embedded '\\0' character not allowed");
        zeros_from = std::min(zeros_from, bytes.size());
      }
      bytes += value;
      return;
    }
    std::string seen = "\\x";
    if (is_hex(peek())) seen += peek(), ++at_;
    report_.error(location(), codes::gcmc_word, fmt::format("Invalid hex escape sequence '{}'", seen));
    return;
  }
  const std::size_t letter = kLetters.find(c);
  bytes += letter == std::string_view::npos ? c : kMeanings[letter];
}

/// Reports that the line or the file ends before the closing quote. Reading continues with the next line.
void Lexer::unterminated_string() {
  if (!ended()) {
    ++at_;
    report_.error(location(), codes::gcmc_word, "Unterminated string");
  }
  if (ended())
    report_.fatal(location(), codes::gcmc_text_end, "Unexpected EOF");
  else
    --at_;
}

/// Reads up to the closing quote; false if the line or the file ends before it.
bool Lexer::string_piece(std::string& bytes) {
  std::size_t zeros_from = std::string::npos;
  ++at_;
  for (;;) {
    if (ended() || peek() == '\n') {
      unterminated_string();
      return false;
    }
    const char c = peek();
    if (c == '"') {
      ++at_;
      break;
    }
    if (c == '\\') {
      escape(bytes, zeros_from);
      continue;
    }
    if (c == '\0') {
      report_.error(location(), codes::gcmc_word, "Embedded '\\0' character not allowed");
      zeros_from = std::min(zeros_from, bytes.size());
    }
    bytes += c;
    ++at_;
  }
  if (zeros_from != std::string::npos) {
    report_.warning(location(), codes::gcmc_text_encoding,
                    fmt::format("Skipping embedded UTF-8 NUL embedding {}/{}", bytes.size(), zeros_from));
  }
  return true;
}

void Lexer::check_utf8(const std::string& bytes) {
  std::string again;
  for (char32_t c : from_utf8(bytes)) append_utf8(again, c);
  if (again == bytes) return;
  if (again.size() < bytes.size()) {  // decodes, but is not the shortest encoding
    report_.warning(location(), codes::gcmc_text_encoding, "String has over-long UTF-8 sequences");
    return;
  }
  report_.error(location(), codes::gcmc_text_encoding, "String is not valid UTF-8");
}

void Lexer::string(Word& word) {
  std::string bytes;
  word.token = Token::string;
  for (;;) {
    word.unterminated = !string_piece(bytes);
    if (word.unterminated) break;
    std::size_t after = at_;  // adjacent literals on the same line are concatenated
    while (after < source_.size() && is_space(source_[after])) ++after;
    if (after >= source_.size() || source_[after] != '"') break;
    at_ = after;
  }
  bytes.erase(std::remove(bytes.begin(), bytes.end(), '\0'), bytes.end());
  check_utf8(bytes);
  word.string = from_utf8(bytes);
}

}  // namespace kerf::gcmc
