// The fonts of data/fonts, read when the first text is set.
#include "geom/text/stroke_fonts.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string_view>

#include "base/names.h"
#include "embedded_stroke_fonts.h"

namespace kerf {
namespace {

int number_at(std::string_view text, std::size_t& at, int base = 10) {
  int value = 0;
  const auto result = std::from_chars(text.data() + at, text.data() + text.size(), value, base);
  at = static_cast<std::size_t>(result.ptr - text.data());
  return value;
}

/// A line of strokes.txt: "41 18 9,21 1,0|9,21 17,0".
void read_glyph(std::string_view line, StrokeFont& font) {
  std::size_t at = 0;
  const auto code = static_cast<char32_t>(number_at(line, at, 16));
  StrokeGlyph& glyph = font[code];
  ++at;
  glyph.advance = number_at(line, at);
  if (at + 1 >= line.size()) return;
  glyph.strokes.emplace_back();
  while (at < line.size()) {
    if (line[at] == '|') glyph.strokes.emplace_back();
    ++at;
    StrokePoint p{};
    p.x = static_cast<std::int16_t>(number_at(line, at));
    ++at;
    p.y = static_cast<std::int16_t>(number_at(line, at));
    glyph.strokes.back().push_back(p);
  }
}

std::map<std::int32_t, StrokeFont> read_fonts() {
  std::map<std::int32_t, StrokeFont> fonts;
  StrokeFont* font = nullptr;
  std::string_view text = embedded::stroke_fonts[0].bytes;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line[0] == '#') continue;
    if (line.substr(0, 5) == "font ") {
      std::size_t at = 5;
      font = &fonts[number_at(line, at)];
    } else if (font != nullptr) {
      read_glyph(line, *font);
    }
  }
  return fonts;
}

struct Name {
  std::string_view name;
  std::int32_t number;
};
constexpr std::array<Name, 8> kNames{{{"sans", 1},
                                      {"sans-2", 2},
                                      {"script", 3},
                                      {"script-2", 4},
                                      {"serif", 5},
                                      {"serif-bold", 0x105},
                                      {"serif-italic", 0x205},
                                      {"serif-bold-italic", 0x305}}};

}  // namespace

const StrokeFont* stroke_font(std::int32_t number) {
  static const std::map<std::int32_t, StrokeFont> fonts = read_fonts();
  const auto found = fonts.find(number);
  return found == fonts.end() ? nullptr : &found->second;
}

const std::vector<std::string_view>& stroke_font_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Name& n : kNames) all.push_back(n.name);
    return all;
  }();
  return names;
}

const StrokeFont* stroke_font(std::string_view name) {
  for (const Name& n : kNames)
    if (fold_name(n.name) == fold_name(name)) return stroke_font(n.number);
  return nullptr;
}

}  // namespace kerf
