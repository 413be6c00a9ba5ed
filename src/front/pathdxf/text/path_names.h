// Names of paths, such as 8998.1P: found in layer names and texts, and compared with the patterns in the
// names of files, such as "8990-8998,9001.2.dxf".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/pattern.h"
#include "front/pathdxf/text/report.h"

namespace kerf::pathdxf {

class PathNames {
 public:
  /// Nothing, with an error reported, where an expression of the options is invalid.
  static std::optional<PathNames> make(const PathdxfOptions& options, Report& report);

  /// "8998_1P~a" -> "8998.1P"; nothing for a layer that is no path layer.
  std::optional<std::string> of_layer(std::string_view layer) const;
  /// Whether a path name matches the expression with its case too.
  bool has_expected_case(std::string_view name) const;
  /// The path name in the value of > or @, which must not have anything else.
  std::optional<std::string> in_value(std::string_view value) const;
  /// Whether a file of this name (without folder and ending) may contain the path.
  bool may_contain(std::string_view file_stem, std::string_view path) const;
  const std::string& expression() const { return expression_; }

 private:
  PathNames(Pattern name, Pattern exact_name, Pattern pattern, Pattern range, std::string expression)
      : name_(std::move(name)),
        exact_name_(std::move(exact_name)),
        pattern_(std::move(pattern)),
        range_(std::move(range)),
        expression_(std::move(expression)) {}

  Pattern name_, exact_name_;  // without and with regard to case
  Pattern pattern_;
  Pattern range_;  // pattern-pattern
  std::string expression_;
};

/// Order of a file's pattern and a path by their groups: numbers by value, texts without regard to case. 0 if
/// the path has further groups.
int compare_groups(const std::vector<std::string>& pattern, const std::vector<std::string>& path);

}  // namespace kerf::pathdxf
