// Parameter texts: "M20x2 O2 T2 B-0.1 :A1,2,3". A key of one character, directly followed by its value.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "front/pathdxf/text/report.h"

#include "kerf/base/origin.h"

namespace kerf::pathdxf {

struct Parameter {
  std::string key;  // one character
  std::string value;
};

/// Names (one character each) and values.
using Variables = std::map<std::string, std::string>;

struct ParameterText {
  std::string text;
  Origin where;                      // of the text entity
  std::vector<Parameter> values;     // without the variables
  std::vector<Parameter> variables;  // of :XVALUE, key X
};

/// Splits a text. False, with errors reported, where a key or variable is repeated, or a value that must be
/// known before variables are (N, O, @) uses one.
bool parse_parameters(std::string text, const Origin& where, Report& report, ParameterText& out);

/// Replaces =X by the value of X, as often as values contain variables. Unknown ones stay and are appended to
/// `unknown`. Nothing where the replacement does not end.
std::optional<std::string> replace_variables(std::string_view value, const Variables& variables,
                                             std::string& unknown);

/// Bytes of the first character of a text in UTF-8; 0 of an empty one.
std::size_t first_character(std::string_view text);

/// A decimal number with point or comma.
std::optional<double> parse_value(std::string_view text);

/// The permitted values of a variable: "1,2,3", "?ABC" or "0.5~1.2".
class VariableDefinition {
 public:
  static std::optional<VariableDefinition> parse(std::string_view text);
  bool permits(std::string_view value) const;
  /// The value for a check: entry `k` of a list, modulo its length; the bounds of a range by turns.
  std::string example(std::size_t k) const;

 private:
  std::vector<std::string> values_;  // of a range: its bounds
  bool is_range_ = false;
  double low_ = 0.0, high_ = 0.0;
};

}  // namespace kerf::pathdxf
