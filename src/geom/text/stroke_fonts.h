// The built-in fonts of single strokes, from the Hershey data (data/fonts).
#pragma once

#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace kerf {

/// In units of 1/21 of a capital letter's height, from the left bearing and the baseline.
struct StrokePoint {
  std::int16_t x, y;
};
inline constexpr double kStrokeCapital = 21.0;
struct StrokeGlyph {
  int advance = 0;  ///< to the left bearing of the next character
  std::vector<std::vector<StrokePoint>> strokes;
};
using StrokeFont = std::unordered_map<char32_t, StrokeGlyph>;

/// By the number of the fonts in gcmc; nullptr if there is none. All fonts have a space.
const StrokeFont* stroke_font(std::int32_t number);
/// "sans", "sans-2", "script", "script-2", "serif", "serif-bold", "serif-italic", "serif-bold-italic".
const std::vector<std::string_view>& stroke_font_names();
/// By name; nullptr if there is none.
const StrokeFont* stroke_font(std::string_view name);

}  // namespace kerf
