// Outlines of characters by FreeType, unscaled and without hints.
#include <cmath>
#include <fmt/format.h>

#include "base/codes/files.h"
#include "codec/font/font_files.h"
#include "codec/font/kerning.h"

#include "kerf/base/limits.h"

#if defined(KERF_WITH_FREETYPE)
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include FT_TRUETYPE_TABLES_H
#endif

namespace kerf {

#if defined(KERF_WITH_FREETYPE)
namespace {

constexpr std::size_t kMaxCurves = 100'000;  // of one character

/// A library and a face, released together.
struct Face {
  ~Face() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }
  FT_Library library = nullptr;
  FT_Face face = nullptr;
};

FontPoint point(const FT_Vector& v) { return {static_cast<double>(v.x), static_cast<double>(v.y)}; }

/// Collects the curves of a character; functions return 0 to continue.
struct Collector {
  FontGlyph glyph;
  std::size_t curves = 0;

  static int move(const FT_Vector* to, void* user) {
    static_cast<Collector*>(user)->glyph.contours.push_back({point(*to), {}});
    return 0;
  }
  static int line(const FT_Vector* to, void* user) {
    return static_cast<Collector*>(user)->add({{}, point(*to)});
  }
  static int conic(const FT_Vector* control, const FT_Vector* to, void* user) {
    return static_cast<Collector*>(user)->add({{point(*control)}, point(*to)});
  }
  static int cubic(const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, void* user) {
    return static_cast<Collector*>(user)->add({{point(*first), point(*second)}, point(*to)});
  }
  int add(FontCurve curve) {
    if (glyph.contours.empty() || ++curves > kMaxCurves) return 1;
    glyph.contours.back().curves.push_back(std::move(curve));
    return 0;
  }
};

std::optional<FontGlyph> read_glyph(FT_Face face, char32_t character) {
  const FT_UInt index = FT_Get_Char_Index(face, character);
  if (index == 0 ||
      FT_Load_Glyph(face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0)
    return std::nullopt;
  if (face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) return std::nullopt;
  Collector collector;
  FT_Outline_Funcs functions{};
  functions.move_to = Collector::move, functions.line_to = Collector::line;
  functions.conic_to = Collector::conic, functions.cubic_to = Collector::cubic;
  if (FT_Outline_Decompose(&face->glyph->outline, &functions, &collector) != 0) return std::nullopt;
  collector.glyph.advance = static_cast<double>(face->glyph->metrics.horiAdvance);
  return std::move(collector.glyph);
}

double highest(const FontGlyph& glyph) {
  double high = 0.0;
  for (const FontContour& c : glyph.contours)
    for (const FontCurve& curve : c.curves) high = std::max(high, curve.to.y);
  return high;
}

void scale(FontGlyph& glyph, double factor) {
  const auto scaled = [&](FontPoint& p) { p.x *= factor, p.y *= factor; };
  glyph.advance *= factor;
  for (FontContour& contour : glyph.contours) {
    scaled(contour.start);
    for (FontCurve& curve : contour.curves) {
      for (FontPoint& p : curve.control) scaled(p);
      scaled(curve.to);
    }
  }
}

/// The bytes of the table GPOS; empty if there is none.
std::string positions_table(FT_Face face) {
  const FT_ULong tag = FT_MAKE_TAG('G', 'P', 'O', 'S');
  FT_ULong size = 0;
  if (FT_Load_Sfnt_Table(face, tag, 0, nullptr, &size) != 0 || size > limits::kMaxToolLibraryBytes) return {};
  std::string table(size, '\0');
  if (FT_Load_Sfnt_Table(face, tag, 0, reinterpret_cast<FT_Byte*>(table.data()), &size) != 0) return {};
  return table;
}

void add_kerning(FT_Face face, const std::u32string& characters, double height, FontFile& font) {
  const PairKerning pairs(positions_table(face));
  for (std::size_t i = 0; i + 1 < characters.size(); ++i) {
    const std::pair key{characters[i], characters[i + 1]};
    if (font.kerning.contains(key)) continue;
    const FT_UInt first = FT_Get_Char_Index(face, key.first), second = FT_Get_Char_Index(face, key.second);
    double units = 0.0;
    if (FT_Vector kern{}; pairs.exists())
      units = pairs.between(static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(second));
    else if (FT_Get_Kerning(face, first, second, FT_KERNING_UNSCALED, &kern) == 0)
      units = static_cast<double>(kern.x);
    font.kerning[key] = units / height;
  }
}

}  // namespace

std::optional<FontFile> read_font(std::string_view bytes, const std::string& name,
                                  const std::u32string& characters, Diagnostics& diagnostics, int face) {
  Face font;
  const auto fail = [&](const std::string& why) {
    diagnostics.error(codes::file_unreadable, TextLocation{name, 0, 0}, why).hint =
        "a TrueType or OpenType font, such as a .ttf or .otf file";
    return std::nullopt;
  };
  if (bytes.size() > limits::kMaxToolLibraryBytes) return fail("a font is limited to 64 MB");
  if (FT_Init_FreeType(&font.library) != 0) return fail("FreeType cannot be started");
  if (FT_New_Memory_Face(font.library, reinterpret_cast<const FT_Byte*>(bytes.data()),
                         static_cast<FT_Long>(bytes.size()), face, &font.face) != 0)
    return fail("the file is not a font");
  if ((font.face->face_flags & FT_FACE_FLAG_SCALABLE) == 0) return fail("the font has no outlines");
  const auto capital = read_glyph(font.face, U'H');
  const double height = capital ? highest(*capital) : 0.7 * font.face->units_per_EM;
  if (!(height > 0.0)) return fail("the font has no height");
  FontFile made;
  made.em = font.face->units_per_EM / height;
  if (font.face->family_name != nullptr) made.family = font.face->family_name;
  if (font.face->style_name != nullptr) made.style = font.face->style_name;
  for (const char32_t character : characters) {
    if (made.glyphs.contains(character)) continue;
    auto glyph = read_glyph(font.face, character);
    if (!glyph) continue;
    scale(*glyph, 1.0 / height);
    made.glyphs.emplace(character, std::move(*glyph));
  }
  add_kerning(font.face, characters, height, made);
  return made;
}

#else

std::optional<FontFile> read_font(std::string_view, const std::string& name, const std::u32string&,
                                  Diagnostics& diagnostics, int) {
  diagnostics.error(codes::file_unreadable, TextLocation{name, 0, 0}, "this build reads no font files");
  return std::nullopt;
}

#endif

}  // namespace kerf
