// Reads style sheets and style attributes, and finds the rules that apply to an element.
#if KERF_WITH_SVG
#include "codec/drawing/svg_style.h"

#include <algorithm>

#include "base/names.h"
#include "codec/drawing/colour_names.h"

namespace kerf::svg {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\f";

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
    out.push_back({lowered(trim(one.substr(0, colon))), std::string(value), is_important});
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

bool is_last_child(const Element& element) {
  const std::vector<Element>& all = element.parent->children;
  return std::all_of(all.begin() + static_cast<std::ptrdiff_t>(element.position) + 1, all.end(),
                     [](const Element& e) { return e.name == "#text"; });
}

}  // namespace

Properties::Properties(const Element& element, std::vector<const Declaration*> rules)
    : element_(element), rules_(std::move(rules)) {
  if (const auto style = element.attribute("style"); !style.empty())
    own_ = declarations_of(style.find("/*") == std::string_view::npos ? std::string(style)
                                                                      : without_comments(style));
}

std::string_view Properties::declared(std::string_view key) const {
  const Declaration* best = nullptr;
  const auto take = [&](const Declaration& d) {
    if (d.key == key && (best == nullptr || d.is_important || !best->is_important)) best = &d;
  };
  for (const Declaration* d : rules_) take(*d);
  for (const Declaration& d : own_) take(d);
  return best != nullptr ? std::string_view(best->value) : std::string_view();
}

std::string_view Properties::find(std::string_view key) const {
  const std::string_view value = declared(key);
  return value.empty() ? trim(element_.attribute(key)) : value;
}

// ------------------------------------------------------------------------------------------------- selectors

bool StyleSheet::read_attribute(std::string_view& text, Compound& compound) {
  text.remove_prefix(1);
  const std::size_t end = find_outside(text, "]");
  if (end >= text.size()) return false;
  std::string_view inside = trim(text.substr(0, end));
  text.remove_prefix(end + 1);
  Attribute& attribute = compound.attributes.emplace_back();
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

/// Takes the conditions on one element from the start of the text; false if they are not understood.
bool StyleSheet::read_compound(std::string_view& text, Compound& compound) {
  const std::size_t before = text.size();
  if (!text.empty() && text[0] == '*')
    text.remove_prefix(1);
  else
    compound.tag = take_name(text);
  while (!text.empty()) {
    const char kind = text[0];
    if (kind == '[') {
      if (!read_attribute(text, compound)) return false;
      continue;
    }
    if (kind != '.' && kind != '#' && kind != ':') break;
    text.remove_prefix(1);
    const std::string name = take_name(text);
    if (name.empty()) return false;
    if (kind == '.') compound.classes.push_back(name);
    if (kind == '#') compound.id = name;
    if (kind == ':') {
      if (name != "first-child" && name != "last-child" && name != "root") return false;
      compound.positions.push_back(name);
    }
  }
  return text.size() < before;
}

bool StyleSheet::add_rule(std::string_view text, const std::vector<std::size_t>& declarations) {
  Rule rule;
  rule.declarations = declarations;
  char relation = '\0';
  text = trim(text);
  while (!text.empty()) {
    Compound compound;
    compound.relation = relation;
    if (!read_compound(text, compound)) return false;
    const std::size_t names =
        compound.classes.size() + compound.positions.size() + compound.attributes.size();
    rule.specificity += (compound.id.empty() ? 0u : 1u << 20) + (static_cast<std::uint32_t>(names) << 10) +
                        (compound.tag.empty() ? 0u : 1u);
    rule.selector.push_back(std::move(compound));
    const std::size_t blanks = std::min(text.find_first_not_of(kBlanks), text.size());
    relation = ' ';
    text.remove_prefix(blanks);
    if (text.empty()) break;
    if (text[0] == '>' || text[0] == '+') {
      relation = text[0];
      text.remove_prefix(1);
      text = trim(text);
      if (text.empty()) return false;
    } else if (blanks == 0) {
      return false;
    }
  }
  if (rule.selector.empty()) return false;
  const Compound& last = rule.selector.back();
  const std::string key = !last.id.empty()        ? "#" + last.id
                          : !last.classes.empty() ? "." + last.classes.front()
                          : !last.tag.empty()     ? last.tag
                                                  : "*";
  by_key_[key].push_back(rules_.size());
  rules_.push_back(std::move(rule));
  return true;
}

bool StyleSheet::matches(const Compound& compound, const Element& element) {
  if (!compound.tag.empty() && compound.tag != element.name) return false;
  if (!compound.id.empty() && compound.id != element.attribute("id")) return false;
  for (const std::string& name : compound.classes)
    if (!has_word(element.attribute("class"), name)) return false;
  for (const std::string& position : compound.positions) {
    const Element* parent = element.parent;
    if (position == "root" ? parent != nullptr : parent == nullptr) return false;
    if (position == "first-child" && sibling_before(element) != nullptr) return false;
    if (position == "last-child" && !is_last_child(element)) return false;
  }
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
bool StyleSheet::matches(const std::vector<Compound>& selector, std::size_t count, const Element& element,
                         Failed& failed) {
  const Compound& compound = selector[count - 1];
  if (!matches(compound, element)) return false;
  if (count == 1) return true;
  if (failed.count({count, &element}) > 0) return false;
  const Element* e = compound.relation == '+' ? sibling_before(element) : element.parent;
  for (; e != nullptr; e = e->parent) {
    if (matches(selector, count - 1, *e, failed)) return true;
    if (compound.relation != ' ') break;
  }
  failed.insert({count, &element});
  return false;
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

Properties StyleSheet::properties(const Element& element) const {
  std::vector<std::size_t> found;
  const auto collect = [&](std::string_view key) {
    const auto rules = by_key_.find(key);
    if (rules == by_key_.end()) return;
    for (const std::size_t index : rules->second) {
      const Rule& rule = rules_[index];
      Failed failed;
      if (matches(rule.selector, rule.selector.size(), element, failed)) found.push_back(index);
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
  return {element, std::move(declarations)};
}

}  // namespace kerf::svg
#endif
