// The modules of OpenSCAD that make or change areas.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/scad.h"
#include "front/scad/run/degrees.h"
#include "front/scad/run/module_call.h"
#include "geom/offset/hull.h"

#include "kerf/base/limits.h"
#include "kerf/geom/offset.h"
#include "kerf/geom/text.h"

namespace kerf::scad {

void circle(ModuleCall& call) {
  const Arguments a(call);
  const double r = radius_of(a, 1.0);
  if (!not_positive(call, r, "the radius")) give(call, area_shape(circle_region(call, r)));
}

void square(ModuleCall& call) {
  const Arguments a(call);
  const Point3 size = a.vector("size", {1, 1, 1}, {2, 2});
  if (not_positive(call, size.x, "the width") || not_positive(call, size.y, "the height")) return;
  const Point2 low = a.flag("center") ? Point2{-0.5 * size.x, -0.5 * size.y} : Point2{};
  give(call, area_shape(rectangle(low, low + Point2{size.x, size.y})));
}

void polygon(ModuleCall& call) {
  const Arguments a(call);
  std::vector<Point2> points;
  bool valid = a["points"].is(Type::vector);
  if (valid)
    for (const Value& p : a["points"].items()) {
      valid = valid && p.is(Type::vector) && p.items().size() >= 2 && p.items()[0].is_number() &&
              p.items()[1].is_number() && std::fabs(p.items()[0].number()) <= limits::kMaxCoordinate &&
              std::fabs(p.items()[1].number()) <= limits::kMaxCoordinate;
      if (valid) points.push_back({p.items()[0].number(), p.items()[1].number()});
    }
  if (!valid) {
    a.wrong("points", "a vector of points of 2 finite numbers");
    return;
  }
  std::vector<std::vector<Point2>> paths;
  const auto add_path = [&](const Value& path) {
    paths.emplace_back();
    for (const Value& i : path.items()) {
      if (i.is_number() && i.number() >= 0.0 && i.number() < static_cast<double>(points.size()))
        paths.back().push_back(points[static_cast<std::size_t>(i.number())]);
      else
        valid = false;
    }
  };
  if (!a.given("paths")) {
    paths.push_back(points);
  } else if (a["paths"].is(Type::vector) && !a["paths"].items().empty() &&
             a["paths"].items()[0].is(Type::vector)) {
    for (const Value& path : a["paths"].items())
      if (path.is(Type::vector)) add_path(path);
  } else if (a["paths"].is(Type::vector)) {
    add_path(a["paths"]);
  }
  if (valid)
    give(call, polygons(call.run, paths, call.statement.at));
  else
    a.wrong("paths", "vectors of indices of points");
}

void offset_module(ModuleCall& call) {
  const Arguments a(call);
  Shape s = children_of(call);
  if (s.kind == Shape::Kind::nothing) return;
  if (s.kind != Shape::Kind::area) {
    refuse(call, "offset() of a solid", "offset the area before linear_extrude()");
    return;
  }
  const bool is_round = a.given("r") || !a.given("delta");
  const double by = is_round ? a.number("r", 1.0) : a.number("delta", 1.0);
  if (by == 0.0) {
    give(call, std::move(s));
    return;
  }
  JoinOptions joins;
  if (!is_round) {
    joins.join = Join::mitre;
    joins.mitre_limit = a.flag("chamfer") ? 1.0 : 1e3;
  }
  auto result =
      offset(s.region, mm(by), joins, region_options(call.run, call.statement.at), call.run.diagnostics());
  if (!result) throw Stop{};
  give(call, area_shape(std::move(result->region)));
}

// --------------------------------------------------------------------------------- hulls, sums, text, files

namespace {

Region checked(std::optional<Region> region) {
  if (!region) throw Stop{};  // reported
  return std::move(*region);
}

/// Whether shapes are all areas, or all prisms: solids of one slab.
bool are_all(const Shapes& shapes, Shape::Kind kind) {
  return std::all_of(shapes.begin(), shapes.end(), [&](const Shape& s) {
    return s.kind == kind && (kind == Shape::Kind::area || (s.slabs.size() == 1 && s.bodies.empty()));
  });
}

const Region& region_of(const Shape& s) { return s.kind == Shape::Kind::area ? s.region : s.slabs[0].region; }

}  // namespace

void hull_module(ModuleCall& call) {
  const Shapes all = separate_children(call);
  std::vector<Region> regions;
  const auto hull = [&] {
    return checked(convex_hull(regions, region_options(call.run, call.statement.at), call.run.diagnostics()));
  };
  if (all.empty()) return;
  const bool are_areas = are_all(all, Shape::Kind::area), are_prisms = are_all(all, Shape::Kind::solid);
  const auto same_heights = [&](const Shape& s) {
    return s.slabs[0].low == all[0].slabs[0].low && s.slabs[0].high == all[0].slabs[0].high;
  };
  if (!are_areas && !(are_prisms && std::all_of(all.begin(), all.end(), same_heights))) {
    refuse(call, "hull() of these solids has sides that are not vertical",
           "possible are hulls of areas, and of linear_extrude(), cube() and cylinder() between the same "
           "heights");
    return;
  }
  for (const Shape& s : all) regions.push_back(region_of(s));
  give(call, are_areas ? area_shape(hull()) : extruded(hull(), all[0].slabs[0].low, all[0].slabs[0].high));
}

void minkowski_module(ModuleCall& call) {
  const Shapes all = separate_children(call);
  if (all.empty()) return;
  const bool are_areas = are_all(all, Shape::Kind::area);
  if (!are_areas && !are_all(all, Shape::Kind::solid)) {
    refuse(call, "minkowski() of these solids has sides that are not vertical",
           "possible are sums of areas, and of cube(), cylinder() and linear_extrude()");
    return;
  }
  Region sum = region_of(all[0]);
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!are_areas) low += all[i].slabs[0].low, high += all[i].slabs[0].high;
    if (i > 0)
      sum = checked(minkowski_sum(sum, region_of(all[i]), Tolerance{}.chord,
                                  region_options(call.run, call.statement.at), call.run.diagnostics()));
  }
  give(call, are_areas ? area_shape(std::move(sum)) : extruded(std::move(sum), low, high));
}

namespace {

/// The built-in font whose style is nearest to that of a font's name, and the width of its pen as a fraction
/// of the size.
struct Pen {
  const char* font;
  double width;
};
Pen pen_of(std::string name) {
  for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  const bool bold = has("bold"), italic = has("italic") || has("oblique");
  const bool serif = has("serif") && !has("sans");
  const double width = bold ? 0.19 : 0.125;
  if (serif) return {italic ? "serif-italic" : "serif", width};
  return {has("script") ? "script" : "sans", width};
}

/// How far text is moved so that its edge or centre is at 0; nothing for another word.
std::optional<double> aligned(const std::string& word, const char* low, const char* high, double from,
                              double to) {
  if (word == "center") return -0.5 * (from + to);
  if (word == high) return -to;
  if (word == low) return -from;
  return std::nullopt;
}

bool has_ending(const std::string& name, const std::string& ending) {
  return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

/// The text in a font file: the one that `font` names, or one of those that the program uses with the family
/// and style "FAMILY:style=STYLE". Nothing if there is none.
std::optional<PlacedText> file_text(ModuleCall& call, const std::string& text, const std::string& font,
                                    double size, double spacing) {
  ImportedFiles& files = call.run.files();
  FileText what;
  if (has_ending(font, ".ttf") || has_ending(font, ".otf")) {
    what.files.push_back(files.path_beside(font, call.statement.at));
  } else if (!font.empty()) {
    constexpr std::string_view kStyle = "style=";
    const std::size_t colon = font.find(':');
    what.family = font.substr(0, colon);
    if (const std::size_t style = font.find(kStyle); style != std::string::npos)
      what.style = font.substr(style + kStyle.size());
    what.files = files.fonts;
  }
  if (what.files.empty() || files.imports == nullptr) return std::nullopt;
  constexpr double kEm = 100.0 / 72.0;  // OpenSCAD's size is about that of capitals
  what.text = text;
  what.em = size * kEm;
  what.spacing = spacing;
  what.where = call.run.locate(call.statement.at);
  const std::size_t errors = call.run.diagnostics().errors();
  auto placed = files.imports->text(what, call.run.diagnostics());
  if (placed) files.paths.push_back(placed->file);
  if (call.run.diagnostics().errors() > errors) return PlacedText{};
  return placed;
}

/// The strokes of a text with a pen of `pen` mm; capitals are `size` high with it.
Region text_region(ModuleCall& call, const std::string& text, const TextFont& font, double size, double pen) {
  TextOptions options;
  options.height = mm(size - pen);
  options.at = {0.5 * pen, 0.5 * pen};
  options.name = "text()";
  options.where = call.run.locate(call.statement.at);
  const auto strokes = set_text(text, font, options, call.run.diagnostics());
  if (!strokes) return {};  // reported
  std::vector<Region> parts;
  for (const Outline& stroke : *strokes)
    parts.push_back(checked(buffer(stroke, mm(0.5 * pen), PathEnds::round,
                                   region_options(call.run, call.statement.at), call.run.diagnostics())));
  return checked(unite(parts, region_options(call.run, call.statement.at), call.run.diagnostics()));
}

Region stroke_text(ModuleCall& call, const std::string& text, const Arguments& a, double size,
                   double spacing) {
  const Pen pen = pen_of(a.text("font"));
  auto font = stroke_text_font(pen.font);
  for (auto& [code, glyph] : font->glyphs) glyph.advance *= spacing;
  return text_region(call, text, *font, size, size * pen.width);
}

}  // namespace

void text_module(ModuleCall& call) {
  const Arguments a(call);
  const std::string text = a["text"].is_undef() ? std::string() : as_text(a["text"]);
  const double size = a.number("size", 10.0), spacing = a.number("spacing", 1.0);
  if (not_positive(call, size, "the size")) return;
  if (const std::string direction = a.text("direction"); !direction.empty() && direction != "ltr") {
    refuse(call, "text() with a direction other than \"ltr\"", "turn the text with rotate()");
    return;
  }
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    give(call, area_shape({}));
    return;
  }
  const auto placed_text = file_text(call, text, a.text("font"), size, spacing);
  const Region region = placed_text ? placed_text->region : stroke_text(call, text, a, size, spacing);
  Box2 box = bounds(region);
  if (placed_text) box.low.x = 0.0, box.high.x = placed_text->width;  // as OpenSCAD
  const std::string across = a.given("halign") ? a.text("halign") : "left";
  const std::string up = a.given("valign") ? a.text("valign") : "baseline";
  const auto x = across == "left" ? std::optional(0.0) : aligned(across, "", "right", box.low.x, box.high.x);
  const auto y = up == "baseline" ? std::optional(0.0) : aligned(up, "bottom", "top", box.low.y, box.high.y);
  if (!x) a.wrong("halign", "\"left\", \"center\" or \"right\"");
  if (!y) a.wrong("valign", "\"baseline\", \"bottom\", \"center\" or \"top\"");
  give(call, area_shape(placed(region, Placement{{x.value_or(0.0), y.value_or(0.0)}, {1.0, 1.0}})));
}

void import_module(ModuleCall& call) {
  const Arguments a(call);
  const std::string name = a.text("file");
  if (name.empty()) {
    call.run.warn(codes::scad_shape, call.statement.at, "import() has no file name; nothing is imported");
    return;
  }
  const ImportedFile file{call.run.files().path_beside(name, call.statement.at), a.text("layer"),
                          call.run.locate(call.statement.at)};
  const std::size_t dot = name.rfind('.');
  const std::string ending = dot == std::string::npos ? "" : name.substr(dot);
  const bool is_drawing = ending == ".dxf" || ending == ".svg" || ending == ".DXF" || ending == ".SVG";
  const Imports* imports = call.run.files().imports;
  if (imports == nullptr) {
    refuse(call, "import() is not available here", "");
    return;
  }
  Shape shape;
  if (is_drawing) {
    const auto region = imports->drawing(file, call.run.diagnostics());
    if (!region) return;
    shape = area_shape(*region);
  } else {
    auto body = imports->mesh(file, call.run.diagnostics());
    if (!body) return;
    shape = body_shape(std::move(*body));
  }
  call.run.files().paths.push_back(file.path);
  const Point3 origin = a.vector("origin", {});
  const double by = a.number("scale", 1.0);
  const Box3 box = bounds_of(shape);
  const Point3 from = a.flag("center") ? 0.5 * (box.low + box.high) : origin;
  Matrix m = identity();
  for (std::size_t i = 0; i < 3; ++i) {
    m[i][i] = by;
    m[i][3] = is_drawing && i == 2 ? 0.0 : -by * from[static_cast<int>(i)];
  }
  give(call, transformed(call.run, std::move(shape), m, call.statement.at));
}

}  // namespace kerf::scad
