// Bytes to words: names, numbers, strings with their escapes, signs.
#include "front/scad/text/lexer.h"

#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <map>

#include "base/codes/scad.h"
#include "base/number.h"

namespace kerf::scad {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

const std::map<std::string, Word, std::less<>>& keywords() {
  static const std::map<std::string, Word, std::less<>> all{
      {"module", Word::key_module}, {"function", Word::key_function}, {"if", Word::key_if},
      {"else", Word::key_else},     {"let", Word::key_let},           {"assert", Word::key_assert},
      {"echo", Word::key_echo},     {"for", Word::key_for},           {"each", Word::key_each},
      {"true", Word::key_true},     {"false", Word::key_false},       {"undef", Word::key_undef},
      {"use", Word::key_use},       {"include", Word::key_include}};
  return all;
}

void append_utf8(std::string& out, unsigned code) {
  const auto byte = [&](unsigned b) { out += static_cast<char>(static_cast<unsigned char>(b)); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xc0 | code >> 6);
    byte(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    byte(0xe0 | code >> 12);
    byte(0x80 | (code >> 6 & 0x3f));
    byte(0x80 | (code & 0x3f));
  } else {
    byte(0xf0 | code >> 18);
    byte(0x80 | (code >> 12 & 0x3f));
    byte(0x80 | (code >> 6 & 0x3f));
    byte(0x80 | (code & 0x3f));
  }
}

/// The length of the number at the start of `text`: digits with a point and an exponent; 0 if there is none.
std::size_t number_length(std::string_view text) {
  std::size_t i = 0, digits = 0;
  const auto take_digits = [&] {
    for (; i < text.size() && is_digit(text[i]); ++i) ++digits;
  };
  take_digits();
  if (i < text.size() && text[i] == '.') {
    ++i;
    take_digits();
  }
  if (digits == 0) return 0;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    std::size_t e = i + 1;
    if (e < text.size() && (text[e] == '+' || text[e] == '-')) ++e;
    if (e < text.size() && is_digit(text[e])) {
      while (e < text.size() && is_digit(text[e])) ++e;
      i = e;
    }
  }
  return i;
}

}  // namespace

std::string describe(const Token& token) {
  switch (token.word) {
    case Word::end: return "the end of the text";
    case Word::number: return fmt::format("number {}", token.text);
    case Word::string: return "a string";
    case Word::file: return fmt::format("<{}>", token.text);
    case Word::name: return fmt::format("\"{}\"", token.text);
    case Word::less_equal: return "\"<=\"";
    case Word::greater_equal: return "\">=\"";
    case Word::equal: return "\"==\"";
    case Word::not_equal: return "\"!=\"";
    case Word::both: return "\"&&\"";
    case Word::either: return "\"||\"";
    case Word::sign: return fmt::format("\"{}\"", token.sign);
    default: break;
  }
  return fmt::format("\"{}\"", token.text);
}

Lexer::Lexer(const Sources& sources, std::uint32_t source, Diagnostics& diagnostics)
    : sources_(sources), source_(source), text_(sources[source].text), diagnostics_(diagnostics) {
  if (text_.substr(0, 3) == "\xef\xbb\xbf") at_ = 3;  // byte order mark
}

void Lexer::error(Position at, std::string message) {
  diagnostics_.error(codes::scad_syntax, sources_.locate(at), std::move(message));
}

void Lexer::advance() {
  if (text_[at_] == '\n') {
    ++line_;
    column_ = 1;
  } else {
    ++column_;
  }
  ++at_;
}

void Lexer::skip_comment() {
  const Position start = position();
  if (peek(1) == '/') {
    while (!at_end() && peek() != '\n') advance();
    return;
  }
  advance();
  advance();
  while (!at_end()) {
    if (peek() == '*' && peek(1) == '/') {
      advance();
      advance();
      return;
    }
    advance();
  }
  error(start, "the comment has no \"*/\"");
}

void Lexer::skip_space() {
  while (!at_end()) {
    const char c = peek();
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      advance();
    } else if (c == '/' && (peek(1) == '/' || peek(1) == '*')) {
      skip_comment();
    } else if (text_.substr(at_, 2) == "\xc2\xa0" || text_.substr(at_, 3) == "\xef\xbb\xbf") {
      at_ += c == '\xc2' ? 2 : 3;  // a no-break space or byte order mark, pasted from a document
    } else if (c == '\xa0') {
      ++at_;  // a no-break space in Latin-1
      ++column_;
    } else {
      return;
    }
  }
}

Token Lexer::next() {
  skip_space();
  if (pending_file_ != Word::end) {
    const Word keyword = std::exchange(pending_file_, Word::end);
    if (peek() == '<') return file_name(keyword, position());
  }
  const char c = peek();
  if (at_end()) {
    Token end;
    end.at = position();
    return end;
  }
  if (is_name(c) || (c == '.' && is_digit(peek(1))) || (c == '$' && is_name(peek(1))))
    return name_or_number();
  if (c == '"') return string();
  return sign();
}

Token Lexer::name_or_number() {
  Token token;
  token.at = position();
  std::size_t name = peek() == '$' ? 1 : 0;
  while (is_name(peek(name))) ++name;
  const std::size_t number = number_length(text_.substr(at_));
  const bool is_number = number > 0 && number >= name;  // "2d" is a name, "2e3" a number
  token.text = std::string(text_.substr(at_, is_number ? number : name));
  for (std::size_t i = 0; i < token.text.size(); ++i) advance();
  if (is_number) {
    token.word = Word::number;
    // Too large for a double: not a number, as no arithmetic on it would be.
    std::string text = token.text;
    if (const std::size_t e = text.find_first_of("eE");
        text.back() == '.' || (e != std::string::npos && e > 0 && text[e - 1] == '.'))
      text.insert(e == std::string::npos ? text.size() : e, "0");
    const auto value = parse_number(text);
    if (!value) error(token.at, fmt::format("number {} is too large", token.text));
    token.number = value.value_or(0.0);
    return token;
  }
  const auto keyword = keywords().find(token.text);
  token.word = keyword == keywords().end() ? Word::name : keyword->second;
  if (token.word == Word::key_use || token.word == Word::key_include) pending_file_ = token.word;
  return token;
}

Token Lexer::file_name(Word keyword, Position at) {
  Token token;
  token.word = Word::file;
  token.at = at;
  advance();
  const std::size_t start = at_;
  while (!at_end() && peek() != '>' && peek() != '\n') advance();
  token.text = std::string(text_.substr(start, at_ - start));
  if (peek() == '>')
    advance();
  else
    error(at,
          fmt::format("no \">\" after the file name of {}", keyword == Word::key_use ? "use" : "include"));
  return token;
}

void Lexer::escape(std::string& out) {
  const char c = peek();
  const Position at = position();
  advance();
  switch (c) {
    case 'n': out += '\n'; return;
    case 't': out += '\t'; return;
    case 'r': out += '\r'; return;
    case '\\': out += '\\'; return;
    case '"': out += '"'; return;
    default: break;
  }
  const std::size_t digits = c == 'x' ? 2 : c == 'u' ? 4 : c == 'U' ? 6 : 0;
  std::string hex;
  while (hex.size() < digits && std::isxdigit(static_cast<unsigned char>(peek(hex.size()))) != 0)
    hex += peek(hex.size());
  const unsigned code =
      hex.size() == digits && digits > 0 ? static_cast<unsigned>(std::stoul(hex, nullptr, 16)) : 0;
  const bool valid = digits > 0 && hex.size() == digits && code < 0x110000 &&
                     (code < 0xd800 || code > 0xdfff) && (c != 'x' || code < 0x80);
  if (!valid) {
    diagnostics_
        .warning(codes::scad_text, sources_.locate(at),
                 fmt::format("\"\\{}\" is no escape sequence; the backslash is left out", c))
        .hint = "write \\\\ for a backslash";
    out += c;
    return;
  }
  for (std::size_t i = 0; i < digits; ++i) advance();
  if (code == 0)
    out += ' ';  // as OpenSCAD: no string holds a zero byte
  else
    append_utf8(out, code);
}

Token Lexer::string() {
  Token token;
  token.word = Word::string;
  token.at = position();
  advance();
  while (!at_end() && peek() != '"') {
    const char c = peek();
    if (c == '\\' && at_ + 1 < text_.size()) {
      advance();
      escape(token.text);
      continue;
    }
    if (c != '\r' && c != '\n' && c != '\0') token.text += c;  // a line break in the text is not part of it
    advance();
  }
  if (at_end())
    error(token.at, "the string has no closing quotation mark");
  else
    advance();
  return token;
}

Token Lexer::sign() {
  static const std::map<std::string, Word, std::less<>> kPairs{
      {"<=", Word::less_equal}, {">=", Word::greater_equal}, {"==", Word::equal},
      {"!=", Word::not_equal},  {"&&", Word::both},          {"||", Word::either}};
  Token token;
  token.at = position();
  if (const auto pair = kPairs.find(text_.substr(at_, 2)); pair != kPairs.end()) {
    token.word = pair->second;
    advance();
    advance();
    return token;
  }
  constexpr std::string_view kSigns = "()[]{}<>=+-*/%^!?:;,.#";
  const char c = peek();
  if (kSigns.find(c) == std::string_view::npos) {
    std::size_t bytes = 1;
    while ((static_cast<unsigned char>(peek(bytes)) & 0xc0u) == 0x80u) ++bytes;
    const std::string shown(text_.substr(at_, bytes));
    error(token.at, static_cast<unsigned char>(c) < 0x20 || c == 0x7f
                        ? fmt::format("control character {} in the text", static_cast<int>(c))
                        : fmt::format("character \"{}\" has no meaning here", shown));
    at_ += bytes;
    ++column_;
    return next();
  }
  token.word = Word::sign;
  token.sign = c;
  advance();
  return token;
}

}  // namespace kerf::scad
