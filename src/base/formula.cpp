// Formulas: a recursive descent over sums, products and factors.
#include "base/formula.h"

#include <charconv>
#include <cmath>

#include "base/number.h"

namespace kerf {
namespace {

constexpr int kMaxDepth = 200;  // of brackets and signs

bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Evaluator {
 public:
  Evaluator(std::string_view text, const std::function<std::optional<double>(int)>& value_of,
            FormulaFault& fault)
      : text_(text), value_of_(value_of), fault_(fault) {}

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
    return c == '#' ? variable() : number();
  }
  std::optional<double> variable() {
    const std::size_t start = at_++;
    int name = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), name);
    if (error != std::errc() || name < 0) {
      at_ = start;
      return fail(FormulaFault::Kind::unexpected);
    }
    if (const auto value = value_of_(name)) {
      at_ = static_cast<std::size_t>(end - text_.data());
      return value;
    }
    at_ = start;
    return fail(FormulaFault::Kind::unknown_variable, "#" + std::to_string(name));
  }
  std::optional<double> number() {
    std::size_t end = at_;
    while (end < text_.size() && (is_digit(text_[end]) || text_[end] == '.')) ++end;
    const auto value = parse_number(text_.substr(at_, end - at_));
    if (!value) return fail(FormulaFault::Kind::unexpected);
    at_ = end;
    return value;
  }

  std::string_view text_;
  const std::function<std::optional<double>(int)>& value_of_;
  FormulaFault& fault_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::optional<double> evaluate_formula(std::string_view text,
                                       const std::function<std::optional<double>(int)>& value_of,
                                       FormulaFault& fault) {
  return Evaluator(text, value_of, fault).run();
}

}  // namespace kerf
