// The tools of a program by the maker's and the generated number, and the facts of the one in use.
#pragma once

#include <map>
#include <string>

#include "kerf/tool/tool.h"

namespace kerf::design {

/// The built-in tools and the program's own.
class ToolNumbers {
 public:
  explicit ToolNumbers(const ToolTable& built_in);
  /// The maker's number of a tool given by that or by its generated one; Refusal for unknown tools.
  int maker_number(int number) const;
  bool has(int number) const { return all_.find(number) != nullptr || makers_.count(number) != 0; }
  const Tool& tool(int number) const;
  /// "100036"; the maker's number for tools without a generated one.
  std::string generated_number(int number) const;
  void add(int number, Tool tool);
  /// The first number after another one that no tool has.
  int free_number(int after) const;
  const std::map<int, Tool>& own() const { return own_; }
  const ToolTable& all() const { return all_; }

 private:
  ToolTable all_;
  std::map<int, int> makers_;  // by generated number
  std::map<int, Tool> own_;
};

/// The tool of the following motions.
struct ToolInUse {
  int number = 102;  // in the toolpath: the maker's
  int given = 102;   // as given to toolchange()
  Tool tool;
  bool described = false;  // by settoolparameters() or define...tool(), not by the table
  double diameter() const { return tool.diameter.mm(); }
  std::string_view shape() const;  // "square", "O-flute", "ball", "V" ...
  /// "small_square" and so on, by which feeds have ratios.
  std::string_view feed_class() const;
};

/// The names of feed_class().
const std::vector<std::string>& feed_classes();

/// The diameter of a tool at a height above its tip, mm; above the flute that at its end.
double diameter_at(const Tool& tool, double height);

}  // namespace kerf::design
