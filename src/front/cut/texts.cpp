// Texts of a job: their keys, and their outlines from the built-in fonts or a font file.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/utf8.h"
#include "codec/font/find_font.h"
#include "codec/font/font_files.h"
#include "front/cut/shapes.h"
#include "geom/text/stroke_fonts.h"
#include "op/base/row_keys.h"

#include "kerf/base/limits.h"
#include "kerf/geom/fit.h"

namespace kerf {

std::optional<TextFont> font_of_file(const TextShape& shape, std::string_view bytes, Diagnostics& diagnostics,
                                     int face) {
  const double height = shape.options.height.mm();
  if (!(height > 0.0 && height <= limits::kMaxCoordinate)) return TextFont{};  // an error of set_text
  const auto file = read_font(bytes, shape.font, from_utf8(shape.text), diagnostics, face);
  if (!file) return std::nullopt;
  TextFont font;
  font.kerning = file->kerning;
  font.em = file->em, font.family = file->family, font.style = file->style;
  for (const auto& [code, source] : file->glyphs) {
    const auto contours = mapped_contours(source.contours, [](double x, double y) { return Point2{x, y}; });
    const Length within = (1.0 / height) * default_tolerance::kCurveChord;
    auto loops = glyph_loops(contours, within, {shape.name, shape.options.where}, diagnostics);
    if (!loops) return std::nullopt;
    font.glyphs.emplace(code, TextGlyph{source.advance, std::move(*loops)});
  }
  return font;
}

const std::vector<CutTextKey>& cut_text_keys() {
  using op_detail::key_at;
  using Shape = TextShape;
  static const std::vector<CutTextKey> keys{
      key_at<Shape>(
          {.name = "text",
           .meaning = "a text to cut, instead of a drawing or with it",
           .example = "\"KERF\""},
          [](Shape & s) -> auto& { return s.text; }),
      key_at<Shape>(
          {.name = "height", .meaning = "height of the capital letters of a text", .example = "10"},
          [](Shape & s) -> auto& { return s.options.height; }),
      key_at<Shape>(
          {.name = "font",
           .meaning = "font of a text: sans, sans-2, script, script-2, serif, serif-bold, "
                      "serif-italic, serif-bold-italic (single strokes), an installed outline font "
                      "(\"DejaVu Sans:bold\"), or a font file (.ttf, .otf)",
           .example = "\"sans\""},
          [](Shape & s) -> auto& { return s.font; }),
      key_at<Shape>(
          {.name = "at",
           .meaning = "X,Y of the start, centre or end of a text's first baseline",
           .example = "[0, 0]"},
          [](Shape & s) -> auto& { return s.options.at; }),
      key_at<Shape>(
          {.name = "text-angle", .meaning = "direction of a text's baseline, from +X", .example = "0"},
          [](Shape & s) -> auto& { return s.options.angle; }),
      key_at<Shape>(
          {.name = "align", .meaning = "alignment of a text", .example = "\"left\""},
          [](Shape & s) -> auto& { return s.options.align; },
          op_detail::Names<TextAlign>{
              {"left", TextAlign::left}, {"centre", TextAlign::centre}, {"right", TextAlign::right}}),
      key_at<Shape>(
          {.name = "letter-spacing", .meaning = "added between the characters of a text", .example = "0"},
          [](Shape & s) -> auto& { return s.options.spacing; })};
  return keys;
}

bool has_font_file(const TextShape& shape) { return shape.font.find('.') != std::string::npos; }

std::optional<TextFontFile> font_file_of(const TextShape& shape, Diagnostics& diagnostics) {
  if (has_font_file(shape)) return TextFontFile{shape.font, 0};
  std::vector<std::string> names;
  for (const std::string_view name : stroke_font_names()) names.emplace_back(name);
  if (std::find(names.begin(), names.end(), shape.font) != names.end()) return TextFontFile{};
  const NamedFont named = find_named_font(shape.font);
  if (named.font) return TextFontFile{named.font->file, named.font->face};
  diagnostics
      .error(codes::cut_job_key, shape.options.where,
             fmt::format("{}: {}{}", shape.name, named.fault, guess_at_end(shape.font, names)))
      .hint = fmt::format(
      "one of: {}; an installed family with a style (\"DejaVu Sans:bold\"); or a font file "
      "(.ttf, .otf)",
      joined(names, ", "));
  return std::nullopt;
}

std::optional<std::vector<ArtShape>> shapes_of_text(const TextShape& shape, std::string_view font,
                                                    Diagnostics& diagnostics, int face) {
  const bool is_built_in = font.empty() && !has_font_file(shape);
  const auto made = is_built_in ? stroke_text_font(shape.font) : font_of_file(shape, font, diagnostics, face);
  if (!made) {
    if (is_built_in)
      diagnostics.error(
          codes::cut_job_key, shape.options.where,
          fmt::format("{}: there is no built-in font \"{}\"", shape.name, clipped(shape.font, 60)));
    return std::nullopt;
  }
  TextOptions options = shape.options;
  options.name = shape.name;
  auto paths = set_text(shape.text, *made, options, diagnostics);
  if (!paths) return std::nullopt;
  std::vector<ArtShape> shapes;
  for (Outline& path : *paths) shapes.push_back({shape.name, shape.layer, std::move(path), {}, {}});
  return shapes;
}

}  // namespace kerf
