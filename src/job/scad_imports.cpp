// Files of import(), dxf_dim() and dxf_cross(). Errors name the line of the program that reads them.
#include "job/scad_imports.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "base/utf8.h"
#include "codec/drawing/dxf_dimensions.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/drawing/drawing_outlines.h"
#include "kerf/drawing/svg.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/geom/text.h"
#include "kerf/program/cut_job.h"

namespace kerf {
namespace {

using scad::ImportedFile;
using scad::Measured;

/// Reads by `read`; its messages about the file have the line of the program as a note.
template <class Read>
auto noted(const ImportedFile& file, Diagnostics& diagnostics, Read read) {
  Diagnostics own;
  auto result = read(own);
  for (Diagnostic d : own.list()) {
    if (d.where != Origin(file.where)) d.notes.push_back({file.where, "imported here"});
    diagnostics.add(std::move(d));
  }
  return result;
}

std::optional<InputFile> open(const ImportedFile& file, std::size_t limit, Diagnostics& diagnostics) {
  Diagnostics own;
  auto opened = InputFile::open(file.path, own, limit);
  if (opened) return opened;
  const std::string why = own.list().empty() ? "" : ": " + own.list()[0].message;
  diagnostics.error(codes::scad_file, file.where, fmt::format("cannot open file {}{}", file.path, why));
  return std::nullopt;
}

/// As OpenSCAD, the numbers of a DXF drawing are mm, whatever unit it states.
std::optional<Length> unit_of(const dxf::Drawing& drawing, const ImportedFile& file,
                              Diagnostics& diagnostics) {
  if (drawing.format != dxf::Format::dxf) return std::nullopt;
  const double unit = dxf::mm_per_unit(drawing.unit.value_or(0)).value_or(1.0);
  if (unit != 1.0)
    diagnostics
        .warning(codes::scad_shape, file.where,
                 fmt::format("the unit of {} is {:g} mm; its numbers are read as mm, as OpenSCAD does",
                             file.path, unit))
        .hint = fmt::format("scale({:g}) import(...)", unit);
  return mm(1);
}

std::optional<DrawingOutlines> outlines_of(const ImportedFile& file, Diagnostics& diagnostics) {
  const auto input = open(file, limits::kMaxProgramBytes, diagnostics);
  if (!input) return std::nullopt;
  const std::size_t errors = diagnostics.errors();
  const auto drawing = read_drawing(input->bytes(), file.path, diagnostics);
  if (!drawing || diagnostics.errors() > errors) return std::nullopt;
  DrawingOutlineOptions options;
  options.texts = "none";  // as OpenSCAD does
  options.unit = unit_of(*drawing, file, diagnostics);
  if (!options.unit && !drawing->unit) options.unit = mm(25.4 / 96.0);  // an SVG in pixels
  if (!file.layer.empty()) options.layers = {file.layer};
  auto drawn = drawn_outlines(*drawing, options, diagnostics);
  if (diagnostics.errors() > errors) return std::nullopt;
  return drawn;
}

std::optional<Region> import_drawing(const ImportedFile& file, Diagnostics& diagnostics) {
  const auto drawn = outlines_of(file, diagnostics);
  if (!drawn) return std::nullopt;
  RegionOptions options;
  options.where = file.where;
  return drawn_region(*drawn, Combining::drawn, options, diagnostics);
}

std::optional<scad::SolidBody> import_mesh(const ImportedFile& file, Diagnostics& diagnostics) {
  const auto format = mesh_format_of(file.path);
  if (!format) {
    diagnostics
        .error(codes::scad_refused, file.where, fmt::format("unsupported file format of {}", file.path))
        .hint = "import() reads .dxf and .svg as areas; .stl, .3mf, .obj and .glb as solids";
    return std::nullopt;
  }
  const auto input = open(file, limits::kMaxProgramBytes, diagnostics);
  if (!input) return std::nullopt;
  auto mesh = read_mesh(input->bytes(), *format, file.path, diagnostics);
  if (!mesh) return std::nullopt;
  return scad::SolidBody{std::move(mesh->positions), std::move(mesh->triangles)};
}

std::string lowered(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

std::optional<scad::PlacedText> text_of_file(const scad::FileText& what, const std::string& file,
                                             Diagnostics& diagnostics) {
  const auto input = open({file, {}, what.where}, limits::kMaxToolLibraryBytes, diagnostics);
  if (!input) return std::nullopt;
  TextShape shape;
  shape.name = "text()";
  shape.text = what.text;
  shape.font = file;
  shape.options.height = mm(what.em);  // for the tolerance
  shape.options.where = what.where;
  shape.options.name = shape.name;
  auto font = font_of_file(shape, input->bytes(), diagnostics);
  if (!font) return std::nullopt;
  const auto differs = [](const std::string& wanted, const std::string& has) {
    return !wanted.empty() && lowered(wanted) != lowered(has);
  };
  if (differs(what.family, font->family) || differs(what.style, font->style)) return std::nullopt;
  shape.options.height = mm(what.em / font->em);
  scad::PlacedText placed;
  placed.file = file;
  const std::u32string characters = from_utf8(what.text);
  for (std::size_t i = 0; i < characters.size(); ++i) {
    const auto glyph = font->glyphs.find(characters[i]);
    if (glyph == font->glyphs.end()) continue;
    placed.width += glyph->second.advance * what.spacing;
    const auto kern = i + 1 < characters.size() ? font->kerning.find({characters[i], characters[i + 1]})
                                                : font->kerning.end();
    if (kern != font->kerning.end()) placed.width += kern->second;
  }
  placed.width *= shape.options.height.mm();
  for (auto& [code, glyph] : font->glyphs) glyph.advance *= what.spacing;
  const auto outlines = set_text(what.text, *font, shape.options, diagnostics);
  if (!outlines) return std::nullopt;
  RegionOptions options;
  options.where = what.where;
  auto region = make_region(*outlines, FillRule::nonzero, options, diagnostics);
  if (!region) return std::nullopt;
  placed.region = std::move(*region);
  return placed;
}

std::optional<scad::PlacedText> import_text(const scad::FileText& what, Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  for (const std::string& file : what.files) {
    auto placed = text_of_file(what, file, diagnostics);
    if (placed || diagnostics.errors() > errors) return placed;
  }
  return std::nullopt;
}

std::optional<double> measure_dimension(const Measured& what, Diagnostics& diagnostics) {
  const auto input = open(what.file, limits::kMaxProgramBytes, diagnostics);
  if (!input) return std::nullopt;
  for (const dxf::Dimension& d : dxf::read_dimensions(input->bytes(), what.file.path, diagnostics))
    if ((what.name.empty() || d.text == what.name) &&
        (what.file.layer.empty() || d.layer == what.file.layer)) {
      const bool is_x = (d.type & 64) != 0, is_ordinate = (d.type & 7) == 6, is_angle = (d.type & 7) % 3 == 2;
      const double from = !is_ordinate ? 0.0 : is_x ? what.origin.x : what.origin.y;
      return is_angle ? dxf::measured(d) : (dxf::measured(d) - from) * what.scale;
    }
  diagnostics.warning(codes::scad_file, what.file.where,
                      fmt::format("cannot find dimension \"{}\" in {}, layer \"{}\"", what.name,
                                  what.file.path, what.file.layer));
  return std::nullopt;
}

/// Where the first two open outlines of one line each cross, or would if they were longer.
std::optional<Point2> measure_crossing(const Measured& what, Diagnostics& diagnostics) {
  const auto drawn = outlines_of(what.file, diagnostics);
  if (!drawn) return std::nullopt;
  std::vector<std::pair<Point2, Point2>> lines;
  for (const DrawnOutline& o : drawn->outlines)
    if (o.outline.segments.size() == 1 && !o.outline.segments[0].via && !o.circle)
      lines.emplace_back(o.outline.start, o.outline.segments[0].to - o.outline.start);
  if (lines.size() >= 2)
    if (const double size = cross(lines[0].second, lines[1].second); size != 0.0) {
      const double t = cross(lines[1].first - lines[0].first, lines[1].second) / size;
      return what.scale * (lines[0].first + t * lines[0].second - what.origin);
    }
  diagnostics.warning(
      codes::scad_file, what.file.where,
      fmt::format("cannot find a cross in {}, layer \"{}\"", what.file.path, what.file.layer));
  return std::nullopt;
}

}  // namespace

scad::Imports scad_imports() {
  scad::Imports imports;
  imports.drawing = [](const ImportedFile& file, Diagnostics& diagnostics) {
    return noted(file, diagnostics, [&](Diagnostics& own) { return import_drawing(file, own); });
  };
  imports.mesh = [](const ImportedFile& file, Diagnostics& diagnostics) {
    return noted(file, diagnostics, [&](Diagnostics& own) { return import_mesh(file, own); });
  };
  imports.dimension = [](const Measured& what, Diagnostics& diagnostics) {
    return noted(what.file, diagnostics, [&](Diagnostics& own) { return measure_dimension(what, own); });
  };
  imports.crossing = [](const Measured& what, Diagnostics& diagnostics) {
    return noted(what.file, diagnostics, [&](Diagnostics& own) { return measure_crossing(what, own); });
  };
  imports.text = [](const scad::FileText& what, Diagnostics& diagnostics) {
    return noted({{}, {}, what.where}, diagnostics, [&](Diagnostics& own) { return import_text(what, own); });
  };
  return imports;
}

}  // namespace kerf
