// Values of expressions, which a program may have wherever it has a number: "#1", "#<depth>",
// "[2 * #1 + SIN[30]]".
//
// Operators by decreasing precedence: **; * / MOD; + -; EQ NE GT GE LT LE; AND OR XOR; all of them, ** too,
// are left-associative. Angles are in degrees. Blanks and the case of letters are ignored. Source: LinuxCNC's
// pages "Expressions", "Functions", "Binary operators".
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "base/codes/gcode.h"
#include "front/gcode/program/parameters.h"

#include "kerf/base/diagnostics.h"

namespace kerf::gcode {

/// Why a text has no value, and the offset of the fault in it.
struct ExpressionFault {
  Code code = codes::expression_malformed;
  std::size_t offset = 0;
  std::string message;
};

/// Reads values one after the other from a text.
class ExpressionReader {
 public:
  ExpressionReader(std::string_view text, const Parameters& parameters)
      : text_(text), parameters_(parameters) {}

  /// The next value: a number, a parameter, a bracketed expression or a function. Finite; nothing with
  /// fault() set.
  std::optional<double> value();
  /// The value of an assignment: in Fanuc's macros "#1 + 1" needs no square brackets.
  std::optional<double> assigned_value() { return parameters_.has_vacant() ? operation(1) : value(); }
  /// The parameter on the left of "#... =". Nothing with fault() set if it cannot be read.
  struct Target {
    int number = 0;
    std::string name;  // empty: the parameter has a number
  };
  std::optional<Target> target();
  /// Takes the character if it is the next one after blanks.
  bool take(char c);
  bool at_end();
  /// Skips blanks and comments in parentheses.
  void skip_comments();
  std::size_t position() const { return at_; }
  std::string_view rest() const { return text_.substr(at_); }
  const ExpressionFault& fault() const { return fault_; }
  /// Whether the values so far depend on a parameter whose value is known only at run time.
  bool is_unknown() const { return is_unknown_; }
  /// Whether the last value is a vacant variable of Fanuc's macros by itself.
  bool is_vacant() const { return is_vacant_; }

 private:
  enum class Operator : unsigned char;
  std::optional<double> fail(Code code, std::string message);
  /// "[x]"; of Fanuc's controls also "[x,y]", where `second` is wanted.
  std::optional<double> bracket(std::optional<double>* second = nullptr);
  std::optional<double> operation(int min_precedence);
  std::optional<double> operand();
  std::optional<double> plain_number();
  std::optional<double> parameter();
  std::optional<double> function();
  std::string_view function_name();
  std::optional<double> converted(std::string_view function, double x);
  std::optional<double> exists();
  std::optional<double> arc_tangent();
  std::optional<double> power(std::size_t start);
  std::optional<double> apply(std::string_view function, double x);
  std::optional<double> apply(Operator op, double left, double right);
  std::optional<double> apply_in_macro(Operator op, double left, double right, bool vacant_left);
  std::optional<Operator> peek_operator(std::size_t& end) const;
  std::optional<double> checked(double value);
  void skip_blanks();
  bool take_word(std::string_view word);
  int precedence_of(Operator op) const;

  std::string_view text_;
  const Parameters& parameters_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool is_unknown_ = false;
  bool is_vacant_ = false;
  ExpressionFault fault_;
};

}  // namespace kerf::gcode
