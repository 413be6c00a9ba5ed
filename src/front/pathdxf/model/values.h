// The parameters of one element, with variables replaced.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "front/pathdxf/text/parameters.h"

namespace kerf::pathdxf {

class Values {
 public:
  /// Reports parameters of `text` (may be null) whose key is not in `keys`, and undefined variables. `where`
  /// is the element.
  Values(const ParameterText* text, std::string_view keys, const Variables& variables, Origin where,
         Report& report);

  bool has(char key) const { return find(key) != nullptr; }
  std::optional<std::string> text(char key) const;
  /// Nothing, with an error, for a text that is no number.
  std::optional<double> number(char key) const;
  /// number(), with an error unless it is above 0.
  std::optional<double> positive(char key) const;
  /// The variables, with those of the surrounding path replaced.
  const std::vector<Parameter>& variables() const { return variables_; }
  const Origin& where() const { return where_; }

 private:
  const std::string* find(char key) const;
  std::string replaced(std::string_view value, const ParameterText& text, const Variables& variables) const;

  std::vector<Parameter> values_, variables_;
  std::string text_, layer_;  // of the parameter text
  Origin where_;
  Report& report_;
};

/// "B value missing", unless there is one.
void require(const std::optional<double>& value, char key, const Origin& where, Report& report);

}  // namespace kerf::pathdxf
