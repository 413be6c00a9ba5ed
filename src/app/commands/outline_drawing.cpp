// kerf outline for DXF drawings: outlines, and the region that they bound, from layers.
#include "app/commands/outline_drawing.h"

#include <algorithm>
#include <fmt/format.h>

#include "app/options/common.h"
#include "app/options/output_options.h"
#include "app/report/sent_files.h"
#include "back/drawing/outline_drawing.h"
#include "base/codes/files.h"
#include "base/file_names.h"
#include "base/names.h"
#include "base/number.h"
#include "job/record/record.h"

#include "kerf/base/files.h"
#include "kerf/drawing/drawing_files.h"
#include "kerf/drawing/drawing_outlines.h"
#include "kerf/drawing/svg.h"

namespace kerf::app {
namespace {

const char* const kNames[] = {"--layer",  "--unit",    "--tolerance", "--join",
                              "--region", "--combine", "--strokes",   "--list-layers"};

/// The results of a run; members are empty after an error.
struct Result {
  std::optional<dxf::Drawing> drawing;
  std::optional<DrawingOutlines> drawn;
  std::optional<Region> region;
  std::vector<LayerContent> layers;
  std::vector<std::string> outputs;
};

void add_segments(Record& out, const Outline& outline) {
  out["closed"] = outline.closed();
  out["first"] = Record{{"at", record_of(outline.start)}};
  Record& segments = out["segments"] = Record::array();
  for (const Segment& s : outline.segments) {
    Record segment{{"to", record_of(s.to)}};
    if (s.via) segment["via"] = record_of(*s.via);
    segments.push_back(std::move(segment));
  }
}

Record outline_record(const DrawnOutline& drawn) {
  Record out{{"name", drawn.name}, {"layer", drawn.layer}};
  add_segments(out, drawn.outline);
  if (drawn.circle)
    out["circle"] =
        Record{{"at", record_of(drawn.circle->centre)}, {"radius", record_of(drawn.circle->radius.mm())}};
  out["length_mm"] = record_of(length(drawn.outline).mm());
  out["handles"] = drawn.handles;
  return out;
}

Record region_record(const Region& region) {
  Record loops = Record::array();
  for (const Outline& loop : region.loops) {
    Record out;
    add_segments(out, loop);
    loops.push_back(std::move(out));
  }
  return {{"area_mm2", record_of(area(region))},
          {"length_mm", record_of(length(region).mm())},
          {"outlines", loops}};
}

Record layers_record(const std::vector<LayerContent>& layers) {
  Record list = Record::array();
  for (const LayerContent& layer : layers) {
    Record types = Record::object();
    for (const auto& [type, count] : layer.types) types[type] = count;
    list.push_back(Record{{"name", layer.name},
                          {"off", layer.off},
                          {"frozen", layer.frozen},
                          {"colour", layer.colour},
                          {"linetype", layer.linetype},
                          {"entities", layer.entities},
                          {"types", types}});
  }
  return list;
}

void add_drawn(Record& out, const DrawingOutlines& drawn) {
  Record& outlines = out["outlines"] = Record::array();
  for (const DrawnOutline& outline : drawn.outlines) outlines.push_back(outline_record(outline));
  Record& points = out["points"] = Record::array();
  for (const DrawnPoint& p : drawn.points)
    points.push_back(Record{{"at", record_of(p.at)}, {"layer", p.layer}, {"handle", p.handle}});
  Record& ends = out["open_ends"] = Record::array();
  for (const DrawnOpenEnd& end : drawn.open_ends) {
    Record open{{"at", record_of(end.at)}, {"layer", end.layer}, {"entity", end.entity}};
    open["nearest"] = end.nearest ? record_of(*end.nearest) : Record();
    open["distance_mm"] = end.nearest ? record_of(end.distance.mm()) : Record();
    ends.push_back(std::move(open));
  }
  Record& junctions = out["junctions"] = Record::array();
  for (const DrawnJunction& junction : drawn.junctions)
    junctions.push_back(
        Record{{"at", record_of(junction.at)}, {"layer", junction.layer}, {"entities", junction.entities}});
}

Record result_record(const std::string& file, const DrawingOptions& options, const Result& result,
                     const Diagnostics& diagnostics) {
  Record out{{"source", file}, {"unit", "mm"}};
  if (result.drawing) {
    Record& drawing = out["drawing"] = Record::object();
    drawing["version"] = result.drawing->version;
    drawing["insunits"] = result.drawing->unit ? Record(*result.drawing->unit) : Record();
    if (result.drawn) drawing["unit_mm"] = record_of(result.drawn->unit.mm());
  }
  if (options.list_layers) out["layers"] = layers_record(result.layers);
  if (result.drawn) add_drawn(out, *result.drawn);
  if (result.region) out["region"] = region_record(*result.region);
  out["outputs"] = result.outputs;
  out["diagnostics"] = record_of(diagnostics);
  return out;
}

std::string size_text(const Outline& outline) {
  const Box2 box = bounds(outline);
  return fmt::format("{} x {} mm", number_text(box.high.x - box.low.x, 3),
                     number_text(box.high.y - box.low.y, 3));
}

void print_layers(Console& console, const std::vector<LayerContent>& layers) {
  std::size_t widest = 5;
  for (const LayerContent& layer : layers) widest = std::max(widest, layer.name.size());
  console.summary(fmt::format("{:<{}}  {:<7} {:>6}  {:<12} {}", "layer", widest, "state", "colour",
                              "line type", "entities"));
  for (const LayerContent& layer : layers) {
    std::vector<std::string> types;
    for (const auto& [type, count] : layer.types) types.push_back(fmt::format("{} {}", count, type));
    console.summary(fmt::format("{:<{}}  {:<7} {:>6}  {:<12} {}", layer.name, widest,
                                layer.frozen ? "frozen"
                                : layer.off  ? "off"
                                             : "on",
                                layer.colour, layer.linetype, types.empty() ? "-" : joined(types, ", ")));
  }
}

void print_summary(Console& console, const Result& result) {
  for (const DrawnOutline& o : result.drawn->outlines)
    console.summary(fmt::format("{}: {}, {} segments, {}", o.name,
                                o.circle             ? "circle"
                                : o.outline.closed() ? "closed"
                                                     : "open",
                                o.outline.segments.size(), size_text(o.outline)));
  if (!result.drawn->points.empty()) console.summary(fmt::format("{} points", result.drawn->points.size()));
  if (result.region)
    console.summary(fmt::format("region: {} outlines, area {} mm2", result.region->loops.size(),
                                number_text(area(*result.region), 3)));
}

/// The outlines by layer, and a circle around each open end and junction.
Drawing picture(const Result& result, const std::string& title) {
  Drawing drawing;
  drawing.title = title;
  drawing.layers.clear();
  const auto layer_of = [&](const std::string& name, int colour) {
    for (std::size_t i = 0; i < drawing.layers.size(); ++i)
      if (drawing.layers[i].name == name) return i;
    drawing.layers.push_back({name, colour, colour_of_index(colour)});
    return drawing.layers.size() - 1;
  };
  const auto colour_of = [&](const std::string& layer) {
    const auto index = dxf::find_layer(*result.drawing, layer);
    return index ? result.drawing->layers[*index].colour : 7;
  };
  if (result.region) {
    for (const Outline& loop : result.region->loops)
      draw(drawing, layer_of("region", 7), loop, OutlineEntities::polyline);
    return drawing;
  }
  for (const DrawnOutline& o : result.drawn->outlines) {
    const std::size_t layer = layer_of(o.layer, colour_of(o.layer));
    if (o.circle)
      draw(drawing, layer, *o.circle);
    else
      draw(drawing, layer, o.outline, OutlineEntities::polyline);
  }
  return drawing;
}

void mark_faults(Drawing& drawing, const DrawingOutlines& drawn) {
  if (drawn.open_ends.empty() && drawn.junctions.empty()) return;
  constexpr double kMark = 0.01;  // of the drawing's size
  constexpr int kRed = 1;
  const std::array<double, 4> box = drawing_bounds(drawing);
  const Length radius = mm(kMark * std::max({box[2] - box[0], box[3] - box[1], 1.0}));
  drawing.layers.push_back({"faults", kRed, colour_of_index(kRed)});
  const std::size_t layer = drawing.layers.size() - 1;
  for (const DrawnOpenEnd& end : drawn.open_ends) draw(drawing, layer, Circle{end.at, radius});
  for (const DrawnJunction& junction : drawn.junctions) draw(drawing, layer, Circle{junction.at, radius});
}

void write_files(Console& console, Result& result, const std::string& file, const std::string& svg,
                 const std::string& dxf, Diagnostics& diagnostics) {
  SentFiles set(console, {file});
  Drawing drawing = picture(result, file_name_of(file));
  bool written = true;
  if (!dxf.empty()) written = set.write(dxf, write_dxf(drawing), diagnostics);
  if (written && !svg.empty()) {
    mark_faults(drawing, *result.drawn);
    written = set.write(svg, write_svg(drawing), diagnostics);
  }
  if (!written || !set.commit(diagnostics)) return;
  for (const std::string& path : {svg, dxf})
    if (!path.empty()) result.outputs.push_back(path);
}

void compute(Result& result, const std::string& file, const DrawingOptions& options,
             Diagnostics& diagnostics) {
  const auto input = InputFile::open(file, diagnostics);
  if (!input) return;
  result.drawing = read_drawing(input->bytes(), file, diagnostics);
  if (!result.drawing) return;
  if (options.list_layers) {
    result.layers = layer_contents(*result.drawing, {}, diagnostics);
    return;
  }
  DrawingOutlineOptions how;
  how.layers = options.layers;
  if (options.mm_per_unit > 0.0) how.unit = mm(options.mm_per_unit);
  how.within = mm(options.within);
  how.join = mm(options.join);
  how.strokes = options.strokes;
  result.drawn = drawn_outlines(*result.drawing, how, diagnostics);
  if (!result.drawn || !options.region) return;
  RegionOptions region;
  region.name = file;
  result.region = drawn_region(*result.drawn, options.combining, region, diagnostics);
}

}  // namespace

bool is_drawing(const std::string& file) {
  const std::string extension = fold_name(extension_of(file));
  return extension == ".dxf" || extension == ".svg";
}

void add_drawing_options(CommandParser& parser, DrawingOptions& options) {
  add_repeated(parser, "--layer", options.layers, "NAME", "Only this layer of a drawing; may be repeated");
  parser
      .add_parsed(
          "--unit",
          [&options](const std::string& text) -> std::string {
            const auto unit = drawing_unit(text);
            if (!unit) return "expected mm, inch, px or pt";
            options.mm_per_unit = unit->mm();
            return {};
          },
          "Unit of a drawing, mm, inch, px (1/96 inch) or pt (1/72 inch); overrides its own")
      .value_name("UNIT");
  add_length(parser, "--tolerance", options.within, 1e-6, 10.0,
             "Maximum deviation of arcs from a drawing's ellipses and splines (default: 0.01)");
  add_length(parser, "--join", options.join, 1e-6, 10.0,
             "Maximum gap between entities of a drawing that are joined (default: 0.01)");
  parser.add_flag("--region", options.region,
                  "Unite the outlines of a drawing to a region, outlines inside as holes");
  parser
      .add_parsed(
          "--combine",
          [&options](const std::string& text) -> std::string {
            const auto combining = combining_of(text);
            if (!combining) return "expected drawn, nested or united";
            options.combining = *combining;
            return {};
          },
          "Overlapping shapes of a region: as the drawing fills them (drawn), those inside others as holes "
          "(nested), "
          "or all united")
      .value_name("HOW");
  parser
      .add_parsed(
          "--strokes",
          [&options](const std::string& text) -> std::string {
            const auto strokes = stroke_shapes_of(text);
            if (!strokes) return "expected lines or areas";
            options.strokes = *strokes;
            return {};
          },
          "Strokes and wide polylines of a drawing: their centre lines (lines, default), or the areas that "
          "they cover")
      .value_name("HOW");
  parser.add_flag("--list-layers", options.list_layers, "List the layers of a drawing and their entities");
}

std::vector<std::string> given_drawing_options(const CommandParser& parser) {
  std::vector<std::string> given;
  for (const char* name : kNames)
    if (parser.option(name).is_given()) given.emplace_back(name);
  return given;
}

Status run_drawing(Console& console, const std::string& file, const std::string& svg, const std::string& dxf,
                   const DrawingOptions& options) {
  Diagnostics diagnostics;
  for (const std::string& path : {svg, dxf})
    if (!path.empty() && (is_same_file(path, file) || svg == dxf)) {
      diagnostics.error(codes::output_is_input, {}, "an output would replace the input, or the other output");
      console.show(diagnostics, Console::Channel::always_text);
      return Status::wrong_usage;
    }
  Result result;
  compute(result, file, options, diagnostics);
  if (result.drawn && !diagnostics.has_errors()) write_files(console, result, file, svg, dxf, diagnostics);
  console.show(diagnostics);
  if (console.json()) {
    console.print_json(text_of(result_record(file, options, result, diagnostics), Layout::indented));
  } else {
    if (options.list_layers && result.drawing) print_layers(console, result.layers);
    if (result.drawn) print_summary(console, result);
    for (const std::string& path : result.outputs) console.summary("wrote " + path);
  }
  return diagnostics.has_errors() ? Status::input_errors : Status::done;
}

}  // namespace kerf::app
