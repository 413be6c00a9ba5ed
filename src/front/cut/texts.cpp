// Texts of a job: their keys, and their outlines from the built-in fonts or a font file.
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/guess.h"
#include "base/names.h"
#include "base/number.h"
#include "base/utf8.h"
#include "codec/font/font_files.h"
#include "front/cut/shapes.h"
#include "geom/text/stroke_fonts.h"
#include "op/base/row_keys.h"

#include "kerf/base/limits.h"
#include "kerf/geom/fit.h"

namespace kerf {
namespace {

/// The outlines of one character of a font file, resolved to loops that do not overlap.
std::optional<TextGlyph> glyph_of(const FontGlyph& source, double height, const TextShape& shape,
                                  Diagnostics& diagnostics) {
  TextGlyph glyph{source.advance, {}};
  const FitOptions fit{shape.name, shape.options.where};
  const Length within = (1.0 / height) * default_tolerance::kCurveChord;
  std::vector<Outline> contours;
  for (const FontContour& contour : source.contours) {
    Outline outline{{contour.start.x, contour.start.y}, {}};
    const auto here = [&] { return outline.point(outline.segments.size()); };
    const auto line = [&](Point2 to) {
      if (distance(here(), to) > 0.0) outline.segments.push_back({to, {}});
    };
    for (const FontCurve& curve : contour.curves) {
      const Point2 to{curve.to.x, curve.to.y};
      std::vector<Point2> control{here()};
      for (const FontPoint& p : curve.control) control.push_back({p.x, p.y});
      control.push_back(to);
      const bool point = std::all_of(control.begin(), control.end(), [&](Point2 p) { return p == to; });
      if (point) continue;
      const auto arcs = curve.control.empty() ? std::nullopt : fit_bezier(control, within, fit, diagnostics);
      if (!curve.control.empty() && !arcs) return std::nullopt;
      if (!arcs) {
        line(to);
        continue;
      }
      for (const Segment& s : arcs->segments) outline.segments.push_back(s);
    }
    line(outline.start);
    if (outline.closed() && outline.segments.size() > 1) contours.push_back(std::move(outline));
  }
  if (contours.empty()) return glyph;
  RegionOptions options;
  options.name = shape.name, options.where = shape.options.where;
  auto region = make_region(contours, FillRule::nonzero, options, diagnostics);
  if (!region) return std::nullopt;
  glyph.paths = std::move(region->loops);
  return glyph;
}

}  // namespace

std::optional<TextFont> font_of_file(const TextShape& shape, std::string_view bytes,
                                     Diagnostics& diagnostics) {
  const double height = shape.options.height.mm();
  if (!(height > 0.0 && height <= limits::kMaxCoordinate)) return TextFont{};  // an error of set_text
  const auto file = read_font(bytes, shape.font, from_utf8(shape.text), diagnostics);
  if (!file) return std::nullopt;
  TextFont font;
  font.kerning = file->kerning;
  font.em = file->em, font.family = file->family, font.style = file->style;
  for (const auto& [code, source] : file->glyphs) {
    auto glyph = glyph_of(source, height, shape, diagnostics);
    if (!glyph) return std::nullopt;
    font.glyphs.emplace(code, std::move(*glyph));
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
                      "serif-italic, serif-bold-italic (single strokes), or an outline font file "
                      "(.ttf, .otf)",
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

std::optional<std::vector<ArtShape>> shapes_of_text(const TextShape& shape, std::string_view font,
                                                    Diagnostics& diagnostics) {
  const bool file = has_font_file(shape);
  const auto made = file ? font_of_file(shape, font, diagnostics) : stroke_text_font(shape.font);
  if (!made) {
    std::vector<std::string> names;
    for (const std::string_view name : stroke_font_names()) names.emplace_back(name);
    if (!file)
      diagnostics
          .error(codes::cut_job_key, shape.options.where,
                 fmt::format("{}: there is no font \"{}\"{}", shape.name, shape.font.substr(0, 60),
                             guess_at_end(shape.font, names)))
          .hint = "one of: " + joined(names, ", ") + "; or a font file (.ttf, .otf)";
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
