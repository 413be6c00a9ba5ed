// The elements of an XML file as a tree.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/pace.h"

#include "kerf/base/diagnostics.h"

namespace kerf::svg {

struct Element {
  std::string name;  // without the prefix of SVG's namespace; "?:g" in another namespace
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<Element> children;
  std::string text;  // of a style sheet; of an element "#text", a piece of the content of a text element
  std::size_t line = 0, column = 0;
  const Element* parent = nullptr;
  std::size_t position = 0;  // among the parent's children
  /// Numbers from 1 among the elements there, and among those of its name; and how many there are.
  struct Number {
    std::size_t at = 1, count = 1;
  };
  Number number, number_of_name;

  /// The attribute's value; empty if there is none.
  std::string_view attribute(std::string_view key) const;
  bool has(std::string_view key) const;
};

struct TreeSource {
  const std::string& file;  // for messages
  std::size_t max_depth = 0;
};
/// The root; nothing, with an error appended, if the bytes are not well-formed or nested too deep; nothing if
/// stopped. `sheets` receives what the file says of style sheets in other files (processing instructions).
std::unique_ptr<Element> read_tree(std::string_view bytes, const TreeSource& source,
                                   std::vector<Element>& sheets, Pace& pace, Diagnostics& diagnostics);

}  // namespace kerf::svg
