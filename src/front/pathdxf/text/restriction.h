// Restrictions of sub-paths: "PARENT:CHILD", two expressions for path names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/pattern.h"
#include "front/pathdxf/text/report.h"

#include "kerf/base/origin.h"

namespace kerf::pathdxf {

/// A path whose name has a match of PARENT may embed only paths whose name has a match of CHILD.
class Restriction {
 public:
  /// `option` is "E" or "/e", for the message of an invalid text.
  static std::optional<Restriction> parse(const std::string& text, std::string_view option,
                                          const Origin& where, Report& report);

  bool applies_to(std::string_view parent) const { return parent_.search(parent).has_value(); }
  bool permits(std::string_view child) const { return child_.search(child).has_value(); }
  const std::string& text() const { return text_; }

 private:
  Restriction(Pattern parent, Pattern child, std::string text)
      : parent_(std::move(parent)), child_(std::move(child)), text_(std::move(text)) {}

  Pattern parent_, child_;
  std::string text_;
};

/// Those of the options; nothing, with errors, if one is invalid.
std::optional<std::vector<Restriction>> restrictions_of(const PathdxfOptions& options, Report& report);

}  // namespace kerf::pathdxf
