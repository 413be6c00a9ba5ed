// Checks of the arguments of commands.
#include "design/machine/arguments.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/names.h"
#include "codec/drawing/colour_names.h"
#include "design/call/call.h"

#include "kerf/base/limits.h"
#include "kerf/drawing/drawing_files.h"

namespace kerf::design {
namespace {

struct NamedColour {
  std::string_view name;
  int index;
};
constexpr NamedColour kColours[] = {{"Black", 7},     {"Red", 1},       {"Yellow", 2},  {"Green", 3},
                                    {"Cyan", 4},      {"Blue", 5},      {"Magenta", 6}, {"White", 7},
                                    {"Dark Gray", 8}, {"Light Gray", 9}};
/// Web colours that are other names of those above, or have a near one among them.
struct WebColour {
  std::string_view name, drawn;
};
constexpr WebColour kWebColours[] = {{"Aqua", "Cyan"},
                                     {"Fuchsia", "Magenta"},
                                     {"Gray", "Dark Gray"},
                                     {"Grey", "Dark Gray"},
                                     {"Silver", "Light Gray"},
                                     {"Dark Grey", "Dark Gray"},
                                     {"Light Grey", "Light Gray"},
                                     {"Lime", "Green"},
                                     {"Maroon", "Red"},
                                     {"Olive", "Yellow"},
                                     {"Teal", "Cyan"},
                                     {"Navy", "Blue"},
                                     {"Purple", "Magenta"},
                                     {"Orange", "Yellow"}};

std::vector<std::string> colour_names() {
  std::vector<std::string> names;
  for (const NamedColour& colour : kColours) names.emplace_back(colour.name);
  for (const WebColour& colour : kWebColours) names.emplace_back(colour.name);
  return names;
}

std::string shown(std::string_view text) { return "\"" + clipped(text, 60) + "\""; }

}  // namespace

double coordinate(double value, std::string_view name) {
  if (!(std::abs(value) <= limits::kMaxCoordinate))
    refuse(fmt::format("{} must be a number up to {:g} mm, not {:g}", name, limits::kMaxCoordinate, value));
  return value;
}

double positive(double value, std::string_view name) {
  if (!(value > 0.0)) refuse(fmt::format("{} must be above 0, not {:g}", name, value));
  return coordinate(value, name);
}

double not_negative(double value, std::string_view name) {
  if (!(value >= 0.0)) refuse(fmt::format("{} must not be below 0, not {:g}", name, value));
  return coordinate(value, name);
}

int whole(double value, std::string_view name, int low, int high) {
  if (value != std::floor(value)) refuse(fmt::format("{} must be a whole number, not {:g}", name, value));
  if (value < low) refuse(fmt::format("{} must be at least {}, not {:g}", name, low, value));
  if (value > high) refuse(fmt::format("{} must be at most {}, not {:g}", name, high, value));
  return static_cast<int>(value);
}

std::size_t choice(std::string_view value, const std::vector<std::string>& known, std::string_view name) {
  const std::string folded = fold_name(value);
  for (std::size_t i = 0; i < known.size(); ++i)
    if (fold_name(known[i]) == folded) return i;
  refuse(fmt::format("{}: {} is unknown; known: {}", name, shown(value), joined(known, ", ")));
}

std::string DrawingColour::layer() const {
  std::string text = "Layer_" + name;
  std::replace(text.begin(), text.end(), ' ', '_');
  return text;
}

std::array<std::uint8_t, 3> css_colour(std::string_view text, std::string_view name) {
  std::string plain(text);
  if (plain.find('(') == std::string::npos)
    std::erase_if(plain, [](char c) { return c == ' ' || c == '-' || c == '_'; });
  if (const auto colour = svg::read_colour(plain)) return colour->rgb;
  refuse(fmt::format("{}: {} is no colour; a name such as \"red\" or \"#ff8000\" is required", name,
                     shown(text)));
}

namespace {

/// The drawing colour with the least distance to a colour of CSS.
DrawingColour nearest_colour(const std::array<std::uint8_t, 3>& rgb) {
  const auto away = [&](const NamedColour& named) {
    const auto other = colour_of_index(named.index);
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(double(rgb[i]) - double(other[i]), 2);
    return sum;
  };
  const NamedColour* best =
      std::min_element(std::begin(kColours), std::end(kColours),
                       [&](const NamedColour& a, const NamedColour& b) { return away(a) < away(b); });
  return {std::string(best->name), best->index};
}

bool is_known(std::string_view name, const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& known) { return fold_name(known) == fold_name(name); });
}

}  // namespace

DrawingColour drawing_colour(std::string_view name) {
  static const std::vector<std::string> names = colour_names();
  if (!is_known(name, names) && svg::read_colour(name)) return nearest_colour(svg::read_colour(name)->rgb);
  std::string_view drawn = names[choice(name, names, "color")];
  for (const WebColour& colour : kWebColours)
    if (colour.name == drawn) drawn = colour.drawn;
  for (const NamedColour& colour : kColours)
    if (colour.name == drawn) return {std::string(drawn), colour.index};
  return {};
}

ZeroCorner zero_corner(std::string_view name) {
  if (const auto corner = parse_zero_corner(name)) return *corner;
  refuse(
      fmt::format("stockzero: {} is unknown; known: Lower-Left, Lower-Center, Lower-Right, Center-Left, "
                  "Center, Center-Right, Top-Left, Top-Center, Top-Right",
                  shown(name)));
}

ZeroHeight zero_height(std::string_view name) {
  if (const auto height = parse_zero_height(name)) return *height;
  refuse(fmt::format("zeroheight: {} is unknown; known: Top, Bottom", shown(name)));
}

}  // namespace kerf::design
