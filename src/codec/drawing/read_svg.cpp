// Reads SVG: walks the elements with their transforms and styles, and appends their shapes to the drawing.
#include "base/codes/outline.h"
#include "base/names.h"
#include "base/number.h"

#include "kerf/drawing/svg.h"

#if KERF_WITH_SVG
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

#include "codec/drawing/svg_entities.h"
#include "codec/drawing/svg_tree.h"
#include "codec/drawing/svg_values.h"
#endif

namespace kerf {

bool is_svg(std::string_view bytes) {
  constexpr std::size_t kStart = 65536;
  const std::size_t first = bytes.find_first_not_of("\xEF\xBB\xBF \t\r\n");
  if (first == std::string_view::npos || bytes[first] != '<') return false;
  const std::string_view start = bytes.substr(first, kStart);
  return start.find("<svg") != std::string_view::npos || start.find(":svg") != std::string_view::npos;
}

std::optional<dxf::Drawing> read_drawing(std::string_view bytes, const std::string& file_name,
                                         Diagnostics& diagnostics) {
  if (is_svg(bytes)) return read_svg(bytes, file_name, {}, diagnostics);
  return dxf::read_dxf(bytes, file_name, diagnostics);
}

std::optional<Length> drawing_unit(std::string_view name) {
  constexpr double kPixelsPerInch = 96.0, kPointsPerInch = 72.0;
  if (const auto size = mm_per_unit(name)) return mm(*size);
  if (name == "px") return inch(1.0 / kPixelsPerInch);
  if (name == "pt") return inch(1.0 / kPointsPerInch);
  return std::nullopt;
}

#if KERF_WITH_SVG

namespace svg {
namespace {

using Declarations = std::vector<std::pair<std::string, std::string>>;

/// "fill:none; stroke:#f00"
Declarations declarations_of(std::string_view text) {
  Declarations out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    const std::string_view one = text.substr(0, end);
    const std::size_t colon = one.find(':');
    if (colon != std::string_view::npos)
      out.emplace_back(trim(one.substr(0, colon)), trim(one.substr(colon + 1)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

/// The inherited properties that are used.
struct Style {
  std::string stroke, fill;
  bool is_hidden = false;  // visibility
  bool is_shown = true;    // display; not inherited, but nothing inside is shown

  void set(std::string_view key, std::string_view value) {
    if (value == "inherit") return;
    if (key == "stroke") stroke = colour_name(value);
    if (key == "fill") fill = colour_name(value);
    if (key == "visibility") is_hidden = value != "visible";
    if (key == "display") is_shown = value != "none";
  }
};

struct Context {
  Affine matrix;
  Style style;
  std::string layer;  // of Inkscape
};

class SvgReader {
 public:
  SvgReader(const std::string& file, const SvgOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics), writer_(drawing_, chains_) {
    drawing_.file = file;
  }
  std::optional<dxf::Drawing> read(const Element& root);

 private:
  void read_page(const Element& root, Context& context);
  std::optional<Affine> view_box(const Element& element, double width, double height);
  void index(const Element& element);
  void read_rules(std::string_view text);
  void apply_style(const Element& element, Style& style) const;
  void visit(const Element& element, Context context, std::size_t depth);
  void children(const Element& element, const Context& context, std::size_t depth);
  void visit_use(const Element& element, Context context, std::size_t depth);
  void nested(const Element& element, Context context, std::size_t depth);
  bool draw(const Element& element);
  void draw_path(const Element& element);
  void draw_rectangle(const Element& element);
  void draw_points(const Element& element, bool is_closed);
  std::uint32_t layer_of(const Context& context);
  double length_of(const Element& element, std::string_view key, double otherwise = 0.0);
  Origin location(const Element& e) const {
    return TextLocation{drawing_.file, static_cast<std::uint32_t>(e.line), 0};
  }
  void error(const Element& element, std::string_view key);
  void count_other(const Element& element, const EntityWriter::Setting& setting);
  bool within_limits(const Element& element, std::size_t depth);

  const SvgOptions& options_;
  Diagnostics& diagnostics_;
  dxf::Drawing drawing_;
  std::uint32_t chains_ = 0;
  EntityWriter writer_;
  std::map<std::string, const Element*, std::less<>> by_id_;
  std::map<std::string, Declarations, std::less<>> rules_;  // by a selector: ".a", "#b", "path"
  std::size_t elements_ = 0, segments_ = 0;
  bool is_over_limit_ = false;
};

void SvgReader::error(const Element& element, std::string_view key) {
  diagnostics_.error(codes::svg_value, location(element),
                     fmt::format("{}: {}=\"{}\" is invalid", element.name, key,
                                 std::string(element.attribute(key)).substr(0, 60)));
}

double SvgReader::length_of(const Element& element, std::string_view key, double otherwise) {
  const std::string_view text = element.attribute(key);
  if (text.empty()) return otherwise;
  const auto value = read_length(text);
  const auto scale = value ? pixels_per(value->unit) : std::nullopt;
  if (!scale) error(element, key);
  return scale ? value->value * *scale : otherwise;
}

// ---------------------------------------------------------------------------------------------- page and
// units

/// From the coordinates of a viewBox to a viewport of this size (preserveAspectRatio as by default: the same
/// scale in both directions, centred).
std::optional<Affine> SvgReader::view_box(const Element& element, double width, double height) {
  const std::string_view text = element.attribute("viewBox");
  if (text.empty()) return Affine{};
  const auto box = read_numbers(text);
  if (!box || box->size() != 4 || !((*box)[2] > 0.0) || !((*box)[3] > 0.0)) {
    error(element, "viewBox");
    return std::nullopt;
  }
  const double x = width / (*box)[2], y = height / (*box)[3];
  if (element.attribute("preserveAspectRatio") == "none")
    return Affine{x, 0, 0, y, -x * (*box)[0], -y * (*box)[1]};
  const double scale = std::min(x, y);
  return Affine{scale,
                0,
                0,
                scale,
                0.5 * (width - scale * (*box)[2]) - scale * (*box)[0],
                0.5 * (height - scale * (*box)[3]) - scale * (*box)[1]};
}

/// The transform of the page: with y up, in mm if its size is specified in a unit of length.
void SvgReader::read_page(const Element& root, Context& context) {
  const auto width = read_length(root.attribute("width")), height = read_length(root.attribute("height"));
  const auto box = read_numbers(root.attribute("viewBox"));
  const bool has_box = box && box->size() == 4 && (*box)[2] > 0.0 && (*box)[3] > 0.0;
  const auto known = width ? mm_per(width->unit) : height ? mm_per(height->unit) : std::nullopt;
  const double per_pixel = known ? *mm_per("in") / *pixels_per("in") : 1.0;  // of the drawing's unit
  const auto pixels = [](const std::optional<UnitLength>& l) -> std::optional<double> {
    const auto scale = l ? pixels_per(l->unit) : std::nullopt;
    return scale && l->value > 0.0 ? std::optional(l->value * *scale) : std::nullopt;
  };
  auto w = pixels(width), h = pixels(height);
  if (has_box && !w && h) w = *h * (*box)[2] / (*box)[3];
  if (has_box && w && !h) h = *w * (*box)[3] / (*box)[2];
  if (has_box && !w) w = (*box)[2];
  if (has_box && !h) h = (*box)[3];
  if (known) drawing_.unit = 4;
  const Affine upright{per_pixel, 0, 0, -per_pixel, 0, per_pixel * h.value_or(0.0)};
  context.matrix = upright * view_box(root, w.value_or(0.0), h.value_or(0.0)).value_or(Affine{});
}

// ------------------------------------------------------------------------------------------------------
// styles

/// Rules with selectors of one class, id or element name; others are ignored.
void SvgReader::read_rules(std::string_view text) {
  while (true) {
    const std::size_t open = text.find('{');
    const std::size_t close = open == std::string_view::npos ? open : text.find('}', open);
    if (close == std::string_view::npos) return;
    std::string_view selectors = text.substr(0, open);
    const Declarations found = declarations_of(text.substr(open + 1, close - open - 1));
    while (!selectors.empty()) {
      const std::size_t comma = std::min(selectors.find(','), selectors.size());
      Declarations& rule = rules_[std::string(trim(selectors.substr(0, comma)))];
      rule.insert(rule.end(), found.begin(), found.end());
      selectors.remove_prefix(std::min(comma + 1, selectors.size()));
    }
    text.remove_prefix(close + 1);
  }
}

/// Attributes, then rules for the element's name, classes and id, then its style, as in CSS.
void SvgReader::apply_style(const Element& element, Style& style) const {
  for (const char* key : {"stroke", "fill", "visibility", "display"})
    if (const auto value = element.attribute(key); !value.empty()) style.set(key, value);
  const auto apply = [&](const std::string& selector) {
    const auto rule = rules_.find(selector);
    if (rule == rules_.end()) return;
    for (const auto& [key, value] : rule->second) style.set(key, value);
  };
  if (!rules_.empty()) {
    apply(element.name);
    std::string_view classes = element.attribute("class");
    while (!(classes = trim(classes)).empty()) {
      const std::size_t end = std::min(classes.find_first_of(" \t\r\n"), classes.size());
      apply("." + std::string(classes.substr(0, end)));
      classes.remove_prefix(end);
    }
    if (const auto id = element.attribute("id"); !id.empty()) apply("#" + std::string(id));
  }
  for (const auto& [key, value] : declarations_of(element.attribute("style"))) style.set(key, value);
}

std::uint32_t SvgReader::layer_of(const Context& context) {
  const Style& style = context.style;
  std::string name = context.layer;
  if (name.empty()) name = !style.stroke.empty() && style.stroke != "none" ? style.stroke : style.fill;
  if (name.empty()) name = "#000000";  // the default of fill
  if (const auto known = dxf::find_layer(drawing_, name)) return *known;
  dxf::Layer& layer = drawing_.layers.emplace_back();
  layer.name = name;
  layer.declared = true;
  return static_cast<std::uint32_t>(drawing_.layers.size() - 1);
}

// ----------------------------------------------------------------------------------------------------
// elements

void SvgReader::index(const Element& element) {
  if (const auto id = element.attribute("id"); !id.empty()) by_id_.emplace(id, &element);
  if (element.name == "style") read_rules(element.text);
  for (const Element& child : element.children) index(child);
}

bool SvgReader::within_limits(const Element& element, std::size_t depth) {
  if (is_over_limit_) return false;
  std::string what;
  if (depth > options_.max_depth)
    what = fmt::format("elements are nested more than {} deep", options_.max_depth);
  if (++elements_ > options_.max_elements) what = fmt::format("more than {} elements", options_.max_elements);
  if (segments_ > options_.max_segments)
    what = fmt::format("more than {} path segments", options_.max_segments);
  if (what.empty()) return true;
  is_over_limit_ = true;
  diagnostics_.error(codes::svg_limit, location(element), what);
  return false;
}

void SvgReader::children(const Element& element, const Context& context, std::size_t depth) {
  for (const Element& child : element.children) visit(child, context, depth + 1);
}

void SvgReader::visit_use(const Element& element, Context context, std::size_t depth) {
  std::string_view link = element.attribute("href");
  if (link.empty()) link = element.attribute("xlink:href");
  const auto target = link.empty() || link[0] != '#' ? by_id_.end() : by_id_.find(link.substr(1));
  if (target == by_id_.end()) {
    diagnostics_.error(codes::svg_reference, location(element),
                       fmt::format("use: there is no element \"{}\"", std::string(link).substr(0, 60)));
    return;
  }
  context.matrix = context.matrix * Affine{1, 0, 0, 1, length_of(element, "x"), length_of(element, "y")};
  if (target->second->name != "symbol") return visit(*target->second, context, depth + 1);
  apply_style(*target->second, context.style);
  children(*target->second, context, depth + 1);
}

/// An svg element inside of another one.
void SvgReader::nested(const Element& element, Context context, std::size_t depth) {
  context.matrix = context.matrix * Affine{1, 0, 0, 1, length_of(element, "x"), length_of(element, "y")};
  const double width = length_of(element, "width"), height = length_of(element, "height");
  const auto box = width > 0.0 && height > 0.0 ? view_box(element, width, height) : Affine{};
  if (!box) return;
  context.matrix = context.matrix * *box;
  children(element, context, depth);
}

void SvgReader::visit(const Element& element, Context context, std::size_t depth) {
  static constexpr std::string_view kUndrawn[] = {"defs",    "symbol", "clipPath", "mask", "marker",
                                                  "pattern", "style",  "title",    "desc", "metadata"};
  if (std::find(std::begin(kUndrawn), std::end(kUndrawn), element.name) != std::end(kUndrawn)) return;
  if (!within_limits(element, depth)) return;
  apply_style(element, context.style);
  if (!context.style.is_shown) return;
  const auto transform = read_transform(element.attribute("transform"));
  if (!transform) return error(element, "transform");
  context.matrix = context.matrix * *transform;
  if (element.name == "g" || element.name == "a" || element.name == "switch") {
    if (element.attribute("inkscape:groupmode") == "layer") {
      const auto label = element.attribute("inkscape:label");
      context.layer = label.empty() ? element.attribute("id") : label;
    }
    return children(element, context, depth);
  }
  if (element.name == "use") return visit_use(element, context, depth);
  if (element.name == "svg") return nested(element, context, depth);
  if (element.name.find(':') != std::string::npos) return;  // of an editor
  const EntityWriter::Setting setting{context.matrix, layer_of(context), element.line,
                                      context.style.is_hidden};
  writer_.set(setting);
  const std::size_t first = drawing_.entities.size();
  if (!draw(element)) count_other(element, setting);
  segments_ += drawing_.entities.size() - first;
}

/// False if the element is not a shape.
bool SvgReader::draw(const Element& element) {
  if (element.name == "path") {
    draw_path(element);
  } else if (element.name == "rect") {
    draw_rectangle(element);
  } else if (element.name == "circle" || element.name == "ellipse") {
    const bool is_circle = element.name == "circle";
    const double rx = length_of(element, is_circle ? "r" : "rx"),
                 ry = is_circle ? rx : length_of(element, "ry");
    if (rx > 0.0 && ry > 0.0) writer_.ellipse({length_of(element, "cx"), length_of(element, "cy")}, rx, ry);
  } else if (element.name == "line") {
    std::vector<PathCommand> line(2);
    line[0].at[0] = {length_of(element, "x1"), length_of(element, "y1")};
    line[1].kind = 'L';
    line[1].at[0] = {length_of(element, "x2"), length_of(element, "y2")};
    writer_.path(line);
  } else if (element.name == "polyline" || element.name == "polygon") {
    draw_points(element, element.name == "polygon");
  } else {
    return false;
  }
  return true;
}

void SvgReader::draw_path(const Element& element) {
  const std::string_view text = element.attribute("d");
  const PathData data = read_path(text);
  segments_ += data.commands.size();
  if (data.error_at)
    diagnostics_.error(codes::svg_value, location(element),
                       fmt::format("path: invalid data at character {}: \"{}\"", *data.error_at + 1,
                                   std::string(text.substr(std::min(*data.error_at, text.size()), 20))));
  writer_.path(data.commands);
}

void SvgReader::draw_points(const Element& element, bool is_closed) {
  const auto numbers = read_numbers(element.attribute("points"));
  if (!numbers || numbers->size() % 2 != 0) return error(element, "points");
  std::vector<PathCommand> line;
  for (std::size_t i = 0; i < numbers->size(); i += 2) {
    PathCommand& command = line.emplace_back();
    command.kind = i == 0 ? 'M' : 'L';
    command.at[0] = {(*numbers)[i], (*numbers)[i + 1]};
  }
  if (is_closed && !line.empty()) line.emplace_back().kind = 'Z';
  segments_ += line.size();
  writer_.path(line);
}

void SvgReader::draw_rectangle(const Element& element) {
  const double x = length_of(element, "x"), y = length_of(element, "y");
  const double width = length_of(element, "width"), height = length_of(element, "height");
  if (!(width > 0.0) || !(height > 0.0)) return;
  double rx = length_of(element, "rx", -1.0), ry = length_of(element, "ry", -1.0);
  if (rx < 0.0) rx = ry;
  if (ry < 0.0) ry = rx;
  rx = std::clamp(rx, 0.0, 0.5 * width);
  ry = std::clamp(ry, 0.0, 0.5 * height);
  std::vector<PathCommand> path;
  const auto add = [&](char kind, Vec p) {
    PathCommand& command = path.emplace_back();
    command.kind = kind;
    command.at[kind == 'A' ? 1 : 0] = p;
    if (kind == 'A') command.at[0] = {rx, ry};
    command.is_sweep = true;
  };
  const double right = x + width, bottom = y + height;
  add('M', {x + rx, y});
  add('L', {right - rx, y});
  add('A', {right, y + ry});
  add('L', {right, bottom - ry});
  add('A', {right - rx, bottom});
  add('L', {x + rx, bottom});
  add('A', {x, bottom - ry});
  add('L', {x, y + ry});
  add('A', {x + rx, y});
  add('Z', {});
  writer_.path(path);
}

/// Texts and images, without their shape.
void SvgReader::count_other(const Element& element, const EntityWriter::Setting& setting) {
  auto type = std::find_if(drawing_.others.begin(), drawing_.others.end(),
                           [&](const dxf::OtherType& t) { return t.name == element.name; });
  if (type == drawing_.others.end()) type = drawing_.others.insert(type, {element.name, 0, element.line});
  ++type->count;
  dxf::Entity& entity = drawing_.entities.emplace_back();
  entity.layer = setting.layer;
  entity.position = setting.line;
  entity.hidden = setting.is_hidden;
  entity.shape = dxf::Other{static_cast<std::uint32_t>(type - drawing_.others.begin())};
}

std::optional<dxf::Drawing> SvgReader::read(const Element& root) {
  drawing_.format = dxf::Format::svg;
  drawing_.layers.emplace_back().name = "0";
  for (const char* name : {"BYLAYER", "BYBLOCK", "CONTINUOUS"}) drawing_.linetypes.emplace_back().name = name;
  drawing_.extrusions.push_back({0.0, 0.0, 1.0});
  index(root);
  Context page;
  read_page(root, page);
  apply_style(root, page.style);
  children(root, page, 0);
  if (is_over_limit_) return std::nullopt;
  return std::move(drawing_);
}

}  // namespace
}  // namespace svg

std::optional<dxf::Drawing> read_svg(std::string_view bytes, const std::string& file_name,
                                     const SvgOptions& options, Diagnostics& diagnostics) {
  const auto root = svg::read_tree(bytes, file_name, options.max_depth, diagnostics);
  if (!root) return std::nullopt;
  if (root->name != "svg") {
    diagnostics.error(codes::svg_xml, TextLocation{file_name, static_cast<std::uint32_t>(root->line), 0},
                      fmt::format("the root element is {}, expected svg", root->name));
    return std::nullopt;
  }
  return svg::SvgReader(file_name, options, diagnostics).read(*root);
}

#else

std::optional<dxf::Drawing> read_svg(std::string_view, const std::string& file_name, const SvgOptions&,
                                     Diagnostics& diagnostics) {
  diagnostics.error(codes::svg_xml, TextLocation{file_name, 0, 0}, "SVG cannot be read by this build");
  return std::nullopt;
}

#endif

}  // namespace kerf
