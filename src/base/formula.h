// Formulas of corrected heights: "0.800+0.794*[#51-2.000]+0.206*[#52-2.000]".
//
// Decimal numbers, variables (# and a number), + - * / from left to right, a sign before a factor, and pairs
// of ( ) or [ ]. Where they have a meaning also names ("stock.z") and units ("1-1/2 in", "60ipm").
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace kerf {

/// Why a formula has no value, and the offset of the fault in it.
struct FormulaFault {
  enum class Kind { unexpected, bracket_missing, rest, unknown_variable, unknown_unit, not_finite, too_deep };
  Kind kind = Kind::unexpected;
  std::size_t offset = 0;
  std::string symbol;  // the missing bracket, or the unknown variable or unit
};

/// The values of the words of a formula; an empty function: there are none of its kind.
struct FormulaWords {
  std::function<std::optional<double>(int variable)> variable{};
  std::function<std::optional<double>(std::string_view name)> name{};
  /// The factor of a unit after a number. A number may then be a fraction: "1/4in", "1-1/2in".
  std::function<std::optional<double>(std::string_view unit)> unit{};
};

/// The value of a formula; nothing with `fault` set.
std::optional<double> evaluate_formula(std::string_view text, const FormulaWords& words, FormulaFault& fault);
/// The value of a formula with variables alone.
std::optional<double> evaluate_formula(std::string_view text,
                                       const std::function<std::optional<double>(int variable)>& value_of,
                                       FormulaFault& fault);

}  // namespace kerf
