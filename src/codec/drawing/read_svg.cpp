// Reads SVG: walks the elements with their transforms and styles, and appends their shapes to the drawing.
#include "base/codes/outline.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/drawing/colour_names.h"

#include "kerf/drawing/svg.h"

#if KERF_WITH_SVG
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "codec/drawing/svg_reader.h"
#include "codec/drawing/svg_transforms.h"
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
                                         Diagnostics& diagnostics, Progress* progress) {
  SvgOptions options;
  options.progress = progress;
  if (is_svg(bytes)) return read_svg(bytes, file_name, options, diagnostics);
  Diagnostics own;
  auto drawing = dxf::read_dxf(bytes, file_name, own, progress);
  if (!drawing && stop_requested(progress)) return std::nullopt;
  for (Diagnostic d : own.list()) {
    const bool is_entity =
        d.code == codes::dxf_value || d.code == codes::dxf_number || d.code == codes::dxf_group_code;
    if (drawing && is_entity) d.severity = Severity::warning;
    diagnostics.add(std::move(d));
  }
  return drawing;
}

std::optional<StrokeShapes> stroke_shapes_of(std::string_view name) {
  if (name == "lines") return StrokeShapes::lines;
  return name == "areas" ? std::optional(StrokeShapes::areas) : std::nullopt;
}

std::optional<Length> drawing_unit(std::string_view name) {
  constexpr double kPixelsPerInch = 96.0, kPointsPerInch = 72.0;
  if (const auto size = mm_per_unit(name)) return mm(*size);
  if (name == "px") return inch(1.0 / kPixelsPerInch);
  if (name == "pt") return inch(1.0 / kPointsPerInch);
  return std::nullopt;
}

std::string colour_layer(std::string_view name) {
  const auto colour = svg::read_colour(name);
  return colour ? svg::name_of(*colour) : std::string(name);
}

#if KERF_WITH_SVG

namespace svg {
namespace {

/// Elements that are drawn only where others refer to them, or not at all.
bool is_undrawn(std::string_view name) {
  static constexpr std::string_view kNames[] = {
      "defs",    "symbol",         "clipPath",         "mask",   "marker",
      "pattern", "linearGradient", "radialGradient",   "filter", "style",
      "title",   "desc",           "script",           "view",   "metadata",
      "animate", "animateMotion",  "animateTransform", "set",    "font",
      "cursor"};
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

bool is_paint_server(std::string_view name) {
  return name == "linearGradient" || name == "radialGradient" || name == "pattern";
}

/// A fraction as a number or in percent.
double fraction_of(std::string_view text, double otherwise) {
  const auto value = read_length(text);
  if (!value || (!value->unit.empty() && value->unit != "%")) return otherwise;
  return std::clamp(value->unit == "%" ? 0.01 * value->value : value->value, 0.0, 1.0);
}

/// Whether a transform scales equally in all directions.
bool is_even(const Affine& m) {
  constexpr double kRounding = 1e-9;
  const double x = std::hypot(m.a, m.b), y = std::hypot(m.c, m.d);
  return std::abs(x - y) <= kRounding * (x + y) && std::abs(m.a * m.c + m.b * m.d) <= kRounding * x * y;
}

/// "none", "currentColor", "#f00", "url(#a) red"; nothing if the text is no paint.
std::optional<PaintValue> read_paint(std::string_view text) {
  const std::string name = lowered(trim(text));
  if (name == "none" || name == "currentcolor") return PaintValue{name, {}, {}, 1.0};
  if (name == "context-fill" || name == "context-stroke") return PaintValue{};
  if (name.rfind("url(", 0) == 0) {
    text = trim(text).substr(4);
    const std::size_t close = text.find(')');
    if (close == std::string_view::npos) return std::nullopt;
    std::string_view link = trim(text.substr(0, close));
    if (link.size() >= 2 && (link.front() == '"' || link.front() == '\''))
      link = link.substr(1, link.size() - 2);
    PaintValue paint{"url", std::string(link.substr(0, 1) == "#" ? link.substr(1) : ""), "none", 1.0};
    if (const auto rest = trim(text.substr(close + 1)); !rest.empty()) paint.fallback = lowered(rest);
    return paint;
  }
  const auto colour = read_colour(name);
  if (!colour) return std::nullopt;
  return PaintValue{name_of(*colour), {}, {}, colour->alpha};
}

}  // namespace

bool passes_conditions(const Element& element) {
  if (element.has("requiredExtensions")) return false;
  if (!element.has("systemLanguage")) return true;
  std::string_view languages = element.attribute("systemLanguage");
  while (!languages.empty()) {
    const std::size_t comma = std::min(languages.find(','), languages.size());
    const std::string one = lowered(trim(languages.substr(0, comma)));
    if (one == "en" || one.substr(0, 3) == "en-") return true;
    languages.remove_prefix(std::min(comma + 1, languages.size()));
  }
  return false;
}

// ------------------------------------------------------------------------------------------------- messages

void SvgReader::warn(const Element& element, std::string_view key, std::string_view value,
                     std::string_view what) {
  diagnostics_.warning(codes::svg_value, location(element),
                       fmt::format("{}: {}=\"{}\" {}", element.name, key, clipped(value, 60), what));
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

/// A transform that leaves the page: once for the drawing.
void SvgReader::note_tilted(const Element& element) {
  if (std::exchange(has_tilted_, true)) return;
  diagnostics_.warning(codes::svg_value, location(element),
                       element.name +
                           ": its transform turns it out of the page; its projection is drawn, here "
                           "and for other elements");
}

/// Counts an element with a property that has no effect on outlines, such as a mask.
void SvgReader::note_ignored(const Element& element, std::string_view what, std::string_view consequence) {
  Ignored& ignored = ignored_[std::string(what)];
  ignored.consequence = consequence;
  if (ignored.count++ == 0) ignored.first = &element;
}

void SvgReader::report_ignored() {
  for (const auto& [what, ignored] : ignored_) {
    if (ignored.is_applied) {
      diagnostics_.note(codes::svg_clip, location(*ignored.first),
                        fmt::format("{} clips {} element{}", what, ignored.count,
                                    ignored.count == 1 ? "" : "s, this one the first"));
      continue;
    }
    diagnostics_.warning(
        codes::svg_ignored, location(*ignored.first),
        fmt::format("{} of {} element{} {}", what, ignored.count,
                    ignored.count == 1 ? "" : "s, this one the first,", ignored.consequence));
  }
  for (std::size_t i = 0; i < unknown_rules_.size(); ++i)
    diagnostics_.warning(codes::svg_ignored, location(*unknown_rules_[i]),
                         fmt::format("the style rule of \"{}\" is not understood and is ignored",
                                     clipped(trim(sheet_.unknown()[i]), 60)));
}

// -------------------------------------------------------------------------------------------------- lengths

/// The user units of a length, or nothing where the element has none or, with a warning, an invalid one.
std::optional<double> SvgReader::length_of(const Drawn& drawn, std::string_view key, Axis axis, Range range) {
  static constexpr std::string_view kNumbers[] = {"stroke-width", "stroke-dashoffset"};
  const bool is_numeric = std::find(std::begin(kNumbers), std::end(kNumbers), key) != std::end(kNumbers);
  for (const auto& [text, source] : drawn.properties.candidates(key)) {
    const bool takes_numbers = source != Properties::Source::sheet || is_numeric;
    if (text == "auto" || text == "inherit" || text == "initial" || text == "unset") return std::nullopt;
    bool is_unknown = false;  // what 100% is
    std::string by_font;
    const auto length = css_value(text, [&](std::string_view unit) -> std::optional<double> {
      if (unit.empty() && !takes_numbers) return std::nullopt;
      const auto scale = resolved({1.0, std::string(unit)}, drawn.context.base, axis);
      is_unknown = is_unknown || (unit == "%" && !scale);
      if (depends_on_font(unit))
        by_font = fmt::format("1{} is assumed to be {:g} px", unit, scale.value_or(0.0));
      return scale;
    });
    if (!length || (range == Range::positive && *length < 0.0)) {
      warn(drawn.element, key, text,
           is_unknown ? "depends on the size of the page, which is not specified; it is ignored"
                      : "is invalid and is ignored");
      continue;
    }
    if (!by_font.empty()) warn(drawn.element, key, text, "depends on the font; " + by_font);
    return length;
  }
  return std::nullopt;
}

// --------------------------------------------------------------------------------------------------- styles

void SvgReader::apply_paint(const Drawn& drawn, std::string_view key, PaintValue& paint) {
  for (const auto& candidate : drawn.properties.candidates(key)) {
    const std::string_view text = candidate.value;
    if (text == "inherit" || text == "unset") return;
    if (text == "initial") {
      paint = key == "stroke" ? PaintValue{} : PaintValue{"#000000", {}, {}, 1.0};
      return;
    }
    if (auto read = read_paint(text)) {
      paint = std::move(*read);
      return;
    }
    warn(drawn.element, key, text, "is no colour; it is ignored");
  }
}

void SvgReader::apply_font_size(const Drawn& drawn, Context& context) {
  static constexpr std::pair<std::string_view, double> kSizes[] = {
      {"xx-small", 9.0}, {"x-small", 10.0}, {"small", 13.0},   {"medium", 16.0},
      {"large", 18.0},   {"x-large", 24.0}, {"xx-large", 32.0}};
  double& em = context.base.em;
  LengthBase base = context.base;
  base.width = base.height = em;  // 100% is the size of the parent
  for (const auto& [text, source] : drawn.properties.candidates("font-size")) {
    const auto named = std::find_if(std::begin(kSizes), std::end(kSizes),
                                    [&word = text](const auto& size) { return size.first == word; });
    const bool takes_numbers = source != Properties::Source::sheet;
    auto size = css_value(text, [&](std::string_view unit) {
      return unit.empty() && !takes_numbers ? std::nullopt
                                            : resolved({1.0, std::string(unit)}, base, Axis::x);
    });
    if (named != std::end(kSizes)) size = named->second;
    if (text == "larger") size = 1.2 * em;
    if (text == "smaller") size = em / 1.2;
    if (text == "inherit" || text == "unset") return;
    if (!size || *size < 0.0) continue;
    em = *size;
    return;
  }
}

void SvgReader::apply_stroke(const Drawn& drawn, Style& style) {
  if (const auto width = length_of(drawn, "stroke-width", Axis::both, Range::positive))
    style.stroke_width = *width;
  const std::string_view ends = drawn.properties.find("stroke-linecap");
  if (ends == "butt") style.ends = dxf::StrokeEnds::butt;
  if (ends == "round") style.ends = dxf::StrokeEnds::round;
  if (ends == "square") style.ends = dxf::StrokeEnds::square;
  const std::string_view corners = drawn.properties.find("stroke-linejoin");
  if (corners == "miter") style.corners = dxf::StrokeCorners::mitre;
  if (corners == "round") style.corners = dxf::StrokeCorners::round;
  if (corners == "bevel") style.corners = dxf::StrokeCorners::bevel;
  if (const auto limit = parse_number(drawn.properties.find("stroke-miterlimit")); limit && *limit >= 1.0)
    style.mitre_limit = *limit;
  if (drawn.properties.find("stroke-width") == "initial") style.stroke_width = 1.0;
  if (const auto offset = length_of(drawn, "stroke-dashoffset", Axis::both)) style.dash_offset = *offset;
  apply_dashes(drawn, style);
}

/// The dashes and gaps; none of a negative length, and not all 0. An odd number counts twice.
void SvgReader::apply_dashes(const Drawn& drawn, Style& style) {
  for (const auto& candidate : drawn.properties.candidates("stroke-dasharray")) {
    const std::string_view text = candidate.value;
    if (text == "inherit" || text == "unset") return;
    std::vector<double> made;
    bool is_valid = true;
    if (text != "none" && text != "initial") {
      for (std::string_view rest = text; !rest.empty() && is_valid;) {
        constexpr std::string_view kBetween = " \t\r\n,";
        rest.remove_prefix(std::min(rest.find_first_not_of(kBetween), rest.size()));
        const std::string_view word = rest.substr(0, rest.find_first_of(kBetween));
        if (word.empty()) break;
        rest.remove_prefix(word.size());
        const auto value = css_value(word, [&](std::string_view unit) {
          return resolved({1.0, std::string(unit)}, drawn.context.base, Axis::both);
        });
        is_valid = value && *value >= 0.0;
        made.push_back(value.value_or(0.0));
      }
    }
    if (!is_valid) {
      warn(drawn.element, "stroke-dasharray", text, "is invalid and is ignored");
      continue;
    }
    if (std::all_of(made.begin(), made.end(), [](double d) { return d == 0.0; })) made.clear();
    const std::size_t count = made.size();
    for (std::size_t i = 0; count % 2 == 1 && i < count; ++i) made.push_back(made[i]);
    style.dashes = std::move(made);
    return;
  }
}

/// The style of an element: what it inherits, replaced by its own properties.
void SvgReader::apply_style(const Drawn& drawn, Context& context) {
  Style& style = context.style;
  context.variables = drawn.properties.variables();
  apply_font_size(drawn, context);
  if (drawn.element.parent == nullptr) context.base.root_em = context.base.em;
  const auto find = [&](std::string_view key) { return drawn.properties.find(key); };
  if (const auto colour = read_colour(find("color"))) style.colour = *colour;
  apply_paint(drawn, "stroke", style.stroke);
  apply_paint(drawn, "fill", style.fill);
  apply_stroke({drawn.element, drawn.properties, context}, style);
  const std::string_view visible = find("visibility"), rule = find("fill-rule");
  if (visible == "visible" || visible == "initial") style.is_hidden = false;
  if (visible == "hidden" || visible == "collapse") style.is_hidden = true;
  if (rule == "evenodd" || rule == "nonzero") style.is_even_odd = rule == "evenodd";
  const std::string_view clip_rule = find("clip-rule");
  if (clip_rule == "evenodd" || clip_rule == "nonzero") style.is_clip_even_odd = clip_rule == "evenodd";
  style.fill_opacity = fraction_of(find("fill-opacity"), style.fill_opacity);
  style.stroke_opacity = fraction_of(find("stroke-opacity"), style.stroke_opacity);
  style.opacity *= fraction_of(find("opacity"), 1.0);
  style.is_shown = find("display") != "none";
  apply_font(drawn, context);
  for (const char* key : {"mask", "filter", "marker", "marker-start", "marker-mid", "marker-end"}) {
    const std::string_view value = find(key);
    if (!value.empty() && value != "none" && value != "inherit")
      note_ignored(drawn.element, fmt::format("{} {}", key, clipped(value, 40)));
  }
}

/// The name of a paint's colour; empty where it paints nothing.
std::string SvgReader::painted(const PaintValue& paint, double opacity, const Style& style) const {
  if (opacity * style.opacity * paint.alpha <= 0.0) return {};
  if (paint.name == "none") return {};
  if (paint.name == "currentcolor") return style.colour.alpha > 0.0 ? name_of(style.colour) : std::string();
  if (paint.name != "url") return paint.name;
  const auto target = by_id_.find(paint.link);
  if (target != by_id_.end() && is_paint_server(target->second->name))
    return is_painting(*target->second) ? "url(#" + paint.link + ")" : std::string();
  const auto fallback = read_paint(paint.fallback);
  return fallback && fallback->name != "url" ? painted(*fallback, opacity, style) : std::string();
}

/// Whether a pattern, or a gradient with stops, its own or those of one that it refers to.
bool SvgReader::is_painting(const Element& server) const {
  constexpr int kLinks = 32;
  const Element* at = &server;
  for (int i = 0; i < kLinks && at != nullptr && at->name != "pattern"; ++i) {
    bool has_stops = false, shows = false;
    for (const Element& child : at->children) {
      if (child.name != "stop") continue;
      has_stops = true;
      const Properties properties = sheet_.properties(child, nullptr);
      const auto colour = read_colour(properties.find("stop-color"));
      shows =
          shows || fraction_of(properties.find("stop-opacity"), 1.0) * (colour ? colour->alpha : 1.0) > 0.0;
    }
    if (has_stops) return shows;
    const std::string_view link = at->has("href") ? at->attribute("href") : at->attribute("xlink:href");
    const auto next = link.starts_with('#') ? by_id_.find(link.substr(1)) : by_id_.end();
    at = next == by_id_.end() ? nullptr : next->second;
  }
  return at != nullptr && at->name == "pattern";
}

/// A pattern as the paint of an element: what it shows is not drawn.
void SvgReader::note_pattern(const Drawn& drawn, std::string_view key, const PaintValue& paint) {
  const auto target = paint.name == "url" ? by_id_.find(paint.link) : by_id_.end();
  if (target == by_id_.end() || target->second->name != "pattern") return;
  note_ignored(drawn.element, fmt::format("{} url(#{})", key, clipped(paint.link, 40)),
               fmt::format("is a pattern, which is not drawn: the whole {} is used", key));
}

/// The box of the properties of transforms: the viewport's, or that of the element (transform-box).
Box SvgReader::reference_box(const Drawn& drawn) {
  const LengthBase& base = drawn.context.base;
  if (drawn.element.parent == nullptr) return {0.0, 0.0, base.page_width, base.page_height};
  const std::string kind = lowered(drawn.properties.find("transform-box"));
  if (kind.empty() || kind == "view-box" || kind == "inherit") return {0.0, 0.0, base.width, base.height};
  if (kind != "fill-box" && kind != "content-box")
    warn(drawn.element, "transform-box", kind, "is not known here; the box of the fill is used");
  return box_of(drawn);
}

/// The transform of an element about its origin: the properties `translate`, `rotate`, `scale` and
/// `transform` in this order, or the attribute.
Affine SvgReader::transform_of(const Drawn& drawn) {
  std::optional<TransformFrame> known;
  const auto frame = [&]() -> const TransformFrame& {
    if (!known) known = TransformFrame{drawn.context.base, reference_box(drawn)};
    return *known;
  };
  Affine made;
  bool is_given = false, is_tilted = false;
  const auto use = [&](std::string_view key, std::string_view text, const std::optional<Affine>& transform) {
    if (!transform) {
      warn(drawn.element, key, text, "is invalid and is ignored");
      return false;
    }
    made = made * *transform;
    return is_given = true;
  };
  for (const std::string_view key : {"translate", "rotate", "scale"})
    for (const auto& [text, source] : drawn.properties.candidates(key))
      if (source != Properties::Source::attribute &&
          use(key, text, read_single_transform(key, text, frame(), is_tilted)))
        break;
  for (const auto& [text, source] : drawn.properties.candidates("transform"))
    if (use("transform", text,
            source == Properties::Source::attribute ? read_transform(text)
                                                    : read_css_transform(text, frame(), is_tilted)))
      break;
  if (!is_given) return {};
  if (is_tilted) note_tilted(drawn.element);
  for (const auto& candidate : drawn.properties.candidates("transform-origin")) {
    TransformFrame about = frame();
    about.takes_numbers = candidate.source == Properties::Source::attribute;
    if (const auto origin = read_origin(candidate.value, about))
      return Affine{1, 0, 0, 1, origin->x, origin->y} * made * Affine{1, 0, 0, 1, -origin->x, -origin->y};
    warn(drawn.element, "transform-origin", candidate.value, "is invalid and is ignored");
  }
  if (drawn.element.parent != nullptr) return made;
  const Vec centre{0.5 * frame().box.width, 0.5 * frame().box.height};
  return Affine{1, 0, 0, 1, centre.x, centre.y} * made * Affine{1, 0, 0, 1, -centre.x, -centre.y};
}

std::uint32_t SvgReader::layer_index(std::string_view name) {
  if (const auto known = dxf::find_layer(drawing_, name)) return *known;
  dxf::Layer& layer = drawing_.layers.emplace_back();
  layer.name = name;
  layer.declared = true;
  return static_cast<std::uint32_t>(drawing_.layers.size() - 1);
}

// ------------------------------------------------------------------------------------------ page, viewports

/// The four numbers of a viewBox; nothing if there is none or, with a warning, an invalid one.
std::optional<std::vector<double>> SvgReader::view_box_of(const Element& element) {
  const std::string_view text = element.attribute("viewBox");
  if (trim(text).empty()) return std::nullopt;
  Numbers box = read_numbers(text);
  if (!box.error_at && box.values.size() == 4 && box.values[2] > 0.0 && box.values[3] > 0.0)
    return std::move(box.values);
  warn(element, "viewBox", text, "is invalid and is ignored");
  return std::nullopt;
}

/// The content of a viewport of this size in `context`, in the coordinates of its viewBox.
Context SvgReader::in_viewport(const Element& element, Context context, double width, double height) {
  const auto box = view_box_of(element);
  if (box)
    context.matrix = context.matrix * fitted(*box, width, height, element.attribute("preserveAspectRatio"));
  context.base.width = box ? (*box)[2] : width;
  context.base.height = box ? (*box)[3] : height;
  return context;
}

/// The transform of the page: with y up, in mm if its size is specified in a unit of length.
void SvgReader::read_page(const Element& root, Context& context) {
  const Properties properties = sheet_.properties(root, nullptr);
  const auto width = read_length(properties.find("width")), height = read_length(properties.find("height"));
  const auto box = view_box_of(root);
  const auto known = width ? mm_per(width->unit) : height ? mm_per(height->unit) : std::nullopt;
  const double per_pixel = known ? *mm_per("in") / *pixels_per("in") : 1.0;  // of the drawing's unit
  const auto pixels = [&](const std::optional<UnitLength>& l) -> std::optional<double> {
    const auto value = l ? resolved(*l, context.base, Axis::x) : std::nullopt;
    return value && *value > 0.0 ? value : std::nullopt;
  };
  auto w = pixels(width), h = pixels(height);
  if (box && !w && h) w = *h * (*box)[2] / (*box)[3];
  if (box && w && !h) h = *w * (*box)[3] / (*box)[2];
  if (box && !w) w = (*box)[2];
  if (box && !h) h = (*box)[3];
  if (known) drawing_.unit = 4;
  pixel_ = per_pixel;
  context.matrix = Affine{per_pixel, 0, 0, -per_pixel, 0, per_pixel * h.value_or(0.0)};
  context.base.page_width = w.value_or(0.0);
  context.base.page_height = h.value_or(0.0);
  context.base.width = context.base.page_width;
  context.base.height = context.base.page_height;
  const Drawn page{root, properties, context};
  apply_style(page, context);
  context.matrix = context.matrix * transform_of(page);
  context = in_viewport(root, context, w.value_or(0.0), h.value_or(0.0));
}

/// An svg element inside of another one, or a symbol; `width` and `height` are those of a `use`.
void SvgReader::nested(const Drawn& drawn, std::optional<double> width, std::optional<double> height,
                       std::size_t depth) {
  const Element& element = drawn.element;
  const LengthBase& base = drawn.context.base;
  if (!width) width = length_of(drawn, "width", Axis::x);
  if (!height) height = length_of(drawn, "height", Axis::y);
  const double w = width.value_or(base.width), h = height.value_or(base.height);
  if ((width && w <= 0.0) || (height && h <= 0.0)) return;
  const Affine shift{
      1, 0, 0, 1, length_of(drawn, "x", Axis::x).value_or(0.0), length_of(drawn, "y", Axis::y).value_or(0.0)};
  Context frame = drawn.context;
  frame.matrix = frame.matrix * shift;
  const std::string_view overflow = drawn.properties.find("overflow");
  const bool is_open = overflow == "visible" || overflow == "auto" || !(w > 0.0 && h > 0.0);
  if (!is_open) frame.clip = clip_to_viewport(frame, w, h);
  children(element, in_viewport(element, frame, w, h), depth);
}

// ------------------------------------------------------------------------------------------------- elements

void SvgReader::index(const Element& element) {
  ++elements_in_file_;
  if (const auto id = element.attribute("id"); !id.empty()) by_id_.emplace(id, &element);
  if (element.name == "style") sheet_.read(element.text);
  unknown_rules_.resize(sheet_.unknown().size(), &element);
  for (const Element& child : element.children) index(child);
}

void SvgReader::children(const Element& element, const Context& context, std::size_t depth) {
  for (const Element& child : element.children) visit(child, context, depth + 1);
}

/// What a `use` refers to; nothing, with a warning, if it cannot be drawn.
const Element* SvgReader::target_of(const Element& use) {
  std::string_view link = use.has("href") ? use.attribute("href") : use.attribute("xlink:href");
  link = trim(link);
  const auto refuse = [&](const std::string& what) {
    diagnostics_.warning(codes::svg_reference, location(use), "use: " + what);
    return nullptr;
  };
  const std::string shown = clipped(link, 60);
  if (!link.empty() && link[0] != '#')
    return refuse(fmt::format("\"{}\" is in another file, which is not read", shown));
  const auto found = link.empty() ? by_id_.end() : by_id_.find(link.substr(1));
  if (found == by_id_.end()) return refuse(fmt::format("there is no element \"{}\"", shown));
  const Element* target = found->second;
  bool is_own = std::find(open_uses_.begin(), open_uses_.end(), target) != open_uses_.end();
  for (const Element* e = &use; e != nullptr; e = e->parent) is_own = is_own || e == target;
  if (is_own) return refuse(fmt::format("\"{}\" contains this element itself", shown));
  if (target->name != "symbol" && is_undrawn(target->name))
    return refuse(fmt::format("\"{}\" is a {}, which is not drawn", shown, target->name));
  return target;
}

void SvgReader::visit_use(const Drawn& drawn, std::size_t depth) {
  const Element* target = target_of(drawn.element);
  if (target == nullptr) return;
  Context context = drawn.context;
  context.matrix = context.matrix * Affine{1,
                                           0,
                                           0,
                                           1,
                                           length_of(drawn, "x", Axis::x).value_or(0.0),
                                           length_of(drawn, "y", Axis::y).value_or(0.0)};
  open_uses_.push_back(target);
  if (target->name == "symbol" || target->name == "svg") {
    if (within_limits(*target, depth + 1)) {
      const Properties properties = sheet_.properties(*target, context.variables);
      depth_ = depth + 1;
      if (const auto inner = entered(*target, properties, context))
        nested({*target, properties, *inner}, length_of(drawn, "width", Axis::x),
               length_of(drawn, "height", Axis::y), depth + 1);
    }
  } else {
    visit(*target, context, depth + 1);
  }
  open_uses_.pop_back();
}

/// The context inside of an element, with its style and transform; nothing if it is not drawn.
std::optional<Context> SvgReader::entered(const Element& element, const Properties& properties,
                                          Context context) {
  const Context outside = context;
  apply_style({element, properties, outside}, context);
  if (!context.style.is_shown) return std::nullopt;
  context.matrix = context.matrix * transform_of({element, properties, context});
  const Affine& m = context.matrix;
  if (m.a * m.d - m.b * m.c == 0.0) return std::nullopt;
  apply_clip({element, properties, outside}, context);
  return context;
}

void SvgReader::visit(const Element& element, const Context& outside, std::size_t depth) {
  if (is_undrawn(element.name) || element.name.find(':') != std::string::npos) return;
  if (pace_.stops(elements_, elements_in_file_)) return;
  if (!within_limits(element, depth) || !passes_conditions(element)) return;
  const Properties properties = sheet_.properties(element, outside.variables);
  depth_ = depth;
  if (const auto context = entered(element, properties, outside))
    draw_content({element, properties, *context}, depth);
}

/// What is inside of an element, in its own coordinates.
void SvgReader::draw_content(const Drawn& drawn, std::size_t depth) {
  const Element& element = drawn.element;
  if (element.name == "g" || element.name == "a") {
    Context inside = drawn.context;
    if (element.attribute("inkscape:groupmode") == "layer") {
      const auto label = element.attribute("inkscape:label");
      inside.layer = label.empty() ? element.attribute("id") : label;
    }
    return children(element, inside, depth);
  }
  if (element.name == "switch") {
    for (const Element& child : element.children)
      if (child.name.find(':') == std::string::npos && passes_conditions(child))
        return visit(child, drawn.context, depth + 1);
    return;
  }
  if (element.name == "use") return visit_use(drawn, depth);
  if (element.name == "svg") return nested(drawn, {}, {}, depth);
  if (element.name == "text") return draw_text(drawn, depth);
  const EntityWriter::Setting setting = setting_of(drawn);
  writer_.set(setting);
  const std::size_t first = drawing_.entities.size();
  if (!draw(drawn)) count_other(drawn, setting);
  segments_ += drawing_.entities.size() - first;
}

/// Layer, paint and position of the entities of an element.
EntityWriter::Setting SvgReader::setting_of(const Drawn& drawn) {
  const Style& style = drawn.context.style;
  const Affine& m = drawn.context.matrix;
  const bool is_in_clip = drawn.context.is_in_clip;
  std::string stroke, fill;
  if (style.stroke_width > 0.0 && !is_in_clip) stroke = painted(style.stroke, style.stroke_opacity, style);
  if (is_in_clip)
    fill = "clip";
  else if (drawn.element.name != "line")
    fill = painted(style.fill, style.fill_opacity, style);
  const bool is_painted = !stroke.empty() || !fill.empty();
  if (!fill.empty() && !is_in_clip && !style.is_hidden) note_pattern(drawn, "fill", style.fill);
  if (!stroke.empty() && !style.is_hidden) note_pattern(drawn, "stroke", style.stroke);
  dxf::Paint& paint = drawing_.paints.emplace_back();
  const std::string_view id = drawn.element.attribute("id");
  paint.element = drawn.element.name + (id.empty() ? "" : " ") + clipped(id, 40);
  paint.line = static_cast<std::uint32_t>(drawn.element.line);
  paint.column = static_cast<std::uint32_t>(drawn.element.column);
  paint.filled = !fill.empty();
  paint.even_odd = is_in_clip ? style.is_clip_even_odd : style.is_even_odd;
  paint.clip = drawn.context.clip;
  paint.stroked = !stroke.empty();
  const bool is_fixed = lowered(drawn.properties.find("vector-effect")) == "non-scaling-stroke";
  paint.frame = is_fixed ? std::array{pixel_, 0.0, 0.0, -pixel_} : std::array{m.a, m.b, m.c, m.d};
  paint.uneven = !is_fixed && !is_even(m);
  paint.width = style.stroke_width;
  paint.dashes = style.dashes;
  paint.dash_offset = style.dash_offset;
  if (const auto length = parse_number(drawn.element.attribute("pathLength")); length && *length > 0.0)
    paint.path_length = *length;
  paint.ends = style.ends;
  paint.corners = style.corners;
  paint.mitre_limit = style.mitre_limit;
  std::string layer = drawn.context.layer;
  if (layer.empty()) layer = !stroke.empty() ? stroke : !fill.empty() ? fill : "none";
  return {m,
          is_in_clip ? dxf::kLayerZero : layer_index(layer),
          drawn.element.line,
          style.is_hidden || !is_painted,
          static_cast<std::uint32_t>(drawing_.paints.size() - 1),
          paint.filled && !paint.stroked,
          paint.stroked && !style.dashes.empty(),
          paint.stroked && style.ends != dxf::StrokeEnds::butt};
}

/// Images and the like, without their shape.
void SvgReader::count_other(const Drawn& drawn, const EntityWriter::Setting& setting) {
  const std::string& name = drawn.element.name;
  auto type = std::find_if(drawing_.others.begin(), drawing_.others.end(),
                           [&](const dxf::OtherType& t) { return t.name == name; });
  if (type == drawing_.others.end()) type = drawing_.others.insert(type, {name, 0, drawn.element.line});
  ++type->count;
  dxf::Entity& entity = drawing_.entities.emplace_back();
  entity.layer = setting.layer;
  entity.position = setting.line;
  entity.hidden = setting.is_hidden;
  entity.paint = setting.paint;
  entity.shape = dxf::Other{static_cast<std::uint32_t>(type - drawing_.others.begin())};
}

std::optional<dxf::Drawing> SvgReader::read(const Element& root, const std::vector<Element>& sheets) {
  drawing_.format = dxf::Format::svg;
  drawing_.layers.emplace_back().name = "0";
  for (const char* name : {"BYLAYER", "BYBLOCK", "CONTINUOUS"}) drawing_.linetypes.emplace_back().name = name;
  drawing_.extrusions.push_back({0.0, 0.0, 1.0});
  drawing_.paints.emplace_back();
  drawing_.clips.emplace_back();
  for (const Element& sheet : sheets)
    diagnostics_.warning(
        codes::svg_ignored, location(sheet),
        fmt::format("the style sheet of <?xml-stylesheet {}?> is in another file, which is not "
                    "read",
                    clipped(sheet.text, 60)));
  index(root);
  Context page;
  read_page(root, page);
  if (page.style.is_shown) children(root, page, 0);
  if (pace_.asks()) return std::nullopt;
  report_ignored();
  if (is_over_limit_) return std::nullopt;
  return std::move(drawing_);
}

}  // namespace svg

std::optional<dxf::Drawing> read_svg(std::string_view bytes, const std::string& file_name,
                                     const SvgOptions& options, Diagnostics& diagnostics) {
  constexpr double kTreePart = 0.5;  // of the time: reading the XML
  std::vector<svg::Element> sheets;
  Pace pace(options.progress, "reading the drawing");
  pace.part(0.0, kTreePart);
  const auto root = svg::read_tree(bytes, {file_name, options.max_depth}, sheets, pace, diagnostics);
  if (!root) return std::nullopt;
  if (root->name != "svg") {
    diagnostics.error(codes::svg_xml, TextLocation{file_name, static_cast<std::uint32_t>(root->line), 1},
                      fmt::format("the root element is {}, expected svg", root->name));
    return std::nullopt;
  }
  pace.part(kTreePart, 1.0);
  return svg::SvgReader(file_name, options, pace, diagnostics).read(*root, sheets);
}

#else

std::optional<dxf::Drawing> read_svg(std::string_view, const std::string& file_name, const SvgOptions&,
                                     Diagnostics& diagnostics) {
  diagnostics.error(codes::svg_xml, TextLocation{file_name, 0, 0}, "SVG cannot be read by this build");
  return std::nullopt;
}

#endif

}  // namespace kerf
