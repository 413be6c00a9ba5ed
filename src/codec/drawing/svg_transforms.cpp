// Reads transforms: SVG 2, section 8.5, and CSS Transforms 1 and 2.
#if KERF_WITH_SVG
#include "codec/drawing/svg_transforms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/names.h"
#include "codec/drawing/colour_names.h"

namespace kerf::svg {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\f";

Affine turned(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle), 0.0, 0.0};
}
Affine skewed(double x, double y) {
  const auto tangent = [](double degrees) { return std::tan(degrees * std::numbers::pi / 180.0); };
  return {1, tangent(y), tangent(x), 1, 0, 0};
}

/// One function of the attribute.
std::optional<Affine> function_of(std::string_view name, const std::vector<double>& v) {
  const std::size_t n = v.size();
  const bool is_pair = n == 1 || n == 2;
  if (name == "matrix" && n == 6) return Affine{v[0], v[1], v[2], v[3], v[4], v[5]};
  if (name == "translate" && is_pair) return Affine{1, 0, 0, 1, v[0], n == 2 ? v[1] : 0.0};
  if (name == "scale" && is_pair) return Affine{v[0], 0, 0, n == 2 ? v[1] : v[0], 0, 0};
  if (name == "rotate" && n == 1) return turned(v[0]);
  if (name == "rotate" && n == 3)
    return Affine{1, 0, 0, 1, v[1], v[2]} * turned(v[0]) * Affine{1, 0, 0, 1, -v[1], -v[2]};
  if (name == "skewX" && n == 1) return skewed(v[0], 0.0);
  if (name == "skewY" && n == 1) return skewed(0.0, v[0]);
  return std::nullopt;
}

// ------------------------------------------------------------------------------------------------------- CSS

/// Rows of a transform in space; the last column is the shift.
using Spatial = std::array<std::array<double, 4>, 3>;
constexpr Spatial kHere{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

Spatial product(const Spatial& a, const Spatial& b) {
  Spatial out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + (j == 3 ? a[i][3] : 0.0);
  return out;
}
Spatial spatial(const Affine& m) { return {{{m.a, m.c, 0, m.e}, {m.b, m.d, 0, m.f}, {0, 0, 1, 0}}}; }
Affine projected(const Spatial& m, bool& is_tilted) {
  is_tilted = is_tilted || m[2][0] != 0.0 || m[2][1] != 0.0;
  return {m[0][0], m[1][0], m[0][1], m[1][1], m[0][3], m[1][3]};
}
Spatial shifted(double x, double y, double z) { return {{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}}}; }
Spatial scaled(double x, double y, double z) { return {{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}}; }
/// About an axis through the origin (the formula of Rodrigues).
Spatial turned_about(double x, double y, double z, double degrees) {
  const double length = std::hypot(x, y, z);
  if (length == 0.0) return kHere;
  if (x == 0.0 && y == 0.0) return spatial(turned(z > 0.0 ? degrees : -degrees));
  x /= length, y /= length, z /= length;
  const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle),
               k = 1 - c;
  return {{{c + x * x * k, x * y * k - z * s, x * z * k + y * s, 0},
           {y * x * k + z * s, c + y * y * k, y * z * k - x * s, 0},
           {z * x * k - y * s, z * y * k + x * s, c + z * z * k, 0}}};
}

/// Texts between separators that are outside of parentheses.
std::vector<std::string_view> parts_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> out;
  int depth = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : separators.front();
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (depth > 0 || (i < text.size() && separators.find(c) == std::string_view::npos)) continue;
    if (i < text.size() && depth < 0) continue;
    out.push_back(trim(text.substr(first, i - first)));
    first = i + 1;
  }
  return out;
}
std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> out = parts_of(text, kBlanks);
  out.erase(std::remove(out.begin(), out.end(), std::string_view()), out.end());
  return out;
}

std::optional<double> number(std::string_view text, double percent) {
  return css_value(text, [&](std::string_view unit) -> std::optional<double> {
    if (unit.empty()) return 1.0;
    return unit == "%" ? std::optional(percent) : std::nullopt;
  });
}
std::optional<double> angle(std::string_view text) {
  return css_value(text, [](std::string_view unit) -> std::optional<double> {
    if (unit == "deg") return 1.0;
    if (unit == "rad") return 180.0 / std::numbers::pi;
    if (unit == "grad") return 0.9;
    return unit == "turn" ? std::optional(360.0) : std::nullopt;
  });
}
std::optional<double> shift(std::string_view text, const TransformFrame& frame, Axis axis) {
  LengthBase base = frame.base;
  base.width = frame.box.width;
  base.height = frame.box.height;
  return css_value(text, [&](std::string_view unit) -> std::optional<double> {
    if (unit.empty()) return frame.takes_numbers ? std::optional(1.0) : std::nullopt;
    if (unit == "%") return 0.01 * (axis == Axis::x ? base.width : axis == Axis::y ? base.height : 0.0);
    return resolved({1.0, std::string(unit)}, base, axis);
  });
}

/// One function of CSS.
class Function {
 public:
  Function(std::string_view name, std::vector<std::string_view> arguments, const TransformFrame& frame)
      : name_(name), arguments_(std::move(arguments)), frame_(frame) {}

  std::optional<Spatial> read() {
    const std::size_t n = arguments_.size();
    std::optional<Spatial> made;
    if (name_.starts_with("translate")) made = move(n);
    if (name_.starts_with("scale")) made = scale(n);
    if (name_.starts_with("rotate")) made = turn(n);
    if (name_.starts_with("skew")) made = skew(n);
    if (name_ == "matrix" && n == 6) {
      const auto v = numbers(6, 0);
      made = spatial({v[0], v[1], v[2], v[3], v[4], v[5]});
    }
    if (name_ == "matrix3d" && n == 16) {  // by columns
      const auto v = numbers(16, 0);
      made = {{{v[0], v[4], v[8], v[12]}, {v[1], v[5], v[9], v[13]}, {v[2], v[6], v[10], v[14]}}};
      is_valid_ = is_valid_ && v[3] == 0.0 && v[7] == 0.0 && v[11] == 0.0 && v[15] == 1.0;
    }
    return is_valid_ ? made : std::nullopt;
  }

 private:
  double take(std::optional<double> value) {
    is_valid_ = is_valid_ && value.has_value();
    return value.value_or(0.0);
  }
  double length(std::size_t i, Axis axis) { return take(shift(arguments_[i], frame_, axis)); }
  double degrees(std::size_t i) { return take(angle(arguments_[i])); }
  std::vector<double> numbers(std::size_t count, double percent) {
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_percent = arguments_[i].ends_with('%');
      out.push_back(take(is_percent && percent == 0.0 ? std::nullopt : number(arguments_[i], percent)));
    }
    return out;
  }

  std::optional<Spatial> move(std::size_t n) {
    if (name_ == "translate" && (n == 1 || n == 2))
      return shifted(length(0, Axis::x), n == 2 ? length(1, Axis::y) : 0.0, 0.0);
    if (name_ == "translatex" && n == 1) return shifted(length(0, Axis::x), 0.0, 0.0);
    if (name_ == "translatey" && n == 1) return shifted(0.0, length(0, Axis::y), 0.0);
    if (name_ == "translatez" && n == 1) return shifted(0.0, 0.0, length(0, Axis::both));
    if (name_ == "translate3d" && n == 3)
      return shifted(length(0, Axis::x), length(1, Axis::y), length(2, Axis::both));
    return std::nullopt;
  }
  std::optional<Spatial> scale(std::size_t n) {
    const auto v = numbers(n, 0.01);
    if (name_ == "scale" && (n == 1 || n == 2)) return scaled(v[0], v[n - 1], 1.0);
    if (name_ == "scalex" && n == 1) return scaled(v[0], 1.0, 1.0);
    if (name_ == "scaley" && n == 1) return scaled(1.0, v[0], 1.0);
    if (name_ == "scalez" && n == 1) return scaled(1.0, 1.0, v[0]);
    if (name_ == "scale3d" && n == 3) return scaled(v[0], v[1], v[2]);
    return std::nullopt;
  }
  std::optional<Spatial> turn(std::size_t n) {
    if (name_ == "rotate3d" && n == 4) {
      const auto v = numbers(3, 0);
      return turned_about(v[0], v[1], v[2], degrees(3));
    }
    if (n != 1) return std::nullopt;
    if (name_ == "rotate" || name_ == "rotatez") return turned_about(0, 0, 1, degrees(0));
    if (name_ == "rotatex") return turned_about(1, 0, 0, degrees(0));
    if (name_ == "rotatey") return turned_about(0, 1, 0, degrees(0));
    return std::nullopt;
  }
  std::optional<Spatial> skew(std::size_t n) {
    if (name_ == "skew" && (n == 1 || n == 2)) return spatial(skewed(degrees(0), n == 2 ? degrees(1) : 0.0));
    if (name_ == "skewx" && n == 1) return spatial(skewed(degrees(0), 0.0));
    if (name_ == "skewy" && n == 1) return spatial(skewed(0.0, degrees(0)));
    return std::nullopt;
  }

  const std::string name_;
  const std::vector<std::string_view> arguments_;
  const TransformFrame& frame_;
  bool is_valid_ = true;
};

}  // namespace

std::optional<Affine> read_transform(std::string_view text) {
  Affine out;
  text = trim(text);
  while (!text.empty()) {
    const std::size_t open = text.find('('), close = text.find(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open)
      return std::nullopt;
    const Numbers numbers = read_numbers(text.substr(open + 1, close - open - 1));
    const auto next =
        numbers.error_at ? std::nullopt : function_of(trim(text.substr(0, open)), numbers.values);
    if (!next) return std::nullopt;
    out = out * *next;
    text = trim(text.substr(close + 1));
    if (!text.empty() && text.front() == ',') text = trim(text.substr(1));
  }
  return out;
}

std::optional<Affine> read_css_transform(std::string_view text, const TransformFrame& frame,
                                         bool& is_tilted) {
  if (lowered(trim(text)) == "none") return Affine{};
  Spatial out = kHere;
  const auto functions = words_of(text);
  for (std::size_t i = 0; i < functions.size(); ++i) {
    std::string_view one = functions[i];  // without a blank between, as in "rotate(1deg)scale(2)"
    while (!one.empty()) {
      const std::size_t open = one.find('(');
      if (open == std::string_view::npos) return std::nullopt;
      std::size_t close = open + 1;
      for (int depth = 1; depth > 0; ++close) {
        if (close >= one.size()) return std::nullopt;
        depth += one[close] == '(' ? 1 : one[close] == ')' ? -1 : 0;
      }
      const std::string_view inside = one.substr(open + 1, close - open - 2);
      const auto next = Function(lowered(one.substr(0, open)), parts_of(inside, ","), frame).read();
      if (!next) return std::nullopt;
      out = product(out, *next);
      one = trim(one.substr(close));
    }
  }
  return functions.empty() ? std::nullopt : std::optional(projected(out, is_tilted));
}

std::optional<Affine> read_single_transform(std::string_view property, std::string_view text,
                                            const TransformFrame& frame, bool& is_tilted) {
  if (lowered(trim(text)) == "none") return Affine{};
  std::vector<std::string_view> words = words_of(text);
  std::string name(property);
  if (property == "rotate") {
    for (const std::string_view axis : {"x", "y", "z"}) {
      const auto at =
          std::find_if(words.begin(), words.end(), [&](std::string_view w) { return lowered(w) == axis; });
      if (at == words.end()) continue;
      words.erase(at);
      name += axis;
      break;
    }
    // The angle may precede the axis.
    if (words.size() == 4 && angle(words[0]) && !number(words[0], 0.01))
      std::rotate(words.begin(), words.begin() + 1, words.end());
  }
  if (words.size() > 2) name += "3d";
  const auto made = Function(name, words, frame).read();
  return made ? std::optional(projected(*made, is_tilted)) : std::nullopt;
}

std::optional<Vec> read_origin(std::string_view text, const TransformFrame& frame) {
  std::vector<std::string> words;
  for (const std::string_view word : words_of(text)) words.push_back(lowered(word));
  if (words.empty() || words.size() > 3) return std::nullopt;
  if (words.size() == 1) words.emplace_back("center");
  const auto is_vertical = [](std::string_view word) { return word == "top" || word == "bottom"; };
  if (is_vertical(words[0]) || words[1] == "left" || words[1] == "right") std::swap(words[0], words[1]);
  const auto position = [&](std::string_view word, Axis axis) {
    const bool is_x = axis == Axis::x;
    if (word == "center") word = "50%";
    if (word == (is_x ? "left" : "top")) word = "0%";
    if (word == (is_x ? "right" : "bottom")) word = "100%";
    return shift(word, frame, axis);
  };
  const auto x = position(words[0], Axis::x), y = position(words[1], Axis::y);
  if (!x || !y) return std::nullopt;
  return Vec{frame.box.x + *x, frame.box.y + *y};
}

}  // namespace kerf::svg
#endif
