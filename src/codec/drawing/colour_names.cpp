// Reads colours of CSS (CSS Color 4).
#include "codec/drawing/colour_names.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "base/names.h"
#include "base/number.h"

namespace kerf::svg {
namespace {

/// In the order of the alphabet.
constexpr std::pair<std::string_view, std::uint32_t> kNames[] = {{"aliceblue", 0xf0f8ff},
                                                                 {"antiquewhite", 0xfaebd7},
                                                                 {"aqua", 0x00ffff},
                                                                 {"aquamarine", 0x7fffd4},
                                                                 {"azure", 0xf0ffff},
                                                                 {"beige", 0xf5f5dc},
                                                                 {"bisque", 0xffe4c4},
                                                                 {"black", 0x000000},
                                                                 {"blanchedalmond", 0xffebcd},
                                                                 {"blue", 0x0000ff},
                                                                 {"blueviolet", 0x8a2be2},
                                                                 {"brown", 0xa52a2a},
                                                                 {"burlywood", 0xdeb887},
                                                                 {"cadetblue", 0x5f9ea0},
                                                                 {"chartreuse", 0x7fff00},
                                                                 {"chocolate", 0xd2691e},
                                                                 {"coral", 0xff7f50},
                                                                 {"cornflowerblue", 0x6495ed},
                                                                 {"cornsilk", 0xfff8dc},
                                                                 {"crimson", 0xdc143c},
                                                                 {"cyan", 0x00ffff},
                                                                 {"darkblue", 0x00008b},
                                                                 {"darkcyan", 0x008b8b},
                                                                 {"darkgoldenrod", 0xb8860b},
                                                                 {"darkgray", 0xa9a9a9},
                                                                 {"darkgreen", 0x006400},
                                                                 {"darkgrey", 0xa9a9a9},
                                                                 {"darkkhaki", 0xbdb76b},
                                                                 {"darkmagenta", 0x8b008b},
                                                                 {"darkolivegreen", 0x556b2f},
                                                                 {"darkorange", 0xff8c00},
                                                                 {"darkorchid", 0x9932cc},
                                                                 {"darkred", 0x8b0000},
                                                                 {"darksalmon", 0xe9967a},
                                                                 {"darkseagreen", 0x8fbc8f},
                                                                 {"darkslateblue", 0x483d8b},
                                                                 {"darkslategray", 0x2f4f4f},
                                                                 {"darkslategrey", 0x2f4f4f},
                                                                 {"darkturquoise", 0x00ced1},
                                                                 {"darkviolet", 0x9400d3},
                                                                 {"deeppink", 0xff1493},
                                                                 {"deepskyblue", 0x00bfff},
                                                                 {"dimgray", 0x696969},
                                                                 {"dimgrey", 0x696969},
                                                                 {"dodgerblue", 0x1e90ff},
                                                                 {"firebrick", 0xb22222},
                                                                 {"floralwhite", 0xfffaf0},
                                                                 {"forestgreen", 0x228b22},
                                                                 {"fuchsia", 0xff00ff},
                                                                 {"gainsboro", 0xdcdcdc},
                                                                 {"ghostwhite", 0xf8f8ff},
                                                                 {"gold", 0xffd700},
                                                                 {"goldenrod", 0xdaa520},
                                                                 {"gray", 0x808080},
                                                                 {"green", 0x008000},
                                                                 {"greenyellow", 0xadff2f},
                                                                 {"grey", 0x808080},
                                                                 {"honeydew", 0xf0fff0},
                                                                 {"hotpink", 0xff69b4},
                                                                 {"indianred", 0xcd5c5c},
                                                                 {"indigo", 0x4b0082},
                                                                 {"ivory", 0xfffff0},
                                                                 {"khaki", 0xf0e68c},
                                                                 {"lavender", 0xe6e6fa},
                                                                 {"lavenderblush", 0xfff0f5},
                                                                 {"lawngreen", 0x7cfc00},
                                                                 {"lemonchiffon", 0xfffacd},
                                                                 {"lightblue", 0xadd8e6},
                                                                 {"lightcoral", 0xf08080},
                                                                 {"lightcyan", 0xe0ffff},
                                                                 {"lightgoldenrodyellow", 0xfafad2},
                                                                 {"lightgray", 0xd3d3d3},
                                                                 {"lightgreen", 0x90ee90},
                                                                 {"lightgrey", 0xd3d3d3},
                                                                 {"lightpink", 0xffb6c1},
                                                                 {"lightsalmon", 0xffa07a},
                                                                 {"lightseagreen", 0x20b2aa},
                                                                 {"lightskyblue", 0x87cefa},
                                                                 {"lightslategray", 0x778899},
                                                                 {"lightslategrey", 0x778899},
                                                                 {"lightsteelblue", 0xb0c4de},
                                                                 {"lightyellow", 0xffffe0},
                                                                 {"lime", 0x00ff00},
                                                                 {"limegreen", 0x32cd32},
                                                                 {"linen", 0xfaf0e6},
                                                                 {"magenta", 0xff00ff},
                                                                 {"maroon", 0x800000},
                                                                 {"mediumaquamarine", 0x66cdaa},
                                                                 {"mediumblue", 0x0000cd},
                                                                 {"mediumorchid", 0xba55d3},
                                                                 {"mediumpurple", 0x9370db},
                                                                 {"mediumseagreen", 0x3cb371},
                                                                 {"mediumslateblue", 0x7b68ee},
                                                                 {"mediumspringgreen", 0x00fa9a},
                                                                 {"mediumturquoise", 0x48d1cc},
                                                                 {"mediumvioletred", 0xc71585},
                                                                 {"midnightblue", 0x191970},
                                                                 {"mintcream", 0xf5fffa},
                                                                 {"mistyrose", 0xffe4e1},
                                                                 {"moccasin", 0xffe4b5},
                                                                 {"navajowhite", 0xffdead},
                                                                 {"navy", 0x000080},
                                                                 {"oldlace", 0xfdf5e6},
                                                                 {"olive", 0x808000},
                                                                 {"olivedrab", 0x6b8e23},
                                                                 {"orange", 0xffa500},
                                                                 {"orangered", 0xff4500},
                                                                 {"orchid", 0xda70d6},
                                                                 {"palegoldenrod", 0xeee8aa},
                                                                 {"palegreen", 0x98fb98},
                                                                 {"paleturquoise", 0xafeeee},
                                                                 {"palevioletred", 0xdb7093},
                                                                 {"papayawhip", 0xffefd5},
                                                                 {"peachpuff", 0xffdab9},
                                                                 {"peru", 0xcd853f},
                                                                 {"pink", 0xffc0cb},
                                                                 {"plum", 0xdda0dd},
                                                                 {"powderblue", 0xb0e0e6},
                                                                 {"purple", 0x800080},
                                                                 {"rebeccapurple", 0x663399},
                                                                 {"red", 0xff0000},
                                                                 {"rosybrown", 0xbc8f8f},
                                                                 {"royalblue", 0x4169e1},
                                                                 {"saddlebrown", 0x8b4513},
                                                                 {"salmon", 0xfa8072},
                                                                 {"sandybrown", 0xf4a460},
                                                                 {"seagreen", 0x2e8b57},
                                                                 {"seashell", 0xfff5ee},
                                                                 {"sienna", 0xa0522d},
                                                                 {"silver", 0xc0c0c0},
                                                                 {"skyblue", 0x87ceeb},
                                                                 {"slateblue", 0x6a5acd},
                                                                 {"slategray", 0x708090},
                                                                 {"slategrey", 0x708090},
                                                                 {"snow", 0xfffafa},
                                                                 {"springgreen", 0x00ff7f},
                                                                 {"steelblue", 0x4682b4},
                                                                 {"tan", 0xd2b48c},
                                                                 {"teal", 0x008080},
                                                                 {"thistle", 0xd8bfd8},
                                                                 {"tomato", 0xff6347},
                                                                 {"turquoise", 0x40e0d0},
                                                                 {"violet", 0xee82ee},
                                                                 {"wheat", 0xf5deb3},
                                                                 {"white", 0xffffff},
                                                                 {"whitesmoke", 0xf5f5f5},
                                                                 {"yellow", 0xffff00},
                                                                 {"yellowgreen", 0x9acd32}};

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", without its first character.
std::optional<Colour> from_digits(std::string_view digits) {
  std::vector<int> values;
  for (const char c : digits) {
    const bool is_letter = c >= 'a' && c <= 'f';
    if (!is_letter && (c < '0' || c > '9')) return std::nullopt;
    values.push_back(is_letter ? c - 'a' + 10 : c - '0');
  }
  const std::size_t n = values.size(), width = n > 4 ? 2 : 1;
  if (n != 3 && n != 4 && n != 6 && n != 8) return std::nullopt;
  double parts[4] = {0.0, 0.0, 0.0, 255.0};
  for (std::size_t i = 0; i < n / width; ++i)
    parts[i] = 16 * values[i * width] + values[i * width + width - 1];
  return Colour{{byte_of(parts[0]), byte_of(parts[1]), byte_of(parts[2])}, parts[3] / 255.0};
}

/// A number with its unit: "%", "deg" or none.
struct Part {
  double value = 0.0;
  std::string_view unit;
};

std::optional<std::vector<Part>> parts_of(std::string_view text) {
  constexpr std::string_view kBetween = " \t\r\n\f,/";
  std::vector<Part> parts;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBetween), text.size()));
    if (text.empty()) return parts;
    const std::string_view word = text.substr(0, text.find_first_of(kBetween));
    text.remove_prefix(word.size());
    const std::size_t end = word.find_first_not_of("+-.0123456789e");
    const auto value = word == "none" ? std::optional(0.0) : parse_number(word.substr(0, end));
    if (!value) return std::nullopt;
    parts.push_back({*value, word == "none" || end == std::string_view::npos ? "" : word.substr(end)});
  }
}

/// The fraction of a colour of a hue in degrees; `offset` 0: red, 8: green, 4: blue (CSS Color 4, 7.1).
double fraction_of_hue(double hue, double saturation, double light, double offset) {
  const double k = std::fmod(offset + hue / 30.0, 12.0);
  return light -
         saturation * std::min(light, 1.0 - light) * std::max(-1.0, std::min({k - 3.0, 9.0 - k, 1.0}));
}

std::optional<Colour> from_function(std::string_view name, const std::vector<Part>& parts) {
  if (parts.size() != 3 && parts.size() != 4) return std::nullopt;
  Colour colour;
  if (parts.size() == 4)
    colour.alpha = std::clamp(parts[3].unit == "%" ? parts[3].value / 100.0 : parts[3].value, 0.0, 1.0);
  if (name == "rgb" || name == "rgba") {
    for (std::size_t i = 0; i < 3; ++i) {
      if (parts[i].unit != "%" && !parts[i].unit.empty()) return std::nullopt;
      colour.rgb[i] = byte_of(parts[i].unit == "%" ? 255.0 * parts[i].value / 100.0 : parts[i].value);
    }
    return colour;
  }
  if (name != "hsl" && name != "hsla") return std::nullopt;
  const double turn = parts[0].unit == "turn" ? 360.0 : parts[0].unit == "rad" ? 57.29577951308232 : 1.0;
  double hue = std::fmod(turn * parts[0].value, 360.0);
  if (hue < 0.0) hue += 360.0;
  const double saturation = std::clamp(parts[1].value / 100.0, 0.0, 1.0);
  const double light = std::clamp(parts[2].value / 100.0, 0.0, 1.0);
  constexpr double kOffsets[] = {0.0, 8.0, 4.0};
  for (std::size_t i = 0; i < 3; ++i)
    colour.rgb[i] = byte_of(255.0 * fraction_of_hue(hue, saturation, light, kOffsets[i]));
  return colour;
}

}  // namespace

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// The first colour of "light-dark(a, b)": a page is light.
static std::string_view first_of_pair(std::string_view inside) {
  int depth = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    depth += inside[i] == '(' ? 1 : inside[i] == ')' ? -1 : 0;
    if (depth == 0 && inside[i] == ',') return trim(inside.substr(0, i));
  }
  return {};
}

std::optional<Colour> read_colour(std::string_view text) {
  constexpr std::string_view kPair = "light-dark(";
  std::string name = lowered(trim(text));
  if (name.starts_with(kPair)) name = first_of_pair(std::string_view(name).substr(kPair.size()));
  if (name.empty()) return std::nullopt;
  if (name == "transparent") return Colour{{}, 0.0};
  if (name[0] == '#') return from_digits(std::string_view(name).substr(1));
  const std::size_t open = name.find('(');
  if (open != std::string::npos) {
    if (name.back() != ')') return std::nullopt;
    const auto parts = parts_of(std::string_view(name).substr(open + 1, name.size() - open - 2));
    return parts ? from_function(trim(std::string_view(name).substr(0, open)), *parts) : std::nullopt;
  }
  const auto* const found =
      std::lower_bound(std::begin(kNames), std::end(kNames), name,
                       [](const auto& row, const std::string& n) { return row.first < n; });
  if (found == std::end(kNames) || found->first != name) return std::nullopt;
  const std::uint32_t rgb = found->second;
  return Colour{{static_cast<std::uint8_t>(rgb >> 16), static_cast<std::uint8_t>(rgb >> 8 & 0xff),
                 static_cast<std::uint8_t>(rgb & 0xff)}};
}

std::string name_of(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.rgb[0], colour.rgb[1], colour.rgb[2]);
}

}  // namespace kerf::svg
