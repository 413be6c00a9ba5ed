// Prints what the DXF reader makes of a file as one JSON object, for tests that compare it with other
// readers.
//
//   dxf_dump FILE            the file's tables and entities
//   dxf_dump --placed FILE   the entities of the model, blocks inserted, with points in world coordinates
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "kerf/drawing/dxf.h"

namespace kerf::dxf {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(Point p) { return {p.x, p.y, p.z}; }
Json json_of(const std::vector<Point>& points) {
  Json list = Json::array();
  for (const Point& p : points) list.push_back(json_of(p));
  return list;
}

struct ShapeJson {
  const Drawing& drawing;
  Json operator()(const Line& s) const { return {{"from", json_of(s.from)}, {"to", json_of(s.to)}}; }
  Json operator()(const Circle& s) const { return {{"centre", json_of(s.centre)}, {"radius", s.radius}}; }
  Json operator()(const Arc& s) const {
    return {{"centre", json_of(s.centre)}, {"radius", s.radius}, {"start", s.start}, {"end", s.end}};
  }
  Json operator()(const Dot& s) const { return {{"at", json_of(s.at)}}; }
  Json operator()(const Boxed<Polyline>& s) const {
    Json vertices = Json::array();
    for (const Vertex& v : s->vertices) vertices.push_back({v.at.x, v.at.y, v.at.z, v.bulge});
    return {{"closed", s->closed}, {"spatial", s->spatial}, {"vertices", vertices}, {"widths", s->widths}};
  }
  Json operator()(const Boxed<Text>& s) const {
    Json made{{"text", s->text},
              {"plain", plain(*s)},
              {"at", json_of(s->at)},
              {"anchor", json_of(anchor(*s))},
              {"height", s->height},
              {"rotation", rotation(*s)},
              {"style", drawing.styles[s->style].name},
              {"width_factor", s->width_factor},
              {"oblique", s->oblique},
              {"horizontal", s->horizontal},
              {"vertical", s->vertical},
              {"attachment", s->attachment}};
    if (!s->tag.empty()) made["tag"] = s->tag;
    return made;
  }
  Json operator()(const TextPart&) const { return Json::object(); }  // of an SVG alone
  Json operator()(const Boxed<Insert>& s) const {
    return {{"block", drawing.blocks[s->block].name},
            {"at", json_of(s->at)},
            {"scale", json_of(s->scale)},
            {"rotation", s->rotation},
            {"columns", s->columns},
            {"rows", s->rows},
            {"spacing", {s->column_spacing, s->row_spacing}}};
  }
  Json operator()(const Boxed<Ellipse>& s) const {
    return {{"centre", json_of(s->centre)},
            {"major", json_of(s->major)},
            {"ratio", s->ratio},
            {"start", s->start},
            {"end", s->end}};
  }
  Json operator()(const Boxed<Spline>& s) const {
    return {{"degree", s->degree}, {"closed", s->closed},   {"control", json_of(s->control)},
            {"knots", s->knots},   {"weights", s->weights}, {"fit", json_of(s->fit)}};
  }
  Json operator()(const Boxed<Hatch>& s) const {
    Json loops = Json::array();
    for (const Hatch::Loop& loop : s->loops) {
      Json edges = Json::array();
      for (const Hatch::Edge& edge : loop.edges)
        edges.push_back(std::visit([this](const auto& shape) { return (*this)(shape); }, edge));
      loops.push_back(edges);
    }
    return {{"loops", loops}};
  }
  Json operator()(const Other&) const { return Json::object(); }
};

Json entity_json(const Drawing& drawing, const Entity& entity) {
  Json made{{"type", type_name(drawing, entity)},
            {"handle", handle_text(entity.handle)},
            {"position", entity.position},
            {"layer", drawing.layers[entity.layer].name},
            {"linetype", drawing.linetypes[entity.linetype].name},
            {"linetype_scale", entity.linetype_scale},
            {"colour", entity.colour},
            {"true_colour", entity.true_colour},
            {"lineweight", entity.lineweight},
            {"paper", entity.paper},
            {"hidden", entity.hidden},
            {"extrusion", json_of(drawing.extrusions[entity.extrusion])}};
  made["shape"] = std::visit(ShapeJson{drawing}, entity.shape);
  return made;
}

Json list_json(const Drawing& drawing, const std::vector<Entity>& entities) {
  Json list = Json::array();
  for (const Entity& entity : entities) list.push_back(entity_json(drawing, entity));
  return list;
}

/// Points of a shape in world coordinates: ends and corners; of circles and arcs three points.
struct WorldPoints {
  const Drawing& drawing;
  const Placed& placed;
  Matrix object() const { return placed.matrix * object_axes(drawing.extrusions[placed.entity.extrusion]); }
  std::vector<Point> round(Point centre, double radius, double start, double sweep) const {
    std::vector<Point> points;
    for (int i = 0; i < 3; ++i) {
      const double angle = (start + 0.5 * i * sweep) * std::numbers::pi / 180.0;
      points.push_back(object() * Point{centre.x + radius * std::cos(angle),
                                        centre.y + radius * std::sin(angle), centre.z});
    }
    return points;
  }
  std::vector<Point> operator()(const Line& s) const {
    return {placed.matrix * s.from, placed.matrix * s.to};
  }
  std::vector<Point> operator()(const Dot& s) const { return {placed.matrix * s.at}; }
  std::vector<Point> operator()(const Circle& s) const { return {object() * s.centre}; }
  std::vector<Point> operator()(const Arc& s) const {
    double sweep = std::fmod(s.end - s.start, 360.0);
    if (sweep <= 0.0) sweep += 360.0;
    return round(s.centre, s.radius, s.start, sweep);
  }
  std::vector<Point> operator()(const Boxed<Polyline>& s) const {
    const Matrix matrix = s->spatial ? placed.matrix : object();
    std::vector<Point> points;
    for (const Vertex& v : s->vertices) points.push_back(matrix * v.at);
    return points;
  }
  std::vector<Point> operator()(const Boxed<Text>& s) const {
    return {s->kind == TextKind::mtext ? placed.matrix * s->at : object() * anchor(*s)};
  }
  std::vector<Point> operator()(const Boxed<Ellipse>& s) const { return {placed.matrix * s->centre}; }
  std::vector<Point> operator()(const Boxed<Spline>& s) const {
    std::vector<Point> points;
    for (const Point& p : s->control.empty() ? s->fit : s->control) points.push_back(placed.matrix * p);
    return points;
  }
  std::vector<Point> operator()(const Boxed<Insert>&) const { return {}; }
  std::vector<Point> operator()(const Boxed<Hatch>&) const { return {}; }
  std::vector<Point> operator()(const Other&) const { return {}; }
  std::vector<Point> operator()(const TextPart&) const { return {}; }
};

Json placed_json(const Drawing& drawing, Diagnostics& diagnostics) {
  Json list = Json::array();
  VisitOptions options;
  options.max_entities = 20'000;
  for_each_placed(drawing, options, diagnostics, [&](const Placed& placed) {
    list.push_back({{"type", type_name(drawing, placed.entity)},
                    {"handle", handle_text(placed.entity.handle)},
                    {"layer", drawing.layers[placed.style.layer].name},
                    {"linetype", drawing.linetypes[placed.style.linetype].name},
                    {"colour", placed.style.colour},
                    {"true_colour", placed.style.true_colour},
                    {"visible", placed.style.visible},
                    {"depth", placed.inserts.size()},
                    {"points", json_of(std::visit(WorldPoints{drawing, placed}, placed.entity.shape))}});
  });
  return list;
}

Json tables_json(const Drawing& drawing) {
  Json layers = Json::array(), linetypes = Json::array(), blocks = Json::array(), others = Json::object();
  for (const Layer& l : drawing.layers)
    layers.push_back({{"name", l.name},
                      {"colour", l.colour},
                      {"true_colour", l.true_colour},
                      {"linetype", drawing.linetypes[l.linetype].name},
                      {"off", l.off},
                      {"frozen", l.frozen},
                      {"locked", l.locked},
                      {"plotted", l.plotted},
                      {"declared", l.declared}});
  for (const Linetype& l : drawing.linetypes)
    linetypes.push_back({{"name", l.name}, {"pattern", l.pattern}, {"declared", l.declared}});
  for (const Block& b : drawing.blocks)
    blocks.push_back({{"name", b.name},
                      {"base", json_of(b.base)},
                      {"declared", b.declared},
                      {"entities", list_json(drawing, b.entities)}});
  for (const OtherType& o : drawing.others) others[o.name] = o.count;
  Json unused = Json::array();
  for (const UnusedTag& tag : drawing.unused_tags) unused.push_back({tag.type, tag.group, tag.count});
  return {{"version", drawing.version},
          {"code_page", drawing.code_page},
          {"binary", drawing.binary},
          {"unit", drawing.unit ? Json(*drawing.unit) : Json()},
          {"header", drawing.header.size()},
          {"comments", drawing.comments},
          {"repeated_handles", drawing.repeated_handles},
          {"layers", layers},
          {"linetypes", linetypes},
          {"blocks", blocks},
          {"others", others},
          {"unused", unused}};
}

int run(const std::string& path, bool placed) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  Diagnostics diagnostics(10000);
  const auto drawing = read_dxf(bytes, path, diagnostics);
  Json out = drawing ? tables_json(*drawing) : Json::object();
  out["read"] = drawing.has_value();
  if (drawing)
    out["entities"] = placed ? placed_json(*drawing, diagnostics) : list_json(*drawing, drawing->entities);
  Json& reports = out["diagnostics"] = Json::array();
  for (const Diagnostic& d : diagnostics.list()) {
    const auto* location = std::get_if<TextLocation>(&d.where);
    reports.push_back({{"code", name_of(d.code)},
                       {"severity", to_string(d.severity)},
                       {"line", location != nullptr ? location->line : 0},
                       {"message", d.message}});
  }
  std::puts(out.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
  return 0;
}

}  // namespace
}  // namespace kerf::dxf

int main(int argc, char** argv) {
  const bool placed = argc == 3 && std::string(argv[1]) == "--placed";
  if (argc != 2 && !placed) return 2;
  return kerf::dxf::run(argv[argc - 1], placed);
}
