// Splitting comments into words and lengths.
#include "front/gcode/comments/comment_words.h"

#include <algorithm>
#include <cctype>

#include "base/number.h"

#include "kerf/base/units.h"

namespace kerf::gcode {
namespace {

constexpr std::size_t kMaxTokens = 60;  // of a comment that describes a tool or a stock
constexpr std::size_t kMaxDigits = 15;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || (static_cast<unsigned char>(c) & 0x80u) != 0;
}

class CommentScanner {
 public:
  explicit CommentScanner(std::string_view text) : text_(text) {}

  std::vector<CommentToken> run() {
    while (at_ < text_.size() && tokens_.size() < kMaxTokens) {
      const char c = text_[at_];
      if (is_digit(c) || ((c == '.' || c == '-') && starts_number()))
        number();
      else if (is_letter(c))
        word();
      else
        sign();
    }
    return std::move(tokens_);
  }

 private:
  char peek(std::size_t ahead) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

  /// A point, or a minus after a sign or a blank, before digits.
  bool starts_number() const {
    if (text_[at_] == '.') return is_digit(peek(1));
    const char before = at_ > 0 ? text_[at_ - 1] : ' ';
    const bool free = before == ' ' || before == ':' || before == '=' || before == ',' || before == '(';
    return free && (is_digit(peek(1)) || (peek(1) == '.' && is_digit(peek(2))));
  }

  std::optional<double> digits() {
    const std::size_t start = at_;
    if (peek(0) == '-') ++at_;
    while (at_ < text_.size() && (is_digit(text_[at_]) || (text_[at_] == '.' && is_digit(peek(1))))) ++at_;
    const std::string_view found = text_.substr(start, std::min(at_ - start, kMaxDigits));
    const std::optional<double> value = parse_number(found);
    whole_ = value && found.find_first_not_of("0123456789") == std::string_view::npos;
    return value;
  }

  void number() {
    const char before = at_ > 0 ? text_[at_ - 1] : ' ';
    const auto value = digits();
    if (!value) return;
    CommentToken token{CommentToken::Kind::number, {}, *value, CommentUnit::none, whole_};
    if (peek(0) == '.') ++at_;                                        // "6."
    const bool is_name = whole_ && (before == '#' || before == 'T');  // of a tool
    if (whole_ && !is_name) fraction(token);
    if (!is_name) unit(token);
    tokens_.push_back(std::move(token));
  }

  /// "/4" after a whole number; "-1/4" and " 1/4" after the whole number of inches.
  void fraction(CommentToken& token) {
    std::size_t ahead = 0;
    double whole = 0.0, upper = token.value;
    if ((peek(0) == '-' || peek(0) == ' ') && is_digit(peek(1))) {
      std::size_t end = 1;
      while (is_digit(peek(end))) ++end;
      if (peek(end) != '/' || end > 4) return;
      whole = token.value;
      upper = parse_number(text_.substr(at_ + 1, end - 1)).value_or(0.0);
      ahead = end;
    }
    if (peek(ahead) != '/' || !is_digit(peek(ahead + 1))) return;
    std::size_t end = ahead + 1;
    while (is_digit(peek(end))) ++end;
    const auto lower = parse_number(text_.substr(at_ + ahead + 1, end - ahead - 1));
    if (!lower || !(*lower > 0.0) || *lower > 128.0 || upper >= *lower) return;
    at_ += end;
    token.value = (whole + upper / *lower) * kMmPerInch;
    token.unit = CommentUnit::inch;
    token.whole = false;
  }

  /// Takes a unit after blanks; "in" only as a whole word.
  void unit(CommentToken& token) {
    std::size_t blanks = 0;
    while (peek(blanks) == ' ' || (blanks == 0 && peek(0) == '-')) ++blanks;
    const std::string_view rest = text_.substr(std::min(at_ + blanks, text_.size()));
    struct Name {
      std::string_view name;
      CommentUnit unit;
    };
    constexpr Name kNames[] = {
        {"MILLIMETERS", CommentUnit::mm}, {"MM", CommentUnit::mm},           {"INCHES", CommentUnit::inch},
        {"INCH", CommentUnit::inch},      {"IN", CommentUnit::inch},         {"\"", CommentUnit::inch},
        {"''", CommentUnit::inch},        {"DEGREES", CommentUnit::degrees}, {"DEGREE", CommentUnit::degrees},
        {"DEG", CommentUnit::degrees},    {"\xc2\xb0", CommentUnit::degrees}};
    for (const Name& n : kNames) {
      if (rest.substr(0, n.name.size()) != n.name) continue;
      const char next = rest.size() > n.name.size() ? rest[n.name.size()] : '\0';
      if (is_letter(n.name.front()) && n.unit != CommentUnit::degrees && is_letter(next)) continue;
      const bool fraction_of_inch = token.unit == CommentUnit::inch;
      if (fraction_of_inch && n.unit != CommentUnit::inch) return;
      at_ += blanks + n.name.size();
      if (n.unit == CommentUnit::inch && !fraction_of_inch) token.value *= kMmPerInch;
      token.unit = n.unit;
      token.whole = false;
      return;
    }
  }

  void word() {
    const std::size_t start = at_;
    while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
    tokens_.push_back({CommentToken::Kind::word, std::string(text_.substr(start, at_ - start))});
  }

  void sign() {
    const char c = text_[at_++];
    if (c != ' ' && c != '\t' && c != '_') tokens_.push_back({CommentToken::Kind::sign, std::string(1, c)});
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool whole_ = false;
  std::vector<CommentToken> tokens_;
};

bool is_sign(const CommentToken& token) { return token.kind == CommentToken::Kind::sign; }

}  // namespace

std::vector<CommentToken> comment_tokens(std::string_view text) {
  std::string capitals(text);
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return CommentScanner(capitals).run();
}

bool contains_words(const std::vector<CommentToken>& tokens, std::initializer_list<std::string_view> words) {
  for (std::size_t first = 0; first < tokens.size(); ++first) {
    std::size_t at = first;
    auto word = words.begin();
    for (; word != words.end() && at < tokens.size(); ++at) {
      if (tokens[at].is(*word))
        ++word;
      else if (!is_sign(tokens[at]) || at == first)
        break;
    }
    if (word == words.end()) return true;
  }
  return false;
}

const CommentToken* number_after(const std::vector<CommentToken>& tokens, std::string_view word) {
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (!tokens[i].is(word)) continue;
    std::size_t at = i + 1;
    while (at < tokens.size() && is_sign(tokens[at])) ++at;
    if (at < tokens.size() && tokens[at].is_number()) return &tokens[at];
  }
  return nullptr;
}

const CommentToken* number_before(const std::vector<CommentToken>& tokens, std::string_view word) {
  for (std::size_t i = 1; i < tokens.size(); ++i)
    if (tokens[i].is(word) && tokens[i - 1].is_number()) return &tokens[i - 1];
  return nullptr;
}

}  // namespace kerf::gcode
