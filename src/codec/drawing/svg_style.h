// Style sheets of SVG: which value a property of an element has, by CSS's cascade.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/drawing/svg_tree.h"

namespace kerf::svg {

struct Declaration {
  std::string key, value;
  bool is_important = false;
};

/// The values of the properties of one element, without inheritance.
class Properties {
 public:
  Properties(const Element& element, std::vector<const Declaration*> rules);
  /// The value of the last declaration of the highest rank, else the attribute's; empty: there is none.
  std::string_view find(std::string_view key) const;
  /// The same without attributes: of properties that have none, such as `font`.
  std::string_view declared(std::string_view key) const;

 private:
  const Element& element_;
  std::vector<const Declaration*> rules_;  // in ascending order
  std::vector<Declaration> own_;           // of the attribute `style`
};

/// The rules of all `style` elements of a document. Selectors have element names, classes, ids, attributes,
/// :first-child, :last-child and :root, and the combinators of
/// descendants, children and neighbours; the rules of @media are those of a screen.
class StyleSheet {
 public:
  void read(std::string_view css);
  Properties properties(const Element& element) const;
  /// Selectors that are not understood; their rules are ignored.
  const std::vector<std::string>& unknown() const { return unknown_; }

 private:
  struct Attribute {
    std::string name, value;
    char match = '\0';  // '\0': is present, '=', '~', '|', '^', '$', '*'
  };
  /// Conditions on one element, and its relation to the compound before: ' ', '>' or '+'.
  struct Compound {
    std::string tag, id;  // empty: any
    std::vector<std::string> classes, positions;
    std::vector<Attribute> attributes;
    char relation = '\0';
  };
  struct Rule {
    std::vector<Compound> selector;
    std::uint32_t specificity = 0;
    std::vector<std::size_t> declarations;  // indices into declarations_
  };
  bool add_rule(std::string_view selector, const std::vector<std::size_t>& declarations);
  static bool read_compound(std::string_view& text, Compound& compound);
  static bool read_attribute(std::string_view& text, Compound& compound);
  static bool matches(const Compound& compound, const Element& element);
  using Failed = std::set<std::pair<std::size_t, const Element*>>;
  static bool matches(const std::vector<Compound>& selector, std::size_t count, const Element& element,
                      Failed& failed);

  std::vector<Declaration> declarations_;
  std::vector<Rule> rules_;
  std::map<std::string, std::vector<std::size_t>, std::less<>> by_key_;  // by "#id", ".class", "tag" or "*"
  std::vector<std::string> unknown_;
};

}  // namespace kerf::svg
