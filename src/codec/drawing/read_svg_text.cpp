// The texts of SVG: their characters with their positions and fonts. How wide they are is not known here.
#if KERF_WITH_SVG
#include <algorithm>
#include <fmt/format.h>
#include <memory>

#include "base/codes/outline.h"
#include "base/names.h"
#include "base/number.h"
#include "base/utf8.h"
#include "codec/drawing/svg_reader.h"

namespace kerf::svg {
namespace {

constexpr int kBold = 700, kRegular = 400;

/// "Arial, 'DejaVu Sans', serif" as names without quotes.
std::vector<std::string> families_of(std::string_view text) {
  std::vector<std::string> out;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    std::string_view one = trim(text.substr(0, comma));
    text.remove_prefix(std::min(comma + 1, text.size()));
    if (one.size() >= 2 && (one.front() == '"' || one.front() == '\'') && one.back() == one.front())
      one = one.substr(1, one.size() - 2);
    if (!one.empty()) out.emplace_back(one);
  }
  return out;
}

/// The weight that a word names; nothing if it is none.
std::optional<int> weight_of(std::string_view word, int inherited) {
  if (word == "normal") return kRegular;
  if (word == "bold") return kBold;
  if (word == "bolder") return inherited < 350 ? kRegular : inherited < 550 ? kBold : 900;
  if (word == "lighter") return inherited < 550 ? 100 : inherited < 750 ? kRegular : kBold;
  const auto number = parse_number(word);
  if (!number || !(*number >= 1.0 && *number <= 1000.0)) return std::nullopt;
  return static_cast<int>(*number);
}

bool is_italic(std::string_view word) { return word == "italic" || word.substr(0, 7) == "oblique"; }

/// The parts of the shorthand `font`: "italic bold 12px/1.2 Arial, serif".
struct FontShorthand {
  std::string weight, style, size, families;
};
std::optional<FontShorthand> read_font_shorthand(std::string_view text) {
  FontShorthand made;
  while (!(text = trim(text)).empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
    text.remove_prefix(word.size());
    const auto length = read_length(word.substr(0, word.find('/')));
    const auto weight = weight_of(word, kRegular);
    if (weight && word != "normal") {
      made.weight = word;
    } else if (is_italic(word)) {
      made.style = word;
    } else if (length) {
      made.size = word.substr(0, word.find('/'));
      made.families = trim(text);
      return made.families.empty() ? std::nullopt : std::optional(made);
    }
  }
  return std::nullopt;
}

}  // namespace

/// The properties of fonts. Those of the shorthand give way to the single ones.
void SvgReader::apply_font(const Drawn& drawn, Context& context) {
  const auto find = [&](std::string_view key) { return drawn.properties.find(key); };
  dxf::StyledText::Style& font = context.style.font;
  const auto shorthand = read_font_shorthand(drawn.properties.declared("font"));
  if (shorthand) {
    font.families = families_of(shorthand->families);
    font.weight = weight_of(shorthand->weight, font.weight).value_or(kRegular);
    font.italic = is_italic(shorthand->style);
    const auto size = read_length(shorthand->size);
    if (const auto em = resolved(*size, context.base, Axis::x); em && find("font-size").empty())
      context.base.em = *em;
  }
  const std::string_view families = find("font-family"), style = find("font-style");
  if (!families.empty() && families != "inherit") font.families = families_of(families);
  font.weight = weight_of(find("font-weight"), font.weight).value_or(font.weight);
  if (!style.empty() && style != "inherit") font.italic = is_italic(style);
  font.size = context.base.em;
  const Drawn inside{drawn.element, drawn.properties, context};
  for (const auto& [key, value] :
       {std::pair("letter-spacing", &font.letter_spacing), std::pair("word-spacing", &font.word_spacing)}) {
    if (find(key).empty()) continue;
    *value = find(key) == "normal" ? 0.0 : length_of(inside, key, Axis::x).value_or(*value);
  }
  const std::string_view anchor = find("text-anchor"), space = drawn.properties.declared("white-space");
  using Anchor = dxf::StyledText::Anchor;
  if (anchor == "start") font.anchor = Anchor::start;
  if (anchor.starts_with("mid")) font.anchor = Anchor::centre;
  if (anchor == "end") font.anchor = Anchor::end;
  if (const auto kept = drawn.element.attribute("xml:space"); !kept.empty())
    context.style.keeps_blanks = kept == "preserve";
  if (!space.empty() && space != "inherit") context.style.keeps_blanks = space.substr(0, 3) == "pre";
}

// ---------------------------------------------------------------------------------------------------- texts

/// A text while its elements are visited.
struct SvgReader::TextBuilder {
  struct Painted {
    std::uint32_t layer = 0, paint = 0;
    bool is_hidden = false;
  };
  struct Given {
    bool x = false, y = false, dx = false, dy = false, turn = false;
  };
  dxf::StyledText made;
  std::vector<Painted> painted;  // by style
  std::vector<Given> given;      // by character
  bool ends_in_blank = true;     // of those that are collapsed

  void append(std::string_view text, bool keeps_blanks, std::uint32_t style) {
    for (char32_t c : from_utf8(text)) {
      if (c == U'\n' || c == U'\t' || c == U'\r' || c == U'\f') c = U' ';
      if (c == U' ' && !keeps_blanks && ends_in_blank) continue;
      ends_in_blank = c == U' ' && !keeps_blanks;
      made.characters.push_back({c, style, {}, {}, 0.0, 0.0, 0.0});
    }
    given.resize(made.characters.size());
  }
};

/// A list of lengths, up to the first that is invalid.
std::vector<double> SvgReader::lengths_of(const Drawn& drawn, std::string_view key, Axis axis) {
  std::vector<double> out;
  const std::string_view whole = drawn.element.attribute(key);
  for (std::string_view text = whole; !text.empty();) {
    constexpr std::string_view kBetween = " \t\r\n,";
    const std::size_t start = std::min(text.find_first_not_of(kBetween), text.size());
    text.remove_prefix(start);
    if (text.empty()) break;
    const std::string_view word = text.substr(0, text.find_first_of(kBetween));
    text.remove_prefix(word.size());
    const auto value = read_length(word);
    const auto length = value ? resolved(*value, drawn.context.base, axis) : std::nullopt;
    if (!length) {
      warn(drawn.element, key, whole, "is invalid; its numbers up to there are used");
      break;
    }
    out.push_back(*length);
  }
  return out;
}

/// Appends the characters of a text, tspan or link, and sets their positions: those of inner elements, which
/// are set first, stay.
void SvgReader::collect_text(const Drawn& drawn, TextBuilder& text, std::size_t depth) {
  const std::size_t first = text.made.characters.size();
  const auto style = static_cast<std::uint32_t>(text.made.styles.size());
  const EntityWriter::Setting setting = setting_of(drawn);
  text.made.styles.push_back(drawn.context.style.font);
  text.painted.push_back({setting.layer, setting.paint, setting.is_hidden});
  for (const char* key : {"baseline-shift", "dominant-baseline", "alignment-baseline", "writing-mode",
                          "text-decoration", "textLength", "font-variant", "font-stretch", "direction"}) {
    const std::string_view value = drawn.properties.find(key);
    const bool is_usual = value.empty() || value == "auto" || value == "baseline" || value == "none" ||
                          value == "normal" || value == "inherit" || value == "ltr" || value == "lr-tb" ||
                          value == "lr" || value == "horizontal-tb" || value == "alphabetic" ||
                          value == "0" || value == "100%";
    if (!is_usual && !setting.is_hidden)
      note_ignored(drawn.element, fmt::format("{} {}", key, clipped(value, 40)));
  }
  for (const Element& child : drawn.element.children) {
    if (child.name == "#text") {
      text.append(child.text, drawn.context.style.keeps_blanks, style);
      continue;
    }
    if (child.name == "textPath" || child.name == "tref" || child.name == "altGlyph")
      note_ignored(child, child.name);
    if ((child.name != "tspan" && child.name != "a") || !within_limits(child, depth) ||
        !passes_conditions(child))
      continue;
    const Properties properties = sheet_.properties(child, drawn.context.variables);
    Context outside = drawn.context;
    if (const auto context = entered(child, properties, outside))
      collect_text({child, properties, *context}, text, depth + 1);
  }
  auto& all = text.made.characters;
  const auto set = [&](const char* key, Axis axis, bool TextBuilder::Given::*is_given, auto put) {
    const std::vector<double> values = lengths_of(drawn, key, axis);
    for (std::size_t i = 0; i < values.size() && first + i < all.size(); ++i)
      if (!std::exchange(text.given[first + i].*is_given, true)) put(all[first + i], values[i]);
  };
  using Given = TextBuilder::Given;
  using Character = dxf::StyledText::Character;
  set("x", Axis::x, &Given::x, [](Character& c, double v) { c.x = v; });
  set("y", Axis::y, &Given::y, [](Character& c, double v) { c.y = v; });
  set("dx", Axis::x, &Given::dx, [](Character& c, double v) { c.dx = v; });
  set("dy", Axis::y, &Given::dy, [](Character& c, double v) { c.dy = v; });
  const std::vector<double> turns = read_numbers(drawn.element.attribute("rotate")).values;
  for (std::size_t i = first; i < all.size() && !turns.empty(); ++i)
    if (!std::exchange(text.given[i].turn, true)) all[i].turn = turns[std::min(i - first, turns.size() - 1)];
}

/// Appends an entity for each style of a text.
void SvgReader::draw_text(const Drawn& drawn, std::size_t depth) {
  TextBuilder text;
  collect_text(drawn, text, depth + 1);
  auto& all = text.made.characters;
  if (text.ends_in_blank && !all.empty()) all.pop_back();
  if (all.empty()) return;
  const Affine& m = drawn.context.matrix;
  text.made.matrix = {m.a, m.b, m.c, m.d, m.e, m.f};
  segments_ += all.size();
  std::vector<bool> is_used(text.made.styles.size(), false);
  for (const auto& c : all) is_used[c.style] = true;
  const auto shared = std::make_shared<const dxf::StyledText>(std::move(text.made));
  for (std::uint32_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) continue;
    dxf::Entity& entity = drawing_.entities.emplace_back();
    entity.layer = text.painted[i].layer;
    entity.paint = text.painted[i].paint;
    entity.hidden = text.painted[i].is_hidden;
    entity.position = drawn.element.line;
    entity.shape = dxf::TextPart{shared, i};
  }
}

}  // namespace kerf::svg
#endif
