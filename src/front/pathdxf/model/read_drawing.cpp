// From the entities of a DXF file to the elements, texts and markers of its paths.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>

#include "base/codes/files.h"
#include "base/codes/outline.h"
#include "base/codes/pathdxf.h"
#include "base/file_names.h"
#include "base/number.h"
#include "front/pathdxf/model/assign_texts.h"
#include "front/pathdxf/model/drawing.h"
#include "front/pathdxf/text/nearly.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"
#include "kerf/drawing/dxf.h"

namespace kerf::pathdxf {
namespace {

constexpr double kStartDiameter = 1.0, kEndDiameter = 2.0, kProbeDiameter = 6.0;  // mm, of markers
constexpr double kParallel = 1e-9;  // of x and y of an extrusion direction parallel to Z
constexpr int kMillimetres = 4;     // $INSUNITS
constexpr double kDegree = std::numbers::pi / 180.0;

constexpr Bilingual kNoFile{"no such file", "Datei nicht gefunden"};
constexpr Bilingual kHasHeight{"Z coordinate {} of {} on path layer {} must be 0",
                               "Z-Koordinate {} von {} auf Pfad-Layer {} muss 0 sein"};
constexpr Bilingual kTilted{"{} on path layer {} is not parallel to the XY plane",
                            "{} auf Pfad-Layer {} ist nicht parallel zur XY-Ebene"};
constexpr Bilingual kFar{"{} has a coordinate beyond {} mm", "{} hat eine Koordinate jenseits von {} mm"};
constexpr Bilingual kUnit{"the drawing's unit is {}; one unit is taken as 1 mm",
                          "Die Einheit der Zeichnung ist {}; eine Einheit gilt als 1 mm"};
constexpr Bilingual kLayout{
    "Text {} must have anchor at center, or be unrotated, and neither mirrored nor upside down",
    "Text {} muss in der Mitte verankert oder ungedreht sein, und weder gespiegelt noch kopfstehend"};
constexpr Bilingual kUnassigned{
    "No overlapping circle, arc or line found for '{}'; maybe text center is not near enough to element "
    "(text "
    "circle: {}, diam. {}), or there is another overlapping text",
    "Kein überlappender Kreis, Bogen und keine Linie für '{}' gefunden; vielleicht liegt die Textmitte nicht "
    "nahe "
    "genug am Element (Textkreis: {}, Durchm. {}), oder es gibt einen weiteren überlappenden Text"};
constexpr Bilingual kTwoStarts{"Two start markers defined at {} and {}",
                               "Zwei Startmarkierungen bei {} und {}"};
constexpr Bilingual kTwoEnds{"Two end markers defined at {} and {}", "Zwei Endmarkierungen bei {} und {}"};
constexpr Bilingual kNoStart{"Start marker missing", "Startmarkierung fehlt"};
constexpr Bilingual kNoEnd{"End marker missing", "Endmarkierung fehlt"};
constexpr Bilingual kStartHint{
    "the start of a path is a circle of 1 mm diameter with line type PHANTOM on the path's layer",
    "Der Start eines Pfades ist ein Kreis mit 1 mm Durchmesser und Linientyp PHANTOM auf dem Layer des "
    "Pfades"};
constexpr Bilingual kEndHint{
    "the end of a path is a circle of 2 mm diameter with line type PHANTOM on the path's layer",
    "Das Ende eines Pfades ist ein Kreis mit 2 mm Durchmesser und Linientyp PHANTOM auf dem Layer des "
    "Pfades"};
constexpr Bilingual kStrangeMarker{
    "Circle with line type PHANTOM (__ _ _ __) and diameter {} has no special meaning",
    "Kreis mit Linientyp PHANTOM (__ _ _ __) und Durchmesser {} hat keine besondere Bedeutung"};
constexpr Bilingual kUnused{"{} on path layer {} is no path element and is ignored",
                            "{} auf Pfad-Layer {} ist kein Pfadelement und wird ignoriert"};
constexpr Bilingual kObject{"Object", "Objekt"};
constexpr Bilingual kAssigned{"has assigned text ''{}' @ {} d={}'", "hat den Text ''{}' @ {} d={}'"};
constexpr Bilingual kCase{"the name of path {} differs from the expression {} in its case",
                          "Der Name von Pfad {} weicht in Groß- und Kleinschreibung vom Ausdruck {} ab"};
constexpr Bilingual kInvalidShown{"Invalid expression for /x: {}", "Ungültiger Ausdruck für /x: {}"};
constexpr Bilingual kReferenceAlone{"@ path '{}' must not be used with other parameters",
                                    "Neben @-Pfad '{}' sind keine weiteren Parameter erlaubt"};
constexpr Bilingual kReferenceName{"@ path '@{}' does not match path pattern /{}/",
                                   "@-Pfad '@{}' entspricht nicht dem Pfad-Muster /{}/"};
constexpr Bilingual kReferenceMissing{"Path {} referenced with @ not found in this DXF file",
                                      "Mit @ referenzierter Pfad {} nicht in dieser DXF-Datei gefunden"};
constexpr Bilingual kReferenceTwice{"@ not allowed in path '{}' which is itself referenced by @",
                                    "@ nicht erlaubt in Pfad '{}', der selbst mit @ referenziert wird"};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

LineKind kind_of(std::string_view linetype) {
  const std::string name = lower(linetype);
  if (name == "phantom") return LineKind::marker;
  static const std::pair<std::string_view, LineKind> kKinds[] = {
      {"continuous", LineKind::mill}, {"divide", LineKind::mark},       {"border", LineKind::bars},
      {"center", LineKind::bars},     {"dashdot", LineKind::embedding}, {"dashed", LineKind::sweep},
      {"hidden", LineKind::skipped},  {"dot", LineKind::skipped}};
  for (const auto& [start, kind] : kKinds)
    if (name.substr(0, start.size()) == start) return kind;
  return LineKind::unknown;
}

bool is_far(const Element& element) {
  const auto beyond = [](Point2 p) {
    return !(std::abs(p.x) <= limits::kMaxCoordinate && std::abs(p.y) <= limits::kMaxCoordinate);
  };
  return beyond(element.start) || beyond(element.end) || beyond(element.centre) ||
         !(element.radius <= limits::kMaxCoordinate);
}

/// Whether an entity is of a kind that paths consist of.
bool is_read(const dxf::Entity& e) {
  if (const auto* text = std::get_if<dxf::Boxed<dxf::Text>>(&e.shape))
    return (*text)->kind == dxf::TextKind::text || (*text)->kind == dxf::TextKind::mtext;
  return std::holds_alternative<dxf::Line>(e.shape) || std::holds_alternative<dxf::Arc>(e.shape) ||
         std::holds_alternative<dxf::Circle>(e.shape);
}

class DrawingReader {
 public:
  DrawingReader(const dxf::Drawing& drawing, const PathNames& names, const PathdxfOptions& options,
                Report& report, DrawingPaths& out)
      : drawing_(drawing), names_(names), options_(options), report_(report), out_(out) {}

  void read() {
    name_tables();
    compile_shown_texts();
    if (drawing_.unit && *drawing_.unit != 0 && *drawing_.unit != kMillimetres)
      report_.warning(codes::pathdxf_unit, TextLocation{out_.file, 0, 0}, kUnit,
                      dxf::unit_name(*drawing_.unit));
    for (const dxf::Entity& e : drawing_.entities)
      if (!e.paper && path_of_layer_[e.layer] >= 0) read_element(e);
    for (std::size_t i = 0; i < out_.paths.size(); ++i) order_elements(i);
    // All TEXTs come before all MTEXTs.
    for (const bool mtext : {false, true})
      for (const dxf::Entity& e : drawing_.entities) {
        const auto* text = std::get_if<dxf::Boxed<dxf::Text>>(&e.shape);
        if (text == nullptr || e.paper || path_of_layer_[e.layer] < 0) continue;
        const dxf::TextKind kind = (*text)->kind;
        if (kind == (mtext ? dxf::TextKind::mtext : dxf::TextKind::text)) assign(e, **text);
      }
    for (PathDrawing& path : out_.paths) take_markers(path);
    resolve_references();
    report_unused();
  }

 private:
  void name_tables();
  void compile_shown_texts();
  void read_element(const dxf::Entity& e);
  std::optional<Element> element_of(const dxf::Entity& e);
  bool is_flat(const dxf::Entity& e, std::initializer_list<double> heights);
  void order_elements(std::size_t path);
  void assign(const dxf::Entity& e, const dxf::Text& text);
  void show(const Element& element, std::string_view text, const TextCircle& circle);
  void take_markers(PathDrawing& path);
  void take_marker(PathDrawing& path, const Element& circle);
  void set_marker(std::optional<Element>& marker, const Element& circle, const Bilingual& twice);
  void resolve_references();
  bool refer(PathDrawing& path, const ParameterText& text);
  void report_unused();
  Origin origin(const dxf::Entity& e, Point2 at, std::string_view entity) const {
    return DrawingLocation{out_.file, out_.layers[e.layer], dxf::handle_text(e.handle), at.x,
                           at.y,      std::string(entity)};
  }

  const dxf::Drawing& drawing_;
  const PathNames& names_;
  const PathdxfOptions& options_;
  Report& report_;
  DrawingPaths& out_;
  std::vector<int> path_of_layer_;
  std::optional<Pattern> shown_;                   // texts that are reported with their elements
  std::vector<std::vector<Element>> elements_[3];  // by shape, of each path
  std::map<std::uint32_t, TextTargets> targets_;   // of each layer
  std::map<std::string, std::pair<std::size_t, const dxf::Entity*>> unused_;  // by type: count and first
};

void DrawingReader::name_tables() {
  std::map<std::string, int> known;
  for (const dxf::Layer& layer : drawing_.layers) {
    out_.layers.push_back(layer.name);
    const auto name = names_.of_layer(layer.name);
    path_of_layer_.push_back(-1);
    if (name) path_of_layer_.back() = known.try_emplace(*name, static_cast<int>(known.size())).first->second;
  }
  // Only layers with elements or texts are paths, in the order of the entities.
  std::vector<int> number(known.size(), -1);
  for (const dxf::Entity& e : drawing_.entities) {
    const int k = e.paper || !is_read(e) ? -1 : path_of_layer_[e.layer];
    if (k < 0 || number[static_cast<std::size_t>(k)] >= 0) continue;
    number[static_cast<std::size_t>(k)] = static_cast<int>(out_.paths.size());
    out_.paths.push_back({*names_.of_layer(out_.layers[e.layer]), {}, {}, {}, {}, true});
    const PathDrawing& path = out_.paths.back();
    if (!names_.has_expected_case(path.name))
      report_.note(codes::pathdxf_assumed, out_.origin(path), kCase, path.name, names_.expression());
  }
  for (int& path : path_of_layer_)
    if (path >= 0) path = number[static_cast<std::size_t>(path)];
  for (const dxf::Linetype& type : drawing_.linetypes) out_.linetypes.push_back(type.name);
  for (auto& shape : elements_) shape.resize(out_.paths.size());
}

void DrawingReader::compile_shown_texts() {
  if (!options_.shown_texts) return;
  std::string problem;
  shown_ = Pattern::compile(*options_.shown_texts, LetterCase::distinct, problem);
  if (!shown_) report_.error(codes::pathdxf_pattern, {}, kInvalidShown, problem);
}

bool DrawingReader::is_flat(const dxf::Entity& e, std::initializer_list<double> heights) {
  const std::string type(dxf::type_name(drawing_, e));
  const dxf::Point& up = drawing_.extrusions[e.extrusion];
  if (std::hypot(up.x, up.y) > kParallel * std::abs(up.z)) {
    report_.error(codes::pathdxf_height, dxf::origin_of(drawing_, e), kTilted, type, out_.layers[e.layer]);
    out_.usable = false;
    return false;
  }
  for (const double z : heights) {
    if (near(z, 0.0)) continue;
    report_.error(codes::pathdxf_height, dxf::origin_of(drawing_, e), kHasHeight, number_text(z, 6), type,
                  out_.layers[e.layer]);
    out_.usable = false;
    return false;
  }
  return true;
}

std::optional<Element> DrawingReader::element_of(const dxf::Entity& e) {
  Element out;
  out.layer = e.layer;
  out.linetype = e.linetype == dxf::kByLayer ? drawing_.layers[e.layer].linetype : e.linetype;
  out.kind = kind_of(drawing_.linetypes[out.linetype].name);
  out.handle = e.handle;
  const auto line = std::get_if<dxf::Line>(&e.shape);
  if (line != nullptr) {
    if (!is_flat(e, {line->from.z, line->to.z})) return std::nullopt;
    out.start = {line->from.x, line->from.y};
    out.end = {line->to.x, line->to.y};
    return out;
  }
  const auto circle = std::get_if<dxf::Circle>(&e.shape);
  const auto arc = std::get_if<dxf::Arc>(&e.shape);
  if (circle == nullptr && arc == nullptr) return std::nullopt;
  const dxf::Point centre = circle != nullptr ? circle->centre : arc->centre;
  if (!is_flat(e, {centre.z})) return std::nullopt;
  // Seen from below, the X axis of object coordinates is reversed.
  const double mirror = drawing_.extrusions[e.extrusion].z < 0.0 ? -1.0 : 1.0;
  out.centre = {mirror * centre.x, centre.y};
  out.radius = circle != nullptr ? circle->radius : arc->radius;
  out.shape = circle != nullptr ? Shape::circle : Shape::arc;
  if (arc == nullptr) return out;
  double turn = std::fmod(arc->end - arc->start, 360.0);
  if (turn <= 0.0) turn += 360.0;
  out.turn = mirror * turn * kDegree;
  out.start_angle = (mirror > 0.0 ? arc->start : 180.0 - arc->start) * kDegree;
  const auto at = [&](double angle) {
    return Point2{out.centre.x + out.radius * std::cos(angle), out.centre.y + out.radius * std::sin(angle)};
  };
  out.start = at(out.start_angle);
  out.end = at(mirror > 0.0 ? arc->end * kDegree : (180.0 - arc->end) * kDegree);
  return out;
}

void DrawingReader::read_element(const dxf::Entity& e) {
  const std::size_t path = static_cast<std::size_t>(path_of_layer_[e.layer]);
  if (const auto element = element_of(e)) {
    if (is_far(*element)) {
      report_.error(codes::drawing_far, dxf::origin_of(drawing_, e), kFar, dxf::type_name(drawing_, e),
                    limits::kMaxCoordinate);
      out_.usable = false;
      return;
    }
    elements_[static_cast<std::size_t>(element->shape)][path].push_back(*element);
    return;
  }
  if (is_read(e)) return;
  auto& [count, first] = unused_[std::string(dxf::type_name(drawing_, e))];
  if (count++ == 0) first = &e;
}

/// Circles come before lines, lines before arcs.
void DrawingReader::order_elements(std::size_t path) {
  std::vector<Element>& all = out_.paths[path].elements;
  for (const Shape shape : {Shape::circle, Shape::line, Shape::arc}) {
    const auto& some = elements_[static_cast<std::size_t>(shape)][path];
    all.insert(all.end(), some.begin(), some.end());
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Element& element = all[i];
    const bool is_end = element.shape == Shape::circle && element.kind == LineKind::marker &&
                        near(2.0 * element.radius, kEndDiameter);
    if (!is_end && lower(out_.linetypes[element.linetype]) != "hidden")
      targets_[element.layer].add(element, i);
  }
}

void DrawingReader::assign(const dxf::Entity& e, const dxf::Text& text) {
  PathDrawing& path = out_.paths[static_cast<std::size_t>(path_of_layer_[e.layer])];
  const Origin where =
      origin(e, {text.at.x, text.at.y}, text.kind == dxf::TextKind::mtext ? "MTEXT" : "TEXT");
  const std::string plain = unformatted(text);
  const auto circle = circle_of(text);
  if (!is_flat(e, {text.at.z})) return;
  if (!circle) {
    report_.error(codes::pathdxf_text_layout, where, kLayout, plain);
    return;
  }
  const auto number = targets_[e.layer].take(*circle);
  if (!number) {
    report_.error(codes::pathdxf_text_unassigned, where, kUnassigned, plain, point_text(circle->centre),
                  fixed_text(2.0 * circle->radius, 3));
    return;
  }
  ParameterText parameters;
  const std::string value = without_special_characters(plain);
  if (!parse_parameters(value, where, report_, parameters)) path.usable = false;
  out_.texts.push_back(std::move(parameters));
  path.elements[*number].text = static_cast<int>(out_.texts.size() - 1);
  show(path.elements[*number], value, *circle);
}

/// Reports the element of a text for /x.
void DrawingReader::show(const Element& element, std::string_view text, const TextCircle& circle) {
  if (!shown_ || !shown_->search(text)) return;
  const auto point = [](Point2 p) { return fmt::format("[{:.3f} {:.3f} 0.000]", p.x, p.y); };
  const auto degrees = [](double angle) { return std::fmod(angle / kDegree + 720.0, 360.0); };
  const std::string_view name = element.shape == Shape::line  ? "Line"
                                : element.shape == Shape::arc ? "Arc"
                                                              : "Circle";
  std::string upper(name);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  std::string line = fmt::format("   {0} LAYER={1} CODENAME={2} TYPE={0} LINETYPE={3}%1", name,
                                 out_.layers[element.layer], upper, out_.linetypes[element.linetype]);
  if (element.shape == Shape::line)
    line += fmt::format(" From={} To={}", point(element.start), point(element.end));
  else
    line += fmt::format(" Center={} Dia={:.3f}", point(element.centre), 2.0 * element.radius);
  if (element.shape == Shape::arc)
    line += fmt::format(" Start={:.3f} End={:.3f}", degrees(element.start_angle),
                        degrees(element.start_angle + element.turn));
  report_.data_line("");
  report_.line(kObject);
  report_.data_line(line);
  report_.line(kAssigned, text, point_text(circle.centre), fixed_text(2.0 * circle.radius, 3));
}

void DrawingReader::set_marker(std::optional<Element>& marker, const Element& circle,
                               const Bilingual& twice) {
  if (!marker) {
    marker = circle;
    return;
  }
  report_.error(codes::pathdxf_marker, out_.origin(circle), twice, point_text(marker->centre),
                point_text(circle.centre));
}

void DrawingReader::take_marker(PathDrawing& path, const Element& circle) {
  const double diameter = 2.0 * circle.radius;
  if (near(diameter, kStartDiameter)) return set_marker(path.start, circle, kTwoStarts);
  if (near(diameter, kEndDiameter)) return set_marker(path.end, circle, kTwoEnds);
  if (near(diameter, kProbeDiameter)) {
    path.probes.push_back(circle);
    return;
  }
  report_.error(codes::pathdxf_marker, out_.origin(circle), kStrangeMarker, fixed_text(diameter, 3));
}

/// Takes start, end and probes out of the elements.
void DrawingReader::take_markers(PathDrawing& path) {
  std::vector<Element> rest;
  for (const Element& e : path.elements) {
    const std::string name = lower(out_.linetypes[e.linetype]);
    const bool has_probe_size = e.shape == Shape::circle && near(2.0 * e.radius, kProbeDiameter);
    if (e.shape == Shape::circle && e.kind == LineKind::marker)
      take_marker(path, e);
    else if (has_probe_size && name == "dashdot")
      path.probes.push_back(e);
    else if (!(has_probe_size && name == "dot"))
      rest.push_back(e);
  }
  path.elements = std::move(rest);
  if (path.start && path.end) return;
  if (!path.start) {
    report_.error(codes::pathdxf_marker, out_.origin(path), kNoStart);
    report_.hint(kStartHint);
  }
  if (!path.end) {
    report_.error(codes::pathdxf_marker, out_.origin(path), kNoEnd);
    report_.hint(kEndHint);
  }
  path.usable = false;
}

/// Parameters of a start marker that are "@" and the name of another path of the drawing.
void DrawingReader::resolve_references() {
  std::vector<int> texts(out_.paths.size(), -1);
  for (std::size_t i = 0; i < out_.paths.size(); ++i) {
    PathDrawing& path = out_.paths[i];
    if (!path.start) continue;
    texts[i] = path.start->text;
    const ParameterText* text = out_.text_of(*path.start);
    if (text == nullptr) continue;
    const auto has_reference = [](const Parameter& p) { return p.key == "@"; };
    if (std::none_of(text->values.begin(), text->values.end(), has_reference)) continue;
    const Origin where = text->where;
    if (text->values.size() != 1 || !text->variables.empty()) {
      report_.error(codes::pathdxf_reference, where, kReferenceAlone, text->text);
      path.usable = false;
      continue;
    }
    const std::string& name = text->values.front().value;
    const PathDrawing* other = names_.in_value(name) ? out_.find(name) : nullptr;
    const ParameterText* source = other != nullptr && other->start ? out_.text_of(*other->start) : nullptr;
    if (!names_.in_value(name))
      report_.error(codes::pathdxf_reference, where, kReferenceName, name, names_.expression());
    else if (source == nullptr)
      report_.error(codes::pathdxf_reference, where, kReferenceMissing, name);
    else if (std::any_of(source->values.begin(), source->values.end(), has_reference))
      report_.error(codes::pathdxf_reference, where, kReferenceTwice, name);
    else
      texts[i] = other->start->text;
    if (texts[i] == path.start->text) path.usable = false;
  }
  for (std::size_t i = 0; i < out_.paths.size(); ++i)
    if (out_.paths[i].start) out_.paths[i].start->text = texts[i];
}

void DrawingReader::report_unused() {
  for (const auto& [type, found] : unused_) {
    const auto& [count, first] = found;
    const std::string what = count == 1 ? type : fmt::format("{} {}", count, type);
    report_.note(codes::pathdxf_unused, dxf::origin_of(drawing_, *first), kUnused, what,
                 out_.layers[first->layer]);
  }
}

std::optional<dxf::Drawing> read_file(const std::string& file, const PathdxfOptions& options,
                                      Report& report) {
  if (options.opened && options.opened->file == file)
    return dxf::read_dxf(options.opened->bytes, file, report.diagnostics());
  if (options.read_file) {
    const auto bytes = options.read_file(file);
    if (!bytes) report.error(codes::file_unreadable, TextLocation{file, 0, 0}, kNoFile);
    return bytes ? dxf::read_dxf(*bytes, file, report.diagnostics()) : std::nullopt;
  }
  const auto input = InputFile::open(file, report.diagnostics(), limits::kMaxProgramBytes);
  return input ? dxf::read_dxf(input->bytes(), file, report.diagnostics()) : std::nullopt;
}

}  // namespace

Origin DrawingPaths::origin(const Element& element) const {
  const Point2 at = element.position();
  return DrawingLocation{file,
                         layers[element.layer],
                         dxf::handle_text(element.handle),
                         at.x,
                         at.y,
                         element.shape == Shape::line  ? "LINE"
                         : element.shape == Shape::arc ? "ARC"
                                                       : "CIRCLE"};
}

Origin DrawingPaths::origin(const PathDrawing& path) const {
  return DrawingLocation{file, path.name, {}, 0.0, 0.0, {}};
}

const PathDrawing* DrawingPaths::find(std::string_view name) const {
  for (const PathDrawing& path : paths)
    if (path.name == name) return &path;
  return nullptr;
}

std::string name_in_file(const PathDrawing& path, const DrawingPaths& drawing) {
  return fmt::format("{}[{}]", path.name, drawing.file_name);
}

std::string point_text(Point2 p) { return fmt::format("[{:.3f} {:.3f}]", p.x, p.y); }

DrawingPaths read_drawing(const std::string& file, const PathNames& names, const PathdxfOptions& options,
                          Report& report) {
  DrawingPaths out;
  out.file = file;
  out.file_name = name_in_folder(file);
  out.folder = folder_of(file);
  out.usable = false;
  const std::size_t errors = report.errors();
  const auto drawing = read_file(file, options, report);
  if (!drawing || report.errors() > errors) return out;
  out.usable = true;
  out.version = drawing->version;
  DrawingReader(*drawing, names, options, report, out).read();
  return out;
}

}  // namespace kerf::pathdxf
