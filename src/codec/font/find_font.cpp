// Finds installed fonts by the names of families, styles and files.
#include "codec/font/find_font.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <set>

#include "base/ending.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/font/installed_fonts.h"

namespace kerf {
namespace {

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = small_letter(c);
  return out;
}

/// Fonts with the same widths of characters, and the usual ones of a kind, the first that is installed.
struct StandIn {
  std::string_view name;
  std::array<std::string_view, 7> fonts;
};
constexpr StandIn kStandIns[] = {
    {"sans-serif", {"Noto Sans", "DejaVu Sans", "Liberation Sans", "Arial", "Helvetica", "Roboto", ""}},
    {"sans", {"Noto Sans", "DejaVu Sans", "Liberation Sans", "Arial", "Helvetica", "Roboto", ""}},
    {"system-ui", {"Noto Sans", "DejaVu Sans", "Segoe UI", "Helvetica Neue", "Roboto", "Arial", ""}},
    {"serif", {"Noto Serif", "DejaVu Serif", "Liberation Serif", "Times New Roman", "Times", "", ""}},
    {"monospace", {"Noto Sans Mono", "DejaVu Sans Mono", "Liberation Mono", "Courier New", "Menlo", "", ""}},
    {"arial", {"Liberation Sans", "Arimo", "Helvetica", "Nimbus Sans", "", "", ""}},
    {"helvetica", {"Arial", "Liberation Sans", "Arimo", "Nimbus Sans", "", "", ""}},
    {"times new roman", {"Liberation Serif", "Tinos", "Times", "Nimbus Roman", "", "", ""}},
    {"times", {"Times New Roman", "Liberation Serif", "Tinos", "Nimbus Roman", "", "", ""}},
    {"courier new", {"Liberation Mono", "Cousine", "Courier", "Nimbus Mono PS", "", "", ""}},
    {"courier", {"Courier New", "Liberation Mono", "Cousine", "Nimbus Mono PS", "", "", ""}},
    {"calibri", {"Carlito", "", "", "", "", "", ""}},
    {"cambria", {"Caladea", "", "", "", "", "", ""}}};

/// The nearest face of a family: by width, slant and weight, in this order, as CSS chooses.
const InstalledFont* of_family(std::string_view family, const FontWish& wish) {
  const std::string name = lowered(family);
  const InstalledFont* best = nullptr;
  std::array<int, 3> least{};
  for (const InstalledFont& font : installed_fonts()) {
    const bool is_whole =
        lowered(font.post_script) == name || lowered(font.family + " " + font.style) == name;
    if (lowered(font.family) != name && !is_whole) continue;
    // Between two weights that are equally far the bolder one is taken for bold wishes.
    const int off = font.weight - wish.weight, bolder = wish.weight > 500 ? off : -off;
    const std::array<int, 3> cost{is_whole ? -1 : std::abs(font.width - kNormalFontWidth),
                                  font.italic != wish.italic ? 1 : 0,
                                  2 * std::abs(off) - (bolder > 0 ? 1 : 0)};
    if (best == nullptr || cost < least) {
      best = &font;
      least = cost;
    }
  }
  return best;
}

FoundFont found(const InstalledFont& font, const FontWish& wish, bool is_stand_in) {
  constexpr int kSameWeight = 100;
  const bool is_near = std::abs(font.weight - wish.weight) <= kSameWeight;
  return {font.file, font.face, font.family + " " + font.style, is_stand_in,
          font.italic != wish.italic || !is_near};
}

/// A family of CSS that names no font.
bool is_kind(std::string_view family) {
  constexpr std::array<std::string_view, 7> kKinds{"serif",   "sans-serif", "monospace", "sans",
                                                   "cursive", "fantasy",    "system-ui"};
  return std::find(kKinds.begin(), kKinds.end(), lowered(family)) != kKinds.end();
}

/// The installed font that is usual for a kind, or has the widths of a family that is not installed; null
/// without one.
const InstalledFont* stand_in_for(std::string_view family, const FontWish& wish) {
  if (const std::string usual = is_kind(family) ? usual_family(lowered(family)) : ""; !usual.empty())
    if (const InstalledFont* font = of_family(usual, wish)) return font;
  for (const StandIn& other : kStandIns) {
    if (other.name != lowered(family)) continue;
    for (const std::string_view name : other.fonts)
      if (const InstalledFont* font = name.empty() ? nullptr : of_family(name, wish)) return font;
  }
  return nullptr;
}

/// The words of a style, those of one meaning as one: "Bold Oblique" and "italic bold" are the same.
std::multiset<std::string> style_words(std::string_view style) {
  static constexpr std::pair<std::string_view, std::string_view> kSame[] = {{"oblique", "italic"},
                                                                            {"demibold", "semibold"},
                                                                            {"demi", "semibold"},
                                                                            {"heavy", "black"},
                                                                            {"ultrabold", "extrabold"},
                                                                            {"ultralight", "extralight"},
                                                                            {"narrow", "condensed"},
                                                                            {"regular", ""},
                                                                            {"book", ""},
                                                                            {"normal", ""},
                                                                            {"roman", ""},
                                                                            {"upright", ""}};
  std::multiset<std::string> words;
  while (!style.empty()) {
    const std::size_t end = std::min(style.find_first_of(" :,"), style.size());
    std::string word = lowered(style.substr(0, end));
    style.remove_prefix(std::min(end + 1, style.size()));
    if (word.starts_with("style=")) word.erase(0, 6);
    std::erase(word, '-');
    for (const auto& [other, name] : kSame)
      if (word == other) word = name;
    if (!word.empty()) words.insert(std::move(word));
  }
  return words;
}

/// The face of a family with exactly this style; null without one.
const InstalledFont* of_style(std::string_view family, std::string_view style) {
  const std::string name = lowered(family);
  const auto words = style_words(style);
  for (const InstalledFont& font : installed_fonts())
    if (lowered(font.family) == name && style_words(font.style) == words) return &font;
  return nullptr;
}

std::vector<std::string> styles_of(std::string_view family) {
  std::set<std::string> styles;
  for (const InstalledFont& font : installed_fonts())
    if (lowered(font.family) == lowered(family) && !font.style.empty()) styles.insert(font.style);
  return {styles.begin(), styles.end()};
}

}  // namespace

std::vector<std::string> near_families(std::string_view name) {
  constexpr std::size_t kMaxNear = 5;
  std::set<std::string> all;
  for (const InstalledFont& font : installed_fonts()) all.insert(font.family);
  std::vector<std::string> near, folded;
  const auto take = [&](const std::string& family) {
    if (near.size() < kMaxNear) near.push_back(family);
    all.erase(family);
  };
  const std::string wanted = fold_name(name);
  while (near.size() < kMaxNear) {
    folded.clear();
    for (const std::string& family : all) folded.push_back(fold_name(family));
    const auto close = did_you_mean(wanted, folded);
    if (!close) break;
    take(*std::find_if(all.begin(), all.end(), [&](const std::string& f) { return fold_name(f) == *close; }));
  }
  const std::string start = lowered(name.substr(0, name.find(' ')));
  for (const std::string& family : std::vector<std::string>(all.begin(), all.end()))
    if (start.size() > 2 && lowered(family).find(start) != std::string::npos) take(family);
  return near;
}

NamedFont find_named_font(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string family(trim(std::string_view(text).substr(0, colon)));
  const std::string style(trim(std::string_view(text).substr(std::min(colon + 1, text.size()))));
  const FontWish upright{{}, 400, false};
  const InstalledFont* any = of_family(family, upright);
  if (any == nullptr && is_kind(family)) any = stand_in_for(family, upright);
  if (any != nullptr) {
    const bool is_whole = lowered(any->family) != lowered(family) && !is_kind(family);
    const InstalledFont* font = any;
    if (!style.empty()) font = of_style(is_whole ? family : any->family, style);
    // "DejaVu Sans Condensed:bold", where that is the family "DejaVu Sans" with a style.
    if (font == nullptr && is_whole) font = of_style(any->family, any->style + " " + style);
    if (font != nullptr) return {found(*font, {{}, font->weight, font->italic}, false), ""};
    return {std::nullopt,
            fmt::format("the font \"{}\" has no style \"{}\"; it has: {}", clipped(any->family, 60),
                        clipped(style, 60), joined(styles_of(any->family), ", "))};
  }
  const std::vector<std::string> near = near_families(family);
  return {std::nullopt, fmt::format("there is no font \"{}\"{}{}", clipped(family, 60),
                                    near.empty() ? "" : "; near: ", joined(near, ", "))};
}

std::optional<FoundFont> find_font(const FontWish& wish) {
  std::vector<std::string> families = wish.families;
  if (families.empty()) families.emplace_back("serif");
  for (const std::string& family : families) {
    if (const InstalledFont* font = of_family(family, wish)) return found(*font, wish, false);
    if (const InstalledFont* font = stand_in_for(family, wish)) return found(*font, wish, true);
  }
  return std::nullopt;
}

std::optional<FoundFont> find_font_file(std::string_view name) {
  const std::string wanted = lowered(name.substr(name.find_last_of("/\\") + 1));
  for (const InstalledFont& font : installed_fonts())
    if (lowered(font.file.substr(font.file.find_last_of("/\\") + 1)) == wanted)
      return found(font, {{}, font.weight, font.italic}, false);
  return std::nullopt;
}

}  // namespace kerf
