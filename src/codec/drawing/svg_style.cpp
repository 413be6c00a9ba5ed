// Reads style sheets and style attributes, and finds the rules that apply to an element.
#if KERF_WITH_SVG
#include "codec/drawing/svg_style.h"

#include <algorithm>
#include <cmath>

#include "base/names.h"
#include "base/number.h"
#include "codec/drawing/colour_names.h"

namespace kerf::svg {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\f";
// Of ids, and of classes and the like, in the specificity of a selector.
constexpr std::uint32_t kIdRank = 1u << 20, kNameRank = 1u << 10;

std::string without_comments(std::string_view css) {
  std::string out;
  while (true) {
    const std::size_t open = css.find("/*");
    out += css.substr(0, open);
    if (open == std::string_view::npos) return out;
    const std::size_t close = css.find("*/", open + 2);
    if (close == std::string_view::npos) return out;
    css.remove_prefix(close + 2);
  }
}

/// The first of the characters that is outside of quotes and parentheses, or the end.
std::size_t find_outside(std::string_view text, std::string_view wanted, std::size_t from = 0) {
  char quote = '\0';
  int depth = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (depth == 0 && wanted.find(c) != std::string_view::npos) {
      return i;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '(') {
      ++depth;
    } else if (c == ')') {
      depth = std::max(0, depth - 1);
    }
  }
  return text.size();
}

/// "fill:none; stroke:#f00 !important"
std::vector<Declaration> declarations_of(std::string_view text) {
  std::vector<Declaration> out;
  while (!text.empty()) {
    const std::size_t end = find_outside(text, ";");
    const std::string_view one = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t colon = one.find(':');
    if (colon == std::string_view::npos) continue;
    std::string_view value = trim(one.substr(colon + 1));
    const std::size_t mark = value.rfind('!');
    const bool is_important =
        mark != std::string_view::npos && lowered(trim(value.substr(mark + 1))) == "important";
    if (is_important) value = trim(value.substr(0, mark));
    const std::string_view key = trim(one.substr(0, colon));
    out.push_back(
        {key.starts_with("--") ? std::string(key) : lowered(key), std::string(value), is_important});
  }
  return out;
}

bool is_name_char(char c) {
  const auto u = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
         u >= 0x80;
}

/// Takes a name from the start of the text; backslashes take the next character as it is.
std::string take_name(std::string_view& text) {
  std::string out;
  while (!text.empty()) {
    const bool is_escaped = text[0] == '\\' && text.size() > 1;
    if (!is_escaped && !is_name_char(text[0])) break;
    if (is_escaped) text.remove_prefix(1);
    out += text[0];
    text.remove_prefix(1);
  }
  return out;
}

bool has_word(std::string_view words, std::string_view word) {
  while (!words.empty()) {
    const std::size_t end = std::min(words.find_first_of(kBlanks), words.size());
    if (words.substr(0, end) == word) return true;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return false;
}

const Element* sibling_before(const Element& element) {
  if (element.parent == nullptr) return nullptr;
  for (std::size_t i = element.position; i-- > 0;)
    if (element.parent->children[i].name != "#text") return &element.parent->children[i];
  return nullptr;
}

/// The words "var(" to their closing parentheses are replaced by their values; nothing if one has none.
std::optional<std::string> with_variables(std::string_view value, const Variables& variables, int depth) {
  constexpr int kMaxDepth = 20;
  constexpr std::size_t kMaxLength = 65536;
  if (depth > kMaxDepth) return std::nullopt;
  std::string out;
  while (true) {
    const std::size_t at = lowered(value).find("var(");
    out += value.substr(0, at);
    if (out.size() > kMaxLength) return std::nullopt;
    if (at == std::string_view::npos) return out;
    value.remove_prefix(at + 4);
    const std::size_t close = find_outside(value, ")");
    const std::string_view inside = value.substr(0, close);
    value.remove_prefix(std::min(close + 1, value.size()));
    const std::size_t comma = find_outside(inside, ",");
    const auto known = variables.find(trim(inside.substr(0, comma)));
    std::optional<std::string> used;
    if (known != variables.end()) used = with_variables(known->second, variables, depth + 1);
    if (!used && comma < inside.size())
      used = with_variables(trim(inside.substr(comma + 1)), variables, depth + 1);
    if (!used) return std::nullopt;
    out += *used;
  }
}

}  // namespace

Properties::Properties(const Element& element, std::vector<const Declaration*> rules,
                       const std::shared_ptr<const Variables>& inherited)
    : element_(element), ranked_(std::move(rules)) {
  if (const auto style = element.attribute("style"); !style.empty())
    own_ = declarations_of(style.find("/*") == std::string_view::npos ? std::string(style)
                                                                      : without_comments(style));
  for (const Declaration& d : own_) ranked_.push_back(&d);
  std::stable_sort(ranked_.begin(), ranked_.end(), [](const Declaration* a, const Declaration* b) {
    return !a->is_important && b->is_important;
  });
  std::reverse(ranked_.begin(), ranked_.end());
  set_variables(inherited);
}

void Properties::set_variables(const std::shared_ptr<const Variables>& inherited) {
  std::shared_ptr<Variables> changed;
  for (auto d = ranked_.rbegin(); d != ranked_.rend(); ++d) {
    if (!(*d)->key.starts_with("--")) continue;
    if (!changed) changed = std::make_shared<Variables>(inherited ? *inherited : Variables{});
    (*changed)[(*d)->key] = (*d)->value;
  }
  variables_ = changed ? changed : inherited;
}

std::string_view Properties::substituted(std::string_view value) const {
  if (lowered(value).find("var(") == std::string::npos) return value;
  static const Variables kNone;
  auto made = with_variables(value, variables_ ? *variables_ : kNone, 0);
  return trim(std::string_view(made_.emplace_back(made ? std::move(*made) : "unset")));
}

std::vector<Properties::Candidate> Properties::candidates(std::string_view key) const {
  std::vector<Candidate> out;
  for (const Declaration* d : ranked_)
    if (d->key == key && !d->value.empty()) {
      const bool is_own =
          std::any_of(own_.begin(), own_.end(), [&](const Declaration& o) { return &o == d; });
      out.push_back({substituted(d->value), is_own ? Source::style : Source::sheet});
    }
  if (const auto own = trim(element_.attribute(key)); !own.empty())
    out.push_back({substituted(own), Source::attribute});
  return out;
}

std::string_view Properties::declared(std::string_view key) const {
  for (const Declaration* d : ranked_)
    if (d->key == key && !d->value.empty()) return substituted(d->value);
  return {};
}

std::string_view Properties::find(std::string_view key) const {
  const std::string_view value = declared(key);
  return value.empty() ? substituted(trim(element_.attribute(key))) : value;
}

// ------------------------------------------------------------------------------------------------- selectors

bool StyleSheet::read_attribute(std::string_view& text, Compound& compound) {
  text.remove_prefix(1);
  const std::size_t end = find_outside(text, "]");
  if (end >= text.size()) return false;
  std::string_view inside = trim(text.substr(0, end));
  text.remove_prefix(end + 1);
  Attribute& attribute = compound.attributes.emplace_back();
  compound.specificity += kNameRank;
  const std::size_t equals = inside.find('=');
  if (equals != std::string_view::npos) {
    attribute.match = '=';
    std::string_view value = trim(inside.substr(equals + 1));
    if (value.size() >= 2 && (value.front() == '"' || value.front() == '\'') && value.back() == value.front())
      value = value.substr(1, value.size() - 2);
    attribute.value = value;
    inside = inside.substr(0, equals);
    if (!inside.empty() && std::string_view("~|^$*").find(inside.back()) != std::string_view::npos) {
      attribute.match = inside.back();
      inside.remove_suffix(1);
    }
  }
  attribute.name = trim(inside);
  return !attribute.name.empty();
}

/// "odd", "3", "2n+1", "-n+3"; nothing if it is none of these.
std::optional<std::pair<int, int>> read_steps(std::string_view text) {
  std::string plain;
  for (const char c : lowered(text))
    if (kBlanks.find(c) == std::string_view::npos) plain += c;
  if (plain == "odd") return std::pair(2, 1);
  if (plain == "even") return std::pair(2, 0);
  const auto whole = [](std::string_view digits) -> std::optional<int> {
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto value = parse_number(digits);
    constexpr double kMax = 1e6;
    if (!value || *value != std::floor(*value) || std::abs(*value) > kMax) return std::nullopt;
    return static_cast<int>(*value);
  };
  const std::size_t n = plain.find('n');
  if (n == std::string::npos) {
    const auto only = whole(plain);
    return only ? std::optional(std::pair(0, *only)) : std::nullopt;
  }
  const std::string step = plain.substr(0, n), first = plain.substr(n + 1);
  const auto a = step.empty() || step == "+" ? std::optional(1)
                 : step == "-"               ? std::optional(-1)
                                             : whole(step);
  const auto b = first.empty() ? std::optional(0) : whole(first);
  return a && b ? std::optional(std::pair(*a, *b)) : std::nullopt;
}

/// :is(a, b), :where(a, b), :not(a, b).
bool StyleSheet::read_choice(std::string_view inside, std::string_view name, Compound& compound,
                             std::size_t depth) {
  Choice choice;
  choice.is_negated = name == "not";
  std::uint32_t highest = 0;
  while (true) {
    const std::size_t comma = find_outside(inside, ",");
    auto selector = read_selector(inside.substr(0, comma), depth + 1);
    if (!selector) return false;
    std::uint32_t rank = 0;
    for (const Compound& c : *selector) rank += c.specificity;
    highest = std::max(highest, rank);
    choice.selectors.push_back(std::move(*selector));
    if (comma >= inside.size()) break;
    inside.remove_prefix(comma + 1);
  }
  if (name != "where") compound.specificity += highest;
  compound.choices.push_back(std::move(choice));
  return true;
}

/// What follows a colon.
bool StyleSheet::read_pseudo(std::string_view& text, Compound& compound, std::size_t depth) {
  const std::string name = lowered(take_name(text));
  std::string_view inside;
  if (!text.empty() && text[0] == '(') {
    const std::size_t close = find_outside(text.substr(1), ")") + 1;
    if (close >= text.size()) return false;
    inside = trim(text.substr(1, close - 1));
    text.remove_prefix(close + 1);
  }
  if (name == "not" || name == "is" || name == "where") return read_choice(inside, name, compound, depth);
  compound.specificity += kNameRank;
  Position position;
  position.is_from_end = name.find("last") != std::string::npos;
  position.is_of_type = name.find("of-type") != std::string::npos;
  if (name == "root") {
    compound.is_root = true;
  } else if (name == "first-child" || name == "last-child" || name == "first-of-type" ||
             name == "last-of-type") {
    compound.positions.push_back(position);
  } else if (name == "only-child" || name == "only-of-type") {
    compound.positions.push_back(position);
    position.is_from_end = true;
    compound.positions.push_back(position);
  } else if (name == "nth-child" || name == "nth-last-child" || name == "nth-of-type" ||
             name == "nth-last-of-type") {
    const auto steps = read_steps(inside);
    if (!steps) return false;
    position.step = steps->first;
    position.first = steps->second;
    compound.positions.push_back(position);
  } else if (name == "hover" || name == "focus" || name == "active" || name == "visited" ||
             name == "focus-within" || name == "focus-visible" || name == "target") {
    compound.never = true;
  } else {
    return false;
  }
  return true;
}

/// Takes the conditions on one element from the start of the text; false if they are not understood.
bool StyleSheet::read_compound(std::string_view& text, Compound& compound, std::size_t depth) {
  const std::size_t before = text.size();
  if (!text.empty() && text[0] == '*')
    text.remove_prefix(1);
  else
    compound.tag = take_name(text);
  if (!compound.tag.empty()) ++compound.specificity;
  while (!text.empty()) {
    const char kind = text[0];
    if (kind == '[') {
      if (!read_attribute(text, compound)) return false;
      continue;
    }
    if (kind != '.' && kind != '#' && kind != ':') break;
    text.remove_prefix(1);
    if (kind == ':') {
      if (!read_pseudo(text, compound, depth)) return false;
      continue;
    }
    const std::string name = take_name(text);
    if (name.empty()) return false;
    if (kind == '.') compound.classes.push_back(name);
    if (kind == '#') compound.never = compound.never || (!compound.id.empty() && compound.id != name);
    if (kind == '#') compound.id = name;
    compound.specificity += kind == '#' ? kIdRank : kNameRank;
  }
  return text.size() < before;
}

std::optional<StyleSheet::Selector> StyleSheet::read_selector(std::string_view text, std::size_t depth) {
  constexpr std::size_t kMaxDepth = 20;
  if (depth > kMaxDepth) return std::nullopt;
  Selector selector;
  char relation = '\0';
  text = trim(text);
  while (!text.empty()) {
    Compound compound;
    compound.relation = relation;
    if (!read_compound(text, compound, depth)) return std::nullopt;
    selector.push_back(std::move(compound));
    const std::size_t blanks = std::min(text.find_first_not_of(kBlanks), text.size());
    relation = ' ';
    text.remove_prefix(blanks);
    if (text.empty()) break;
    if (text[0] == '>' || text[0] == '+' || text[0] == '~') {
      relation = text[0];
      text.remove_prefix(1);
      text = trim(text);
      if (text.empty()) return std::nullopt;
    } else if (blanks == 0) {
      return std::nullopt;
    }
  }
  return selector.empty() ? std::nullopt : std::optional(std::move(selector));
}

bool StyleSheet::add_rule(std::string_view text, const std::vector<std::size_t>& declarations) {
  Rule rule;
  rule.declarations = declarations;
  auto selector = read_selector(text, 0);
  if (!selector) return false;
  rule.selector = std::move(*selector);
  for (const Compound& compound : rule.selector) rule.specificity += compound.specificity;
  const Compound& last = rule.selector.back();
  const std::string key = !last.id.empty()        ? "#" + last.id
                          : !last.classes.empty() ? "." + last.classes.front()
                          : !last.tag.empty()     ? last.tag
                                                  : "*";
  by_key_[key].push_back(rules_.size());
  rules_.push_back(std::move(rule));
  return true;
}

bool StyleSheet::matches(const Position& position, const Element& element) {
  if (element.parent == nullptr) return false;
  const Element::Number& number = position.is_of_type ? element.number_of_name : element.number;
  const std::size_t at = position.is_from_end ? number.count + 1 - number.at : number.at;
  const auto steps = static_cast<std::ptrdiff_t>(at) - position.first;
  if (position.step == 0) return steps == 0;
  return steps % position.step == 0 && steps / position.step >= 0;
}

bool StyleSheet::matches(const Compound& compound, const Element& element) const {
  if (compound.never) return false;
  if (!compound.tag.empty() && compound.tag != element.name) return false;
  if (!compound.id.empty() && compound.id != element.attribute("id")) return false;
  if (compound.is_root && element.parent != nullptr) return false;
  for (const std::string& name : compound.classes)
    if (!has_word(element.attribute("class"), name)) return false;
  for (const Choice& choice : compound.choices)
    if (choice.is_negated == std::any_of(choice.selectors.begin(), choice.selectors.end(),
                                         [&](const Selector& s) { return matches(s, element); }))
      return false;
  for (const Position& position : compound.positions)
    if (!matches(position, element)) return false;
  return std::all_of(compound.attributes.begin(), compound.attributes.end(), [&](const Attribute& a) {
    const std::string_view value = element.attribute(a.name), wanted = a.value;
    switch (a.match) {
      case '\0': return element.has(a.name);
      case '=': return element.has(a.name) && value == wanted;
      case '~': return !wanted.empty() && has_word(value, wanted);
      case '|': return value == wanted || value.substr(0, wanted.size() + 1) == std::string(wanted) + "-";
      case '^': return !wanted.empty() && value.substr(0, wanted.size()) == wanted;
      case '$':
        return !wanted.empty() && value.size() >= wanted.size() &&
               value.substr(value.size() - wanted.size()) == wanted;
      default: return !wanted.empty() && value.find(wanted) != std::string_view::npos;
    }
  });
}

/// Whether the first `count` compounds of a selector, the last of them for this element, match; `failed` has
/// the counts and elements that are known not to.
bool StyleSheet::matches(const Selector& selector, std::size_t count, const Element& element,
                         Failed& failed) const {
  const Compound& compound = selector[count - 1];
  if (!matches(compound, element)) return false;
  if (count == 1) return true;
  if (failed.count({count, &element}) > 0) return false;
  const bool is_beside = compound.relation == '+' || compound.relation == '~';
  const auto next = [&](const Element& from) { return is_beside ? sibling_before(from) : from.parent; };
  for (const Element* e = next(element); e != nullptr; e = next(*e)) {
    if (matches(selector, count - 1, *e, failed)) return true;
    if (compound.relation == '+' || compound.relation == '>') break;
    if (compound.relation == '~' && failed_beside_.count({&compound, e}) > 0) break;
  }
  failed.insert({count, &element});
  if (compound.relation == '~') failed_beside_.insert({&compound, &element});
  return false;
}

bool StyleSheet::matches(const Selector& selector, const Element& element) const {
  Failed failed;
  return matches(selector, selector.size(), element, failed);
}

// ----------------------------------------------------------------------------------------------------- rules

void StyleSheet::read(std::string_view css) {
  const std::string plain = without_comments(css);
  std::string_view text = plain;
  while (true) {
    const std::size_t open = find_outside(text, "{;");
    if (open >= text.size()) return;
    std::string_view selectors = trim(text.substr(0, open));
    const bool is_block = text[open] == '{';
    text.remove_prefix(open + 1);
    if (!is_block) {  // @import is in another file; @charset and @namespace have no effect
      if (lowered(selectors.substr(0, 7)) == "@import") unknown_.emplace_back(selectors);
      continue;
    }
    if (selectors.substr(0, 1) == "@") {
      const std::string media = lowered(trim(selectors.substr(0, 6))) == "@media"
                                    ? lowered(trim(selectors.substr(6)))
                                    : std::string("none");
      std::size_t depth = 1, end = 0;
      while (end < text.size() && depth > 0) {
        depth += text[end] == '{' ? 1 : 0;
        depth -= text[end] == '}' ? 1 : 0;
        ++end;
      }
      if (media == "screen" || media == "all" || media.empty()) read(text.substr(0, end - (depth == 0)));
      text.remove_prefix(end);
      continue;
    }
    const std::size_t close = find_outside(text, "}");
    std::vector<std::size_t> indices;
    for (Declaration& d : declarations_of(text.substr(0, close))) {
      indices.push_back(declarations_.size());
      declarations_.push_back(std::move(d));
    }
    text.remove_prefix(std::min(close + 1, text.size()));
    while (!selectors.empty()) {
      const std::size_t comma = find_outside(selectors, ",");
      if (!add_rule(selectors.substr(0, comma), indices)) unknown_.emplace_back(selectors.substr(0, comma));
      selectors.remove_prefix(std::min(comma + 1, selectors.size()));
    }
  }
}

Properties StyleSheet::properties(const Element& element,
                                  const std::shared_ptr<const Variables>& inherited) const {
  std::vector<std::size_t> found;
  const auto collect = [&](std::string_view key) {
    const auto rules = by_key_.find(key);
    if (rules == by_key_.end()) return;
    for (const std::size_t index : rules->second) {
      if (matches(rules_[index].selector, element)) found.push_back(index);
    }
  };
  std::vector<const Declaration*> declarations;
  if (!rules_.empty()) {
    collect("*");
    collect(element.name);
    if (const auto id = element.attribute("id"); !id.empty()) collect("#" + std::string(id));
    std::string_view classes = element.attribute("class");
    while (!(classes = trim(classes)).empty()) {
      const std::size_t end = std::min(classes.find_first_of(kBlanks), classes.size());
      collect("." + std::string(classes.substr(0, end)));
      classes.remove_prefix(end);
    }
    std::sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
      return rules_[a].specificity != rules_[b].specificity ? rules_[a].specificity < rules_[b].specificity
                                                            : a < b;
    });
    for (const std::size_t index : found)
      for (const std::size_t d : rules_[index].declarations) declarations.push_back(&declarations_[d]);
  }
  return {element, std::move(declarations), inherited};
}

}  // namespace kerf::svg
#endif
