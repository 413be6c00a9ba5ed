// Outline fonts (TrueType, OpenType, Type 1) as plain curves, read by FreeType.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kerf/base/diagnostics.h"

namespace kerf {

struct FontPoint {
  double x = 0.0, y = 0.0;
};
/// A line, or a Bézier curve with one or two control points, from the end of the one before.
struct FontCurve {
  std::vector<FontPoint> control;
  FontPoint to;
};
struct FontContour {
  FontPoint start;
  std::vector<FontCurve> curves;  ///< back to the start
};
struct FontGlyph {
  double advance = 0.0;
  std::vector<FontContour> contours;  ///< filled by the nonzero rule
};
/// In units of the height of a capital H.
struct FontFile {
  double em = 1.4;  ///< the size of an em, by which fonts are scaled
  std::map<char32_t, FontGlyph> glyphs;
  std::map<std::pair<char32_t, char32_t>, double> kerning;
  std::string family, style;  ///< as "DejaVu Sans" and "Bold"; may be empty
};

/// The characters of a text, and the kerning of neighbours in it; characters that the font does not have are
/// left out. `face` is the font's number in a file that has several. Nothing, with an error
/// (file_unreadable), for a file that is no outline font. The file is limited to 64 MB.
std::optional<FontFile> read_font(std::string_view bytes, const std::string& name,
                                  const std::u32string& characters, Diagnostics& diagnostics, int face = 0);

}  // namespace kerf
