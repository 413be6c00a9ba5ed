// Formulas: a recursive descent over sums, products and factors.
#include "base/formula.h"

#include <charconv>
#include <cmath>

#include "base/number.h"

namespace kerf {
namespace {

constexpr int kMaxDepth = 200;  // of brackets and signs

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_number(char c) { return is_digit(c) || c == '.'; }

class Evaluator {
 public:
  Evaluator(std::string_view text, const FormulaWords& words, FormulaFault& fault)
      : text_(text), words_(words), fault_(fault) {}

  std::optional<double> run() {
    const auto value = sum();
    if (!value) return std::nullopt;
    if (peek() != '\0' || at_ < text_.size()) return fail(FormulaFault::Kind::rest);
    if (!std::isfinite(*value)) return fail(FormulaFault::Kind::not_finite);
    return value;
  }

 private:
  std::nullopt_t fail(FormulaFault::Kind kind, std::string symbol = {}) {
    fault_ = {kind, at_, std::move(symbol)};
    return std::nullopt;
  }
  /// The next character after blanks; '\0' at the end.
  char peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  std::optional<double> sum() {
    auto value = product();
    while (value) {
      const char c = peek();
      if (c != '+' && c != '-') break;
      ++at_;
      const auto next = product();
      if (!next) return std::nullopt;
      value = c == '+' ? *value + *next : *value - *next;
    }
    return value;
  }
  std::optional<double> product() {
    auto value = factor();
    while (value) {
      const char c = peek();
      if (c != '*' && c != '/') break;
      ++at_;
      const auto next = factor();
      if (!next) return std::nullopt;
      value = c == '*' ? *value * *next : *value / *next;
    }
    return value;
  }
  std::optional<double> factor() {
    if (++depth_ > kMaxDepth) return fail(FormulaFault::Kind::too_deep);
    const auto value = factor_at_depth();
    --depth_;
    return value;
  }
  std::optional<double> factor_at_depth() {
    const char c = peek();
    if (c == '-' || c == '+') {
      ++at_;
      const auto value = factor();
      return value ? std::optional(c == '-' ? -*value : *value) : std::nullopt;
    }
    if (c == '(' || c == '[') {
      ++at_;
      const auto value = sum();
      if (!value) return std::nullopt;
      const char close = c == '(' ? ')' : ']';
      if (peek() != close) return fail(FormulaFault::Kind::bracket_missing, std::string(1, close));
      ++at_;
      return value;
    }
    if (is_letter(c) && words_.name) return name();
    return c == '#' && words_.variable ? variable() : number();
  }
  std::optional<double> variable() {
    const std::size_t start = at_++;
    int name = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), name);
    if (error != std::errc() || name < 0) {
      at_ = start;
      return fail(FormulaFault::Kind::unexpected);
    }
    if (const auto value = words_.variable(name)) {
      at_ = static_cast<std::size_t>(end - text_.data());
      return value;
    }
    at_ = start;
    return fail(FormulaFault::Kind::unknown_variable, "#" + std::to_string(name));
  }
  std::optional<double> name() {
    const std::size_t end = end_of(at_, [](char c) { return is_letter(c) || is_number(c) || c == '_'; });
    const std::string_view word = text_.substr(at_, end - at_);
    const auto value = words_.name(word);
    if (!value) return fail(FormulaFault::Kind::unknown_variable, std::string(word));
    at_ = end;
    return value;
  }
  std::optional<double> number() {
    const std::size_t end = end_of(at_, is_number);
    if (words_.unit) {
      // The longest number before a unit: "1-1/2in" before "2in".
      const std::size_t above = end_of_part(end, '-'), mixed = above > end ? end_of_part(above, '/') : end;
      for (const std::size_t stop : {mixed > above ? mixed : end, end_of_part(end, '/'), end})
        if (const auto value = measured(stop)) return value;
    }
    const auto value = parse_number(text_.substr(at_, end - at_));
    if (!value) return fail(FormulaFault::Kind::unexpected);
    at_ = end;
    if (words_.unit && is_letter(peek()))
      return fail(FormulaFault::Kind::unknown_unit,
                  std::string(text_.substr(at_, end_of(at_, is_letter) - at_)));
    return value;
  }
  /// The number up to `stop` times the unit that follows it; nothing: none follows.
  std::optional<double> measured(std::size_t stop) {
    const auto value = parse_fraction(text_.substr(at_, stop - at_));
    std::size_t start = stop;
    while (start < text_.size() && text_[start] == ' ') ++start;
    std::size_t end = end_of(start, is_letter);
    if (end == start && start < text_.size() && !is_number(text_[start])) end = start + 1;  // a sign: % "
    if (!value || end == start) return std::nullopt;
    const bool quotient = end + 1 < text_.size() && text_[end] == '/' && is_letter(text_[end + 1]);
    for (const std::size_t last : {quotient ? end_of(end + 1, is_letter) : end, end})
      if (const auto factor = words_.unit(text_.substr(start, last - start))) {
        at_ = last;
        return *value * *factor;
      }
    return std::nullopt;
  }
  template <class Is>
  std::size_t end_of(std::size_t at, Is is) const {
    while (at < text_.size() && is(text_[at])) ++at;
    return at;
  }
  /// The end of digits behind `sign` at `at`; `at` if there is none.
  std::size_t end_of_part(std::size_t at, char sign) const {
    if (at >= text_.size() || text_[at] != sign) return at;
    const std::size_t end = end_of(at + 1, is_digit);
    return end > at + 1 ? end : at;
  }

  std::string_view text_;
  const FormulaWords& words_;
  FormulaFault& fault_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::optional<double> evaluate_formula(std::string_view text, const FormulaWords& words,
                                       FormulaFault& fault) {
  return Evaluator(text, words, fault).run();
}

std::optional<double> evaluate_formula(std::string_view text,
                                       const std::function<std::optional<double>(int)>& value_of,
                                       FormulaFault& fault) {
  return evaluate_formula(text, FormulaWords{.variable = value_of}, fault);
}

}  // namespace kerf
