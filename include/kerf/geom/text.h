// Text as outlines: characters of a font in a line, or in several.
//
//   const auto word = set_text("WORD", stroke_font_of("sans"), {.height = mm(10)}, diagnostics);
//
// Frame and units as in outline.h. Errors (cut_job_key) for sizes out of range, characters that the font does
// not have, and text without any stroke.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kerf/geom/fit.h"
#include "kerf/geom/outline.h"

namespace kerf {

/// A character; capital letters are 1 high, the baseline is y = 0.
struct TextGlyph {
  double advance = 0.0;
  std::vector<Outline> paths;  ///< open strokes, or closed outlines with the ink on the left
};
struct TextFont {
  std::map<char32_t, TextGlyph> glyphs;
  std::map<std::pair<char32_t, char32_t>, double> kerning;  ///< added to the advance of the first
  double em = 0.0;            ///< of a font file: the size of the font in heights of its capital letters
  std::string family, style;  ///< of a font file, as "DejaVu Sans" and "Bold"
};
/// A built-in font of single strokes (stroke_fonts.h); nothing if there is none of this name.
std::optional<TextFont> stroke_text_font(std::string_view name);

enum class TextAlign : std::uint8_t { left, centre, right };
struct TextOptions {
  Length height{};  ///< of capital letters, > 0
  Point2 at{};      ///< the left end, centre or right end of the first baseline
  Angle angle{};    ///< of the baseline, from +x
  TextAlign align = TextAlign::left;
  Length spacing{};         ///< added between characters
  double line_pitch = 1.6;  ///< distance of baselines as a multiple of the height
  std::string name{};       ///< in messages
  Origin where{};
};
/// The outlines of a UTF-8 text; a line feed starts the next line.
std::optional<std::vector<Outline>> set_text(std::string_view text, const TextFont& font,
                                             const TextOptions& options, Diagnostics& diagnostics);

/// A contour of a character: from its start lines (one point) or Bézier curves (controls and end) back to it.
struct GlyphContour {
  Point2 start;
  std::vector<std::vector<Point2>> curves;
};
/// Contours of any form with start, curves, their control points and ends, each point changed by `map(x, y)`.
template <class Contours, class Map>
std::vector<GlyphContour> mapped_contours(const Contours& contours, Map map) {
  std::vector<GlyphContour> made;
  for (const auto& contour : contours) {
    GlyphContour& one = made.emplace_back();
    one.start = map(contour.start.x, contour.start.y);
    for (const auto& curve : contour.curves) {
      std::vector<Point2>& points = one.curves.emplace_back();
      for (const auto& p : curve.control) points.push_back(map(p.x, p.y));
      points.push_back(map(curve.to.x, curve.to.y));
    }
  }
  return made;
}
/// The loops, which do not overlap, around the area that contours fill by the nonzero rule; curves deviate by
/// at most `within`. Empty where there is no area; nothing with an error.
std::optional<std::vector<Outline>> glyph_loops(const std::vector<GlyphContour>& contours, Length within,
                                                const FitOptions& fit, Diagnostics& diagnostics);

}  // namespace kerf
