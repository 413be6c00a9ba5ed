// Style sheets of SVG: which value a property of an element has, by CSS's cascade.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
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

/// Custom properties ("--name") and their values.
using Variables = std::map<std::string, std::string, std::less<>>;

/// The values of the properties of one element, without inheritance but of custom properties.
class Properties {
 public:
  /// `inherited` are the custom properties of the parent.
  Properties(const Element& element, std::vector<const Declaration*> rules,
             const std::shared_ptr<const Variables>& inherited);
  enum class Source : std::uint8_t { sheet, style, attribute };
  struct Candidate {
    std::string_view value;
    Source source = Source::sheet;
  };
  /// All values of a property, the first in rank first. An invalid one gives way to the next.
  std::vector<Candidate> candidates(std::string_view key) const;
  /// The value of the last declaration of the highest rank, else the attribute's; empty: there is none.
  std::string_view find(std::string_view key) const;
  /// The same without attributes: of properties that have none, such as `font`.
  std::string_view declared(std::string_view key) const;
  const std::shared_ptr<const Variables>& variables() const { return variables_; }

 private:
  void set_variables(const std::shared_ptr<const Variables>& inherited);
  std::string_view substituted(std::string_view value) const;

  const Element& element_;
  std::vector<const Declaration*> ranked_;  // the first in rank first
  std::vector<Declaration> own_;            // of the attribute `style`
  std::shared_ptr<const Variables> variables_;
  mutable std::deque<std::string> made_;  // values with var() replaced
};

/// The rules of all `style` elements of a document. Selectors have element names, classes, ids, attributes,
/// positions among siblings, :not, :is and :where, and all combinators; the rules of @media are those of a
/// screen. Nothing is hovered or focused.
class StyleSheet {
 public:
  void read(std::string_view css);
  Properties properties(const Element& element, const std::shared_ptr<const Variables>& inherited) const;
  /// Selectors that are not understood; their rules are ignored.
  const std::vector<std::string>& unknown() const { return unknown_; }

 private:
  struct Attribute {
    std::string name, value;
    char match = '\0';  // '\0': is present, '=', '~', '|', '^', '$', '*'
  };
  /// "2n+1" of a position among the siblings, from the first or the last, of all or those of the same name.
  struct Position {
    int step = 0, first = 1;
    bool is_from_end = false, is_of_type = false;
  };
  struct Compound;
  using Selector = std::vector<Compound>;
  /// :is, :where and :not.
  struct Choice {
    std::vector<Selector> selectors;
    bool is_negated = false;
  };
  /// Conditions on one element, and its relation to the compound before: ' ', '>', '+' or '~'.
  struct Compound {
    std::string tag, id;  // empty: any
    std::vector<std::string> classes;
    std::vector<Position> positions;
    std::vector<Choice> choices;
    std::vector<Attribute> attributes;
    std::optional<bool> is_root;
    bool never = false;  // an interaction, such as :hover
    std::uint32_t specificity = 0;
    char relation = '\0';
  };
  struct Rule {
    Selector selector;
    std::uint32_t specificity = 0;
    std::vector<std::size_t> declarations;  // indices into declarations_
  };
  bool add_rule(std::string_view selector, const std::vector<std::size_t>& declarations);
  static std::optional<Selector> read_selector(std::string_view text, std::size_t depth);
  static bool read_compound(std::string_view& text, Compound& compound, std::size_t depth);
  static bool read_pseudo(std::string_view& text, Compound& compound, std::size_t depth);
  static bool read_choice(std::string_view inside, std::string_view name, Compound& compound,
                          std::size_t depth);
  static bool read_attribute(std::string_view& text, Compound& compound);
  bool matches(const Compound& compound, const Element& element) const;
  static bool matches(const Position& position, const Element& element);
  using Failed = std::set<std::pair<std::size_t, const Element*>>;
  bool matches(const Selector& selector, std::size_t count, const Element& element, Failed& failed) const;
  bool matches(const Selector& selector, const Element& element) const;

  std::vector<Declaration> declarations_;
  std::vector<Rule> rules_;
  std::map<std::string, std::vector<std::size_t>, std::less<>> by_key_;  // by "#id", ".class", "tag" or "*"
  std::vector<std::string> unknown_;
  mutable std::set<std::pair<const Compound*, const Element*>> failed_beside_;  // of '~'
};

}  // namespace kerf::svg
