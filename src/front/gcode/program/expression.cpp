// Expressions by recursive descent; the depth is bounded.
#include "front/gcode/program/expression.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "base/codes/gcode.h"
#include "codec/gcode/decimal.h"

namespace kerf::gcode {
namespace {

constexpr int kMaxDepth = 200;   // of nested brackets
constexpr double kEqual = 1e-4;  // tolerance of EQ and NE in LinuxCNC
constexpr double kMaxResult = 1e30;
constexpr double kIndexTolerance = 1e-4;  // of the distance of a parameter's number from a whole one
/// As LinuxCNC: ASIN[0.5] is 30 and not the next number above it, so that FUP[ASIN[0.5]] is 30 too.
constexpr long double kPi = std::numbers::pi_v<long double>;
double radians_of(double degrees) { return static_cast<double>(degrees * kPi / 180.0L); }
double degrees_of(double radians) { return static_cast<double>(radians * 180.0L / kPi); }

constexpr std::string_view kFunctions[] = {"ABS", "ACOS", "ASIN", "ATAN",  "COS", "EXISTS", "EXP", "FIX",
                                           "FUP", "LN",   "POW",  "ROUND", "SIN", "SQRT",   "TAN"};
constexpr std::string_view kMacroFunctions[] = {"BCD", "BIN"};  // of Fanuc's controls

bool is_blank(char c) { return c == ' ' || c == '\t'; }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// The end of `word` at `at` in `text`, blanks ignored; 0 if `text` has another word there.
std::size_t word_end(std::string_view text, std::size_t at, std::string_view word) {
  for (const char wanted : word) {
    while (at < text.size() && is_blank(text[at])) ++at;
    if (at == text.size() || upper(text[at]) != wanted) return 0;
    ++at;
  }
  return at;
}

}  // namespace

enum class ExpressionReader::Operator : unsigned char {
  power,
  times,
  divided,
  modulo,
  plus,
  minus,
  equal,
  unequal,
  greater,
  at_least,
  less,
  at_most,
  both,
  either,
  one_of,
};

int ExpressionReader::precedence_of(Operator op) const {
  if (parameters_.has_vacant() && op == Operator::both) return 4;
  if (parameters_.has_vacant() && op > Operator::both) return 3;
  if (op == Operator::power) return 5;
  if (op <= Operator::modulo) return 4;
  if (op <= Operator::minus) return 3;
  return op <= Operator::at_most ? 2 : 1;
}

std::optional<double> ExpressionReader::fail(Code code, std::string message) {
  if (fault_.message.empty()) fault_ = {code, at_, std::move(message)};
  return std::nullopt;
}

std::optional<double> ExpressionReader::checked(double value) {
  if (std::isfinite(value) && std::abs(value) <= kMaxResult) return value + 0.0;
  return fail(codes::expression_impossible, "the result is undefined or too large");
}

void ExpressionReader::skip_blanks() {
  while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
}

bool ExpressionReader::take(char c) {
  skip_blanks();
  if (at_ == text_.size() || text_[at_] != c) return false;
  ++at_;
  return true;
}

bool ExpressionReader::take_word(std::string_view word) {
  const std::size_t end = word_end(text_, at_, word);
  if (end == 0) return false;
  at_ = end;
  return true;
}

void ExpressionReader::skip_comments() {
  while (take('(')) at_ = std::min(text_.find(')', at_), text_.size() - 1) + 1;
}

bool ExpressionReader::at_end() {
  skip_blanks();
  return at_ == text_.size();
}

std::optional<double> ExpressionReader::value() {
  if (++depth_ > kMaxDepth) return fail(codes::expression_malformed, "brackets are nested too deeply");
  const std::optional<double> found = operand();
  --depth_;
  return found;
}

std::optional<double> ExpressionReader::operand() {
  if (at_end()) return fail(codes::expression_malformed, "a value is missing here");
  is_vacant_ = false;
  const char c = text_[at_];
  if (c == '[') return bracket();
  if (c == '#') return parameter();
  const char next = at_ + 1 < text_.size() ? text_[at_ + 1] : ' ';
  const bool sign = (c == '+' || c == '-') && !((next >= '0' && next <= '9') || next == '.');
  if (sign) {
    ++at_;
    const std::optional<double> size = value();
    return size ? checked(c == '-' ? -*size : *size) : size;
  }
  return (upper(c) >= 'A' && upper(c) <= 'Z') ? function() : plain_number();
}

std::optional<double> ExpressionReader::plain_number() {
  const Decimal number = read_decimal(text_.data() + at_, text_.data() + text_.size());
  const char after = number.end == text_.data() + text_.size() ? ' ' : *number.end;
  const bool signed_after = number.fault == DecimalFault::malformed && (after == '+' || after == '-');
  if (number.fault != DecimalFault::none && !signed_after)
    return fail(codes::expression_malformed, "expected a value here");
  at_ = static_cast<std::size_t>(number.end - text_.data());
  return number.value;
}

std::optional<double> ExpressionReader::bracket(std::optional<double>* second) {
  ++at_;  // '['
  const std::optional<double> inner = operation(1);
  if (!inner) return inner;
  if (second != nullptr && parameters_.has_vacant() && take(',')) {
    *second = operation(1);
    if (!*second) return std::nullopt;
  }
  if (!take(']')) return fail(codes::expression_malformed, "expected an operator or a closing ] here");
  return inner;
}

/// Precedence climbing: operands and operators of at least `min_precedence`, left-associative.
std::optional<double> ExpressionReader::operation(int min_precedence) {
  std::optional<double> left = value();
  std::size_t end = 0;
  while (left) {
    const std::optional<Operator> op = peek_operator(end);
    if (!op || precedence_of(*op) < min_precedence) break;
    at_ = end;
    const bool vacant_left = is_vacant_;
    const std::optional<double> right = operation(precedence_of(*op) + 1);
    if (!right) return right;
    left = parameters_.has_vacant() ? apply_in_macro(*op, *left, *right, vacant_left)
                                    : apply(*op, *left, *right);
    is_vacant_ = false;
  }
  return left;
}

std::optional<ExpressionReader::Operator> ExpressionReader::peek_operator(std::size_t& end) const {
  constexpr struct {
    std::string_view word;
    Operator op;
  } kOperators[] = {{"**", Operator::power},    {"*", Operator::times},    {"/", Operator::divided},
                    {"+", Operator::plus},      {"-", Operator::minus},    {"MOD", Operator::modulo},
                    {"EQ", Operator::equal},    {"NE", Operator::unequal}, {"GT", Operator::greater},
                    {"GE", Operator::at_least}, {"LT", Operator::less},    {"LE", Operator::at_most},
                    {"AND", Operator::both},    {"OR", Operator::either},  {"XOR", Operator::one_of}};
  for (const auto& entry : kOperators) {
    end = word_end(text_, at_, entry.word);
    if (end != 0) return entry.op;
  }
  return std::nullopt;
}

/// POW[x,y] of Fanuc's controls. Source: Fanuc, B-63944EN, "Custom macro", arithmetic and logic operations.
std::optional<double> ExpressionReader::power(std::size_t start) {
  std::optional<double> exponent;
  const std::optional<double> base = bracket(&exponent);
  if (!base) return base;
  is_vacant_ = false;
  if (exponent) return checked(std::pow(*base, *exponent));
  at_ = start;
  return fail(codes::expression_malformed, "POW[x,y] is a function of Fanuc's controls alone");
}

std::optional<double> ExpressionReader::apply(Operator op, double left, double right) {
  switch (op) {
    case Operator::power:
      if (left < 0.0 && right != std::floor(right))
        return fail(codes::expression_impossible,
                    "a negative number has no power with a fractional exponent");
      return checked(std::pow(left, right));
    case Operator::times: return checked(left * right);
    case Operator::divided:
      if (right == 0.0) return fail(codes::expression_impossible, "division by zero");
      return checked(left / right);
    case Operator::modulo: {
      if (right == 0.0) return fail(codes::expression_impossible, "MOD by zero");
      const double remainder = std::fmod(left, right);
      return checked(remainder < 0.0 ? remainder + std::abs(right) : remainder);
    }
    case Operator::plus: return checked(left + right);
    case Operator::minus: return checked(left - right);
    case Operator::equal: return std::abs(left - right) < kEqual ? 1.0 : 0.0;
    case Operator::unequal: return std::abs(left - right) < kEqual ? 0.0 : 1.0;
    case Operator::greater: return left > right ? 1.0 : 0.0;
    case Operator::at_least: return left >= right ? 1.0 : 0.0;
    case Operator::less: return left < right ? 1.0 : 0.0;
    case Operator::at_most: return left <= right ? 1.0 : 0.0;
    case Operator::both: return left != 0.0 && right != 0.0 ? 1.0 : 0.0;
    case Operator::either: return left != 0.0 || right != 0.0 ? 1.0 : 0.0;
    case Operator::one_of: return (left != 0.0) != (right != 0.0) ? 1.0 : 0.0;
  }
  return std::nullopt;
}

/// Of Fanuc's macros: a vacant variable equals no number (Modern Machine Shop, "Understanding Vacancy",
/// 2009), and AND, OR and XOR join the bits of whole numbers.
std::optional<double> ExpressionReader::apply_in_macro(Operator op, double left, double right,
                                                       bool vacant_left) {
  constexpr double kMaxBits = 4294967295.0;
  const bool compares = op == Operator::equal || op == Operator::unequal;
  if (compares && (vacant_left || is_vacant_)) {
    const bool equal = vacant_left && is_vacant_;
    return equal == (op == Operator::equal) ? 1.0 : 0.0;
  }
  if (op < Operator::both) return apply(op, left, right);
  if (!(left >= 0.0 && left <= kMaxBits && right >= 0.0 && right <= kMaxBits))
    return fail(codes::expression_impossible, "AND, OR and XOR need numbers from 0 to 4294967295");
  const auto a = static_cast<std::uint32_t>(std::round(left));
  const auto b = static_cast<std::uint32_t>(std::round(right));
  return static_cast<double>(op == Operator::both ? a & b : op == Operator::either ? a | b : a ^ b);
}

std::optional<ExpressionReader::Target> ExpressionReader::target() {
  const auto none = [this](std::string message) {
    fail(codes::expression_malformed, std::move(message));
    return std::nullopt;
  };
  if (!take('#')) return none("expected a parameter (#) here");
  if (take('<')) {
    const std::size_t close = text_.find('>', at_);
    std::string name = normal_name(text_.substr(at_, close == std::string_view::npos ? 0 : close - at_));
    if (name.empty()) return none("expected a parameter name between < and > here");
    at_ = close + 1;
    return Target{0, std::move(name)};
  }
  const std::size_t start = at_;
  const std::optional<double> index = value();
  if (!index) return std::nullopt;
  const double whole = std::round(*index);
  if (std::abs(whole - *index) <= kIndexTolerance && whole >= (parameters_.has_vacant() ? 0.0 : 1.0) &&
      whole <= Parameters::kLast)
    return Target{static_cast<int>(whole), {}};
  at_ = start;
  fail(codes::parameter_unknown,
       fmt::format("parameter numbers are integers from 1 to {}, not {:g}", Parameters::kLast, *index));
  return std::nullopt;
}

std::optional<double> ExpressionReader::parameter() {
  const std::size_t start = at_;
  const std::optional<Target> what = target();
  if (!what) return std::nullopt;
  const auto found = what->name.empty() ? parameters_.number(what->number) : parameters_.name(what->name);
  if (found) {
    is_unknown_ = is_unknown_ || found->unknown;
    is_vacant_ = found->vacant;
    return found->value;
  }
  at_ = start;
  return fail(codes::parameter_unknown, fmt::format("the parameter #<{}> has no value", what->name));
}

/// The function here, before its [; empty if there is none. Fanuc's controls take the first two letters
/// of a name for it: RO[1.5]. Source: Fanuc, B-63684EN, "Custom macro", "Abbreviations in operations".
std::string_view ExpressionReader::function_name() {
  constexpr std::size_t kShort = 2;
  const std::size_t start = at_;
  const bool macro = parameters_.has_vacant();
  const auto has = [&](std::string_view word) {
    at_ = start;
    if (!take_word(word)) return false;
    skip_blanks();
    return at_ < text_.size() && text_[at_] == '[';
  };
  for (const std::string_view name : kFunctions)
    if (has(name) || (macro && name != "EXISTS" && has(name.substr(0, kShort)))) return name;
  for (const std::string_view name : kMacroFunctions)
    if (macro && (has(name) || has(name.substr(0, kShort)))) return name;
  at_ = start;
  return {};
}

std::optional<double> ExpressionReader::function() {
  const std::size_t start = at_;
  const std::string_view name = function_name();
  if (name.empty()) return fail(codes::expression_malformed, "unknown function, or its [ is missing");
  if (name == "EXISTS") return exists();
  if (name == "ATAN") return arc_tangent();
  if (name == "POW") return power(start);
  const std::optional<double> x = bracket();
  is_vacant_ = false;
  return x ? apply(name, *x) : x;
}

/// BCD[10] is 16, hexadecimal 10; BIN[16] is 10. Source: as above, "Arithmetic and logic operation".
std::optional<double> ExpressionReader::converted(std::string_view function, double x) {
  constexpr double kDigits = 8.0;
  const double from = function == "BCD" ? 10.0 : 16.0, to = 26.0 - from;
  const double whole = std::round(x);
  if (!(whole >= 0.0 && whole < std::pow(from, kDigits)))
    return fail(codes::expression_impossible,
                fmt::format("{} of {:g}: the argument must have up to eight digits", function, x));
  double result = 0.0, weight = 1.0;
  for (double left = whole; left > 0.0; left = std::floor(left / from), weight *= to) {
    const double digit = std::fmod(left, from);
    if (digit > 9.0)
      return fail(codes::expression_impossible,
                  fmt::format("{} of {:g}: a digit of the argument is above 9", function, x));
    result += digit * weight;
  }
  return result;
}

std::optional<double> ExpressionReader::exists() {
  ++at_;  // '['
  const std::optional<Target> what = target();
  const bool no_such_number = !what && fault_.code == codes::parameter_unknown;
  if (!what && !no_such_number) return std::nullopt;
  if (no_such_number) {
    fault_ = {};
    at_ = std::min(text_.find(']', at_), text_.size());
  }
  if (!take(']')) return fail(codes::expression_malformed, "a closing ] is missing here");
  return what && (what->name.empty() || parameters_.name(what->name)) ? 1.0 : 0.0;
}

/// ATAN[y]/[x]: atan2; Fanuc's controls also have ATAN[y,x] and ATAN[y].
std::optional<double> ExpressionReader::arc_tangent() {
  std::optional<double> second;
  const std::optional<double> y = bracket(&second);
  if (!y) return y;
  is_vacant_ = false;
  if (second) return degrees_of(std::atan2(*y, *second));
  if (parameters_.has_vacant() && !rest().starts_with('/')) return degrees_of(std::atan(*y));
  if (!take('/')) return fail(codes::expression_malformed, "ATAN needs two values: ATAN[y]/[x]");
  skip_blanks();
  if (at_ == text_.size() || text_[at_] != '[')
    return fail(codes::expression_malformed, "ATAN needs two values: ATAN[y]/[x]");
  const std::optional<double> x = bracket();
  if (!x) return x;
  return degrees_of(std::atan2(*y, *x));
}

std::optional<double> ExpressionReader::apply(std::string_view function, double x) {
  const auto impossible = [&](std::string_view why) {
    return fail(codes::expression_impossible, fmt::format("{} of {:g}: {}", function, x, why));
  };
  if (function == "BCD" || function == "BIN") return converted(function, x);
  if (function == "ABS") return std::abs(x);
  if (function == "SIN") return std::sin(radians_of(x));
  if (function == "COS") return std::cos(radians_of(x));
  if (function == "TAN") return checked(std::tan(radians_of(x)));
  if (function == "EXP") return checked(std::exp(x));
  // Fanuc's round the size of the number: FIX[-1.2] is -1, FUP[-1.2] is -2.
  if (parameters_.has_vacant() && x < 0.0 && (function == "FIX" || function == "FUP"))
    return function == "FIX" ? std::ceil(x) + 0.0 : std::floor(x);
  if (function == "FIX") return std::floor(x) + 0.0;
  if (function == "FUP") return std::ceil(x) + 0.0;
  if (function == "ROUND") return std::round(x) + 0.0;
  if (function == "LN") return x > 0.0 ? checked(std::log(x)) : impossible("the argument must be above 0");
  if (function == "SQRT") return x >= 0.0 ? std::sqrt(x) : impossible("the argument must not be negative");
  if (std::abs(x) > 1.0) return impossible("the argument must be from -1 to 1");
  return degrees_of(function == "ASIN" ? std::asin(x) : std::acos(x));
}

}  // namespace kerf::gcode
