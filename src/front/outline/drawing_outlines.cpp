// Outlines from a drawing: selects entities by layer, converts and joins them, and reports open ends.
#include "kerf/drawing/drawing_outlines.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "base/codes/outline.h"
#include "base/names.h"
#include "base/number.h"
#include "base/pace.h"
#include "front/outline/clips.h"
#include "front/outline/drawing_texts.h"
#include "front/outline/entity_shapes.h"
#include "front/outline/stroke_area.h"

#include "kerf/drawing/svg.h"

namespace kerf {
namespace {

using outline_front::FlatShape;
using outline_front::ShapeConverter;

constexpr double kSmallGap = 1.0;  // mm; smaller gaps have a hint

std::string position_text(Point2 p) { return number_text(p.x, 4) + ", " + number_text(p.y, 4); }

/// The shapes of one layer, and the entities that they are from.
struct LayerShapes {
  std::vector<Outline> outlines;
  std::vector<std::string> names;
  std::vector<std::uint64_t> handles;
  std::vector<std::optional<Circle>> circles;
  std::vector<OutlineFill> fills;
  std::vector<std::uint32_t> paints;   // dxf::Entity::paint
  std::vector<std::uint32_t> strokes;  // index into OutlineDrawer::strokes_; 0: none
  std::uint32_t chain = 0;             // dxf::Entity::chain of the last one

  /// Moves a shape of another layer's here.
  void take(LayerShapes& from, std::size_t i) {
    outlines.push_back(std::move(from.outlines[i]));
    names.push_back(std::move(from.names[i]));
    handles.push_back(from.handles[i]);
    circles.push_back(from.circles[i]);
    fills.push_back(from.fills[i]);
    paints.push_back(from.paints[i]);
    strokes.push_back(from.strokes[i]);
  }
  void append(Outline outline, std::string name, std::uint64_t handle, OutlineFill fill, std::uint32_t paint,
              std::uint32_t stroke = 0) {
    outlines.push_back(std::move(outline));
    names.push_back(std::move(name));
    handles.push_back(handle);
    circles.emplace_back();
    fills.push_back(fill);
    paints.push_back(paint);
    strokes.push_back(stroke);
  }
};

/// Whether an outline goes back and forth along one line: as a fill it shows nothing.
bool is_flat(const Outline& outline, double weld) {
  double far = 0.0;
  Point2 along{};
  for (const Segment& s : outline.segments) {
    if (s.via) return false;
    if (const double d = distance(outline.start, s.to); d > far) {
      far = d;
      along = (1.0 / d) * (s.to - outline.start);
    }
  }
  return std::all_of(outline.segments.begin(), outline.segments.end(),
                     [&](const Segment& s) { return std::abs(cross(along, s.to - outline.start)) <= weld; });
}

/// Appends the next piece of a path to the last shape of the layer.
void append_piece(LayerShapes& shapes, const Outline& piece) {
  Outline& path = shapes.outlines.back();
  path.segments.insert(path.segments.end(), piece.segments.begin(), piece.segments.end());
  shapes.circles.back().reset();
}

class OutlineDrawer {
 public:
  OutlineDrawer(const dxf::Drawing& drawing, const DrawingOutlineOptions& options, Diagnostics& diagnostics)
      : drawing_(drawing), options_(options), diagnostics_(diagnostics), pace_(options.progress) {}
  std::optional<DrawingOutlines> draw();

 private:
  Origin file() const { return dxf::origin_of(drawing_); }
  RegionOptions region_options() const {
    RegionOptions how;
    how.tolerance = options_.tolerance;
    how.progress = options_.progress;
    return how;
  }
  std::optional<double> mm_per_unit();
  bool choose_layers(const std::vector<std::string>& names, std::vector<bool>& chosen);
  bool collect();
  void take(const dxf::Placed& placed, ShapeConverter& maker, outline_front::TextDrawer& texts);
  template <class Text>
  void take_text(const dxf::Placed& placed, const Text& text, outline_front::TextDrawer& drawer);
  struct Ignored {
    std::size_t count = 0;
    std::string first, layer;
    Origin where;
  };
  void ignore(const dxf::Placed& placed);
  void count(Ignored& ignored, const dxf::Placed& placed);
  void take_dot(const dxf::Placed& placed, const dxf::Dot& dot, const ShapeConverter& maker);
  void leave_out_islands(const dxf::Hatch& hatch, std::vector<FlatShape>& loops);
  void add(const dxf::Placed& placed, FlatShape shape, OutlineFill fill, const ShapeConverter& maker);
  OutlineFill fill_of(const dxf::Entity& entity) const;
  bool has_areas(const dxf::Placed& placed) const;
  std::uint32_t stroke_of(const dxf::Placed& placed);
  void scale_dashes(const LayerShapes& shapes);
  void fill_strokes(LayerShapes& shapes);
  void clip(LayerShapes& shapes, outline_front::Clips& clips);
  void arrange(LayerShapes& shapes, std::uint32_t layer);
  void join(std::uint32_t layer, const LayerShapes& shapes);
  void report(std::uint32_t layer, const LayerShapes& shapes, const Chained& chained);
  void report_ignored();
  void append_texts(std::uint32_t layer, LayerShapes& shapes);
  Origin location(std::uint32_t layer, const LayerShapes& shapes, std::uint32_t shape, Point2 at) const {
    if (const std::uint32_t paint = shapes.paints[shape]; paint != 0)
      return outline_front::element_origin(drawing_, paint);
    return dxf::origin_at(drawing_, layer, shapes.handles[shape], at.x, at.y);
  }

  const dxf::Drawing& drawing_;
  const DrawingOutlineOptions& options_;
  Diagnostics& diagnostics_;
  Pace pace_;
  std::vector<bool> chosen_;  // by layer; empty: all visible ones
  std::vector<bool> areal_;   // by layer: strokes are areas; empty: none
  std::map<std::uint32_t, LayerShapes> shapes_, texts_;
  std::map<std::string, Ignored> ignored_;
  std::vector<std::size_t> hidden_;  // entities by layer
  std::vector<outline_front::Stroke> strokes_;
  Ignored whole_, dots_;  // dashed strokes as lines, and their dots
  std::size_t wide_ = 0, segments_ = 0;
  std::size_t cut_ = 0;  // by clips
  std::pair<std::string, std::uint32_t> first_cut_;
  std::size_t areas_ = 0;  // figures besides those of drawing_.paints
  Diagnostics damaged_;    // what is wrong with single entities, which are left out
  DrawingOutlines made_;
};

/// The given unit, else that of the drawing; an error if there is none.
std::optional<double> OutlineDrawer::mm_per_unit() {
  const int number = drawing_.unit.value_or(0);
  const auto own = dxf::mm_per_unit(number);
  if (options_.unit) {
    if (own && *own != options_.unit->mm())
      diagnostics_.warning(codes::drawing_unit, file(),
                           fmt::format("the drawing specifies {}; read with {:g} mm as requested",
                                       dxf::unit_name(number), options_.unit->mm()));
    return options_.unit->mm();
  }
  if (own) return own;
  const bool is_page = drawing_.format == dxf::Format::svg;
  const std::string what = is_page       ? "the drawing does not specify its unit (width without mm or in)"
                           : number == 0 ? "the drawing does not specify its unit ($INSUNITS)"
                                         : fmt::format("unknown unit {} ($INSUNITS)", number);
  diagnostics_.error(codes::drawing_unit, file(), what).hint =
      is_page ? "specify it: mm, inch, px (96 per inch) or pt (72 per inch), as in --unit px"
              : "specify it: mm or inch (--unit mm, --unit inch)";
  return std::nullopt;
}

/// Marks the layers of these names.
bool OutlineDrawer::choose_layers(const std::vector<std::string>& names, std::vector<bool>& chosen) {
  if (names.empty()) return true;
  chosen.assign(drawing_.layers.size(), false);
  std::vector<std::string> known;
  for (const dxf::Layer& layer : drawing_.layers) known.push_back(layer.name);
  bool all = true;
  for (const std::string& name : names) {
    auto index = dxf::find_layer(drawing_, name);
    if (!index) index = dxf::find_layer(drawing_, colour_layer(name));
    if (index) {
      chosen[*index] = true;
      continue;
    }
    all = false;
    Diagnostic& error = diagnostics_.error(codes::drawing_layer, file(),
                                           fmt::format("the drawing has no layer \"{}\"", name));
    constexpr std::size_t kListed = 20;
    if (const auto meant = did_you_mean(name, known))
      error.hint = fmt::format("did you mean \"{}\"?", *meant);
    else
      error.hint =
          "layers: " + joined(std::vector(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                             known.size(), kListed))),
                              ", ");
  }
  return all;
}

/// Removes the loops of a hatch that its style of islands does not use.
void OutlineDrawer::leave_out_islands(const dxf::Hatch& hatch, std::vector<FlatShape>& loops) {
  const std::uint32_t deepest = hatch.islands == dxf::Hatch::Islands::outer ? 1 : 0;
  if (hatch.islands == dxf::Hatch::Islands::alternate || loops.size() < 2) return;
  std::vector<Outline> outlines;
  for (const FlatShape& loop : loops) outlines.push_back(loop.outline);
  RegionOptions options = region_options();
  const auto region = make_region(outlines, FillRule::even_odd, options, damaged_);
  if (!region) return;
  const Nesting nest = nesting(*region);
  std::vector<FlatShape> kept;
  for (std::size_t i = 0; i < region->loops.size(); ++i) {
    if (nest.depths[i] > deepest) continue;
    FlatShape& loop = kept.emplace_back();
    loop.outline = region->loops[i];
    loop.tilted = loops.front().tilted;
  }
  loops = std::move(kept);
}

/// Counts an entity that is no outline, by its type.
void OutlineDrawer::ignore(const dxf::Placed& placed) {
  count(ignored_[std::string(dxf::type_name(drawing_, placed.entity))], placed);
}

void OutlineDrawer::count(Ignored& ignored, const dxf::Placed& placed) {
  if (ignored.count++ > 0) return;
  ignored.first = outline_front::entity_name(drawing_, placed.entity);
  ignored.layer = drawing_.layers[placed.style.layer].name;
  ignored.where = placed.entity.paint != 0 ? outline_front::element_origin(drawing_, placed.entity.paint)
                                           : dxf::origin_of(drawing_, placed.entity);
}

/// The outlines of a text; templates of attributes are not drawn.
template <class Text>
void OutlineDrawer::take_text(const dxf::Placed& placed, const Text& text,
                              outline_front::TextDrawer& drawer) {
  bool is_drawn = options_.texts != "none";
  Point2 at{};
  if constexpr (std::is_same_v<Text, dxf::Text>) {
    is_drawn = is_drawn && text.kind != dxf::TextKind::attribute_definition;
    const dxf::Point p = placed.matrix * dxf::anchor(text);
    at = {made_.unit.mm() * p.x, made_.unit.mm() * p.y};
  }
  if (!is_drawn) return ignore(placed);
  const std::uint32_t paint = placed.entity.paint;
  const Origin where = paint != 0
                           ? outline_front::element_origin(drawing_, paint)
                           : dxf::origin_at(drawing_, placed.style.layer, placed.entity.handle, at.x, at.y);
  const std::string name = outline_front::entity_name(drawing_, placed.entity);
  auto made = drawer.make(placed, text, where, name);
  if (!made) return;
  OutlineFill fill;
  if (made->is_area && paint == 0)
    fill = {static_cast<std::uint32_t>(drawing_.paints.size() + ++areas_), FillRule::nonzero};
  else if (made->is_area && drawing_.paints[paint].filled)
    fill = {paint, FillRule::nonzero};
  const std::uint32_t stroke = stroke_of(placed);
  LayerShapes& shapes = texts_[placed.style.layer];
  for (Outline& outline : made->outlines) {
    segments_ += outline.segments.size();
    shapes.append(std::move(outline), name, placed.entity.handle, fill, paint, stroke);
  }
}

/// A point, or the dot of a stroke without a length.
void OutlineDrawer::take_dot(const dxf::Placed& placed, const dxf::Dot& dot, const ShapeConverter& maker) {
  const Point2 at = maker.flat(placed.matrix * dot.at);
  const dxf::Entity& entity = placed.entity;
  if (entity.paint == 0) {
    made_.points.push_back({at, drawing_.layers[placed.style.layer].name, dxf::handle_text(entity.handle)});
  } else if (const std::uint32_t stroke = stroke_of(placed); stroke != 0) {
    shapes_[placed.style.layer].append(Outline{at, {}}, outline_front::entity_name(drawing_, entity),
                                       entity.handle, {}, entity.paint, stroke);
  } else {
    count(dots_, placed);
  }
}

void OutlineDrawer::take(const dxf::Placed& placed, ShapeConverter& maker, outline_front::TextDrawer& texts) {
  const bool chosen =
      chosen_.empty() ? placed.style.visible : chosen_[placed.style.layer] && !placed.entity.hidden;
  if (!chosen) {
    if (chosen_.empty()) ++hidden_[placed.style.layer];
    return;
  }
  if (segments_ > options_.max_segments) return;
  if (const auto* dot = std::get_if<dxf::Dot>(&placed.entity.shape)) return take_dot(placed, *dot, maker);
  if (const auto* hatch = std::get_if<dxf::Boxed<dxf::Hatch>>(&placed.entity.shape)) {
    const OutlineFill fill{static_cast<std::uint32_t>(drawing_.paints.size() + ++areas_), FillRule::even_odd};
    std::vector<FlatShape> loops = maker.make_hatch(placed, **hatch);
    leave_out_islands(**hatch, loops);
    for (FlatShape& loop : loops) add(placed, std::move(loop), fill, maker);
    return;
  }
  if (const auto* text = std::get_if<dxf::Boxed<dxf::Text>>(&placed.entity.shape))
    return take_text(placed, **text, texts);
  if (const auto* part = std::get_if<dxf::TextPart>(&placed.entity.shape))
    return take_text(placed, *part, texts);
  const std::size_t before = damaged_.errors();
  auto shape = maker.make(placed);
  if (shape)
    add(placed, std::move(*shape), fill_of(placed.entity), maker);
  else if (damaged_.errors() == before)
    ignore(placed);
}

/// Appends a shape to its layer.
void OutlineDrawer::add(const dxf::Placed& placed, FlatShape shape, OutlineFill fill,
                        const ShapeConverter& maker) {
  std::string name = outline_front::entity_name(drawing_, placed.entity);
  if (shape.tilted)
    diagnostics_.warning(codes::drawing_tilted, maker.location(placed, shape.outline.start),
                         fmt::format("{} is not parallel to XY; its projection is used", name));
  const auto is_point = [&](const Segment& s) { return !s.via && s.to == shape.outline.start; };
  const std::vector<Segment>& segments = shape.outline.segments;
  const bool is_idle = shape.circle ? !(shape.circle->radius > Length())
                                    : std::all_of(segments.begin(), segments.end(), is_point);
  if (is_idle && placed.entity.handle != 0) {
    diagnostics_.warning(codes::drawing_ignored, maker.location(placed, shape.outline.start),
                         fmt::format("{} has no length; it is left out", name));
    return;
  }
  const auto* line = std::get_if<dxf::Boxed<dxf::Polyline>>(&placed.entity.shape);
  if (line != nullptr && !(*line)->widths.empty()) ++wide_;
  if (placed.entity.paint != 0 && !has_areas(placed) && !drawing_.paints[placed.entity.paint].dashes.empty())
    count(whole_, placed);
  segments_ += shape.outline.segments.size();
  LayerShapes& shapes = shapes_[placed.style.layer];
  const std::uint32_t chain = placed.entity.chain;
  if (chain != 0 && chain == std::exchange(shapes.chain, chain)) return append_piece(shapes, shape.outline);
  shapes.chain = chain;
  shapes.append(std::move(shape.outline), std::move(name), placed.entity.handle, fill, placed.entity.paint,
                stroke_of(placed));
  shapes.circles.back() = shape.circle;
}

bool OutlineDrawer::collect() {
  hidden_.assign(drawing_.layers.size(), 0);
  ShapeConverter maker(drawing_, made_.unit.mm(), options_, damaged_);
  outline_front::TextDrawer texts(drawing_, made_.unit.mm(), options_, damaged_);
  dxf::VisitOptions visit = options_.visit;
  visit.progress = options_.progress;
  if (visit.progress != nullptr) visit.progress->phase("making outlines");
  const bool all = dxf::for_each_placed(drawing_, visit, diagnostics_,
                                        [&](const dxf::Placed& placed) { take(placed, maker, texts); });
  texts.report();
  for (Diagnostic d : damaged_.list()) {
    if (d.severity == Severity::error) d.severity = Severity::warning;
    diagnostics_.add(std::move(d));
  }
  if (segments_ <= options_.max_segments) return all;
  diagnostics_
      .error(codes::drawing_limit, file(),
             fmt::format("the outlines have more than {} segments", options_.max_segments))
      .hint = "increase the tolerance of curves, or choose fewer layers";
  return false;
}

OutlineFill OutlineDrawer::fill_of(const dxf::Entity& entity) const {
  if (entity.paint == 0 || !drawing_.paints[entity.paint].filled) return {};
  return {entity.paint, drawing_.paints[entity.paint].even_odd ? FillRule::even_odd : FillRule::nonzero};
}

/// Whether the stroke of an entity is an area, by the options or by its layer.
bool OutlineDrawer::has_areas(const dxf::Placed& placed) const {
  return options_.strokes == StrokeShapes::areas || (!areal_.empty() && areal_[placed.style.layer]);
}

/// The index of the stroke of an entity; 0 if it has none, or strokes are lines.
std::uint32_t OutlineDrawer::stroke_of(const dxf::Placed& placed) {
  if (!has_areas(placed)) return 0;
  const double scale = made_.unit.mm();
  const dxf::Matrix& m = placed.matrix;
  outline_front::Stroke stroke;
  if (placed.entity.paint != 0) {
    const dxf::Paint& paint = drawing_.paints[placed.entity.paint];
    if (!paint.stroked) return 0;
    stroke = outline_front::stroke_of(paint, scale);
  } else {
    const auto* line = std::get_if<dxf::Boxed<dxf::Polyline>>(&placed.entity.shape);
    if (line == nullptr || (*line)->widths.empty()) return 0;
    const double width = (*line)->widths.front()[0];
    const bool is_constant = std::all_of((*line)->widths.begin(), (*line)->widths.end(),
                                         [&](const auto& w) { return w[0] == width && w[1] == width; });
    const double size = std::sqrt(std::abs(m.m[0][0] * m.m[1][1] - m.m[0][1] * m.m[1][0]));
    if (!is_constant || !(width > 0.0)) return 0;
    --wide_;
    stroke.width = scale * size * width;
  }
  if (!(stroke.width > options_.tolerance.weld.mm())) return 0;
  strokes_.push_back(stroke);
  return static_cast<std::uint32_t>(strokes_.size());
}

/// Scales the dashes of paths that specify their length (pathLength).
void OutlineDrawer::scale_dashes(const LayerShapes& shapes) {
  const auto counts = [&](std::size_t i) {
    return shapes.strokes[i] != 0 && strokes_[shapes.strokes[i] - 1].path_length > 0.0;
  };
  std::map<std::uint32_t, double> lengths;  // by paint
  for (std::size_t i = 0; i < shapes.outlines.size(); ++i)
    if (counts(i))
      lengths[shapes.paints[i]] +=
          outline_front::stroke_length(shapes.outlines[i], strokes_[shapes.strokes[i] - 1], options_.within);
  for (std::size_t i = 0; i < shapes.outlines.size(); ++i) {
    if (!counts(i)) continue;
    outline_front::Stroke& stroke = strokes_[shapes.strokes[i] - 1];
    const double factor = lengths[shapes.paints[i]] / std::exchange(stroke.path_length, 0.0);
    for (double& dash : stroke.dashes) dash *= factor;
    stroke.dash_offset *= factor;
  }
}

/// Replaces outlines with a stroke by the edges of its area, united with the fill of the element.
void OutlineDrawer::fill_strokes(LayerShapes& shapes) {
  scale_dashes(shapes);
  LayerShapes made;
  for (std::size_t i = 0; i < shapes.outlines.size();) {
    std::size_t end = i + 1;
    const std::uint32_t figure = shapes.fills[i].figure;
    while (figure != 0 && end < shapes.outlines.size() && shapes.fills[end].figure == figure) ++end;
    std::vector<PaintedOutline> fill;
    std::vector<Region> parts;
    if (pace_.stops_at(i, shapes.outlines.size())) return;
    RegionOptions how = region_options();
    how.name = shapes.names[i];
    for (std::size_t k = i; k < end; ++k) {
      if (figure != 0) fill.push_back({shapes.outlines[k], shapes.fills[k]});
      if (shapes.strokes[k] == 0) continue;
      auto stroke =
          outline_front::stroke_area(shapes.outlines[k], strokes_[shapes.strokes[k] - 1], how, diagnostics_);
      if (stroke) parts.push_back(std::move(*stroke));
    }
    if (parts.empty()) {
      for (std::size_t k = i; k < end; ++k) made.take(shapes, k);
    } else {
      if (auto region =
              fill.empty() ? std::nullopt : painted_region(fill, Combining::drawn, how, diagnostics_))
        parts.push_back(std::move(*region));
      const auto region = unite(parts, how, diagnostics_);
      const OutlineFill area{static_cast<std::uint32_t>(drawing_.paints.size() + ++areas_),
                             FillRule::nonzero};
      for (std::size_t k = 0; region && k < region->loops.size(); ++k)
        made.append(region->loops[k], shapes.names[i], shapes.handles[i], area, shapes.paints[i]);
    }
    i = end;
  }
  shapes = std::move(made);
}

/// Replaces outlines that a clip cuts by what it leaves of them.
void OutlineDrawer::clip(LayerShapes& shapes, outline_front::Clips& clips) {
  LayerShapes made;
  for (std::size_t i = 0; i < shapes.outlines.size();) {
    if (pace_.stops_at(i, shapes.outlines.size())) return;
    const std::uint32_t paint = shapes.paints[i], figure = shapes.fills[i].figure;
    std::size_t end = i + 1;
    while (figure != 0 && end < shapes.outlines.size() && shapes.fills[end].figure == figure) ++end;
    const std::uint32_t by = drawing_.paints.empty() ? 0 : drawing_.paints[paint].clip;
    bool is_whole = true, is_line = true;  // a line has no area, whatever its fill is
    std::vector<PaintedOutline> painted;
    for (std::size_t k = i; k < end; ++k) {
      is_whole = is_whole && (by == 0 || clips.holds(by, shapes.outlines[k]));
      is_line = is_line && (figure == 0 || is_flat(shapes.outlines[k], options_.tolerance.weld.mm()));
      painted.push_back({shapes.outlines[k], shapes.fills[k]});
    }
    std::vector<Outline> left;
    if (!is_whole && cut_++ == 0) first_cut_ = {shapes.names[i], paint};
    if (!is_whole && !is_line) {
      if (auto area = clips.area(by, painted)) left = std::move(area->loops);
    } else if (!is_whole) {
      for (std::size_t k = i; k < end; ++k)
        if (auto pieces = clips.pieces(by, shapes.outlines[k]))
          std::move(pieces->begin(), pieces->end(), std::back_inserter(left));
    }
    for (std::size_t k = i; k < end && is_whole; ++k) made.take(shapes, k);
    for (Outline& outline : left)
      made.append(std::move(outline), shapes.names[i], shapes.handles[i], shapes.fills[i], paint);
    i = end;
  }
  shapes = std::move(made);
}

/// Removes what shows nothing, the fills of lines, and moves hatches to the front: outlines that lie on the
/// edges of a hatch are its boundary drawn a second time.
void OutlineDrawer::arrange(LayerShapes& shapes, std::uint32_t layer) {
  LayerShapes kept;
  const auto keep = [&](std::size_t i) { kept.take(shapes, i); };
  const auto is_hatch = [&](std::size_t i) {
    return shapes.fills[i].figure != 0 && shapes.fills[i].figure >= drawing_.paints.size();
  };
  for (std::size_t i = 0; i < shapes.outlines.size(); ++i)
    if (is_hatch(i)) keep(i);
  for (std::size_t i = 0; i < shapes.fills.size(); ++i) {
    if (is_hatch(i)) continue;
    const std::uint32_t paint = shapes.fills[i].figure;
    const bool is_fill_only = paint != 0 && !drawing_.paints[paint].stroked;
    if (!is_fill_only || !is_flat(shapes.outlines[i], options_.tolerance.weld.mm()))
      keep(i);
    else if (chosen_.empty())
      ++hidden_[layer];
  }
  shapes = std::move(kept);
}

void OutlineDrawer::join(std::uint32_t layer, const LayerShapes& shapes) {
  ChainOptions how;
  how.join = options_.join;
  how.tolerance = options_.tolerance;
  Chained chained = chain(shapes.outlines, how);
  const std::string& name = drawing_.layers[layer].name;
  std::size_t number = 0;
  for (ChainedOutline& outline : chained.outlines) {
    const std::uint32_t first = outline.parts.front().piece;
    DrawnOutline drawn;
    drawn.name = fmt::format("{}.{}", name, ++number);
    drawn.layer = name;
    drawn.where = location(layer, shapes, first, outline.outline.start);
    drawn.circle = outline.parts.size() == 1
                       ? shapes.circles[first]
                       : outline_front::whole_circle(outline.outline, options_.tolerance.weld.mm());
    for (const ChainPart& part : outline.parts)
      drawn.handles.push_back(dxf::handle_text(shapes.handles[part.piece]));
    drawn.outline = std::move(outline.outline);
    if (outline.parts.size() == 1) drawn.fill = shapes.fills[first];
    made_.outlines.push_back(std::move(drawn));
  }
  report(layer, shapes, chained);
}

/// The outlines of texts follow the others of their layer; they are not joined with anything.
void OutlineDrawer::append_texts(std::uint32_t layer, LayerShapes& shapes) {
  if (shapes.outlines.empty()) return;
  const std::string& name = drawing_.layers[layer].name;
  auto number = static_cast<std::size_t>(std::count_if(
      made_.outlines.begin(), made_.outlines.end(), [&](const DrawnOutline& o) { return o.layer == name; }));
  for (std::uint32_t i = 0; i < shapes.outlines.size(); ++i) {
    DrawnOutline& drawn = made_.outlines.emplace_back();
    drawn.name = fmt::format("{}.{}", name, ++number);
    drawn.layer = name;
    drawn.where = location(layer, shapes, i, shapes.outlines[i].start);
    drawn.handles.push_back(dxf::handle_text(shapes.handles[i]));
    drawn.outline = std::move(shapes.outlines[i]);
    drawn.fill = shapes.fills[i];
    drawn.is_text = true;
  }
}

void OutlineDrawer::report(std::uint32_t layer, const LayerShapes& shapes, const Chained& chained) {
  const std::string& name = drawing_.layers[layer].name;
  for (const OpenEnd& end : chained.open_ends) {
    std::string message =
        fmt::format("{} has an open end at {}", shapes.names[end.piece], position_text(end.at));
    if (end.nearest)
      message += fmt::format("; the nearest open end is that of {} at {}, {} mm away",
                             shapes.names[end.nearest_piece], position_text(*end.nearest),
                             number_text(end.distance.mm(), 4));
    Diagnostic& warning = diagnostics_.warning(
        codes::drawing_open_end, location(layer, shapes, end.piece, end.at), std::move(message));
    if (end.nearest && end.distance.mm() <= kSmallGap)
      warning.hint = fmt::format("gaps up to {} mm are joined; a larger tolerance closes this one",
                                 number_text(options_.join.mm(), 4));
    made_.open_ends.push_back({end.at, name, shapes.names[end.piece], end.nearest, end.distance});
  }
  for (const Junction& junction : chained.junctions) {
    DrawnJunction drawn{junction.at, name, {}};
    for (const std::uint32_t shape : junction.pieces) drawn.entities.push_back(shapes.names[shape]);
    const std::string more = junction.count > drawn.entities.size() ? " and others" : "";
    diagnostics_
        .warning(codes::drawing_junction, location(layer, shapes, junction.pieces.front(), junction.at),
                 fmt::format("{}{} meet at {}; they are not joined there", list_text(drawn.entities, "and"),
                             more, position_text(junction.at)))
        .hint = "remove the entities that are not part of the outline, or move them to another layer";
    made_.junctions.push_back(std::move(drawn));
  }
  for (const RepeatedPiece& repeated : chained.repeated) {
    const std::uint32_t figure = shapes.fills[repeated.earlier].figure;
    const bool is_dxf = drawing_.format == dxf::Format::dxf;
    if (is_dxf && figure != 0 && figure >= drawing_.paints.size()) continue;  // the boundary of a hatch
    diagnostics_.warning(codes::drawing_repeated,
                         location(layer, shapes, repeated.piece, shapes.outlines[repeated.piece].start),
                         fmt::format("{} lies on {} and is ignored", shapes.names[repeated.piece],
                                     shapes.names[repeated.earlier]));
  }
}

void OutlineDrawer::report_ignored() {
  for (const auto& [type, ignored] : ignored_)
    diagnostics_.warning(codes::drawing_ignored, ignored.where,
                         ignored.count == 1
                             ? fmt::format("1 {} is not read as an outline: {} on layer {}", type,
                                           ignored.first, clipped(ignored.layer, 60))
                             : fmt::format("{} {} are not read as outlines; the first is {} on layer {}",
                                           ignored.count, type, ignored.first, clipped(ignored.layer, 60)));
  if (wide_ > 0)
    diagnostics_.note(
        codes::drawing_ignored, file(),
        fmt::format("the widths of {} polylines are ignored; outlines are their centre lines", wide_));
  if (whole_.count > 0)
    diagnostics_
        .note(codes::drawing_ignored, whole_.where,
              fmt::format("the gaps of {} dashed stroke{} are not left out, the first is {}", whole_.count,
                          whole_.count == 1 ? "" : "s", whole_.first))
        .hint = "strokes as areas have them (--strokes areas)";
  if (dots_.count > 0)
    diagnostics_
        .note(
            codes::drawing_ignored, dots_.where,
            fmt::format("{} dot{} of strokes that have no length {} no outline, the first is {}", dots_.count,
                        dots_.count == 1 ? "" : "s", dots_.count == 1 ? "is" : "are", dots_.first))
        .hint = "strokes as areas have them (--strokes areas)";
  if (cut_ > 0)
    diagnostics_.note(codes::svg_clip, outline_front::element_origin(drawing_, first_cut_.second),
                      fmt::format("clips hide {} outline{} or parts of them; the first is of {}", cut_,
                                  cut_ == 1 ? "" : "s", first_cut_.first));
  std::vector<std::string> hidden;
  for (std::size_t i = 0; i < hidden_.size(); ++i)
    if (hidden_[i] > 0)
      hidden.push_back(fmt::format("{} ({} entities)", drawing_.layers[i].name, hidden_[i]));
  if (!hidden.empty())
    diagnostics_
        .note(codes::drawing_hidden, file(),
              fmt::format("hidden entities are not used: {}", joined(hidden, ", ")))
        .hint = "layers that are off or frozen are used if they are given by name";
}

std::optional<DrawingOutlines> OutlineDrawer::draw() {
  const auto unit = mm_per_unit();
  const bool has_font = outline_front::TextDrawer::has_font(options_.texts, diagnostics_);
  if (!choose_layers(options_.layers, chosen_) || !choose_layers(options_.stroke_layers, areal_) || !unit ||
      !has_font)
    return std::nullopt;
  made_.unit = mm(*unit);
  if (!collect()) return std::nullopt;
  for (const auto& [layer, shapes] : texts_) shapes_.try_emplace(layer);
  ShapeConverter maker(drawing_, made_.unit.mm(), options_, diagnostics_);
  RegionOptions of_clips = region_options();
  of_clips.where = file();
  outline_front::Clips clips(drawing_, maker, of_clips, diagnostics_);
  if (options_.progress != nullptr) options_.progress->phase("joining outlines");
  std::size_t done = 0;
  for (auto& [layer, shapes] : shapes_) {
    const double all = static_cast<double>(shapes_.size());
    pace_.part(static_cast<double>(done) / all, static_cast<double>(done + 1) / all);
    if (pace_.stops_at(0, 1)) return std::nullopt;
    ++done;
    arrange(shapes, layer);
    LayerShapes& texts = texts_[layer];
    if (!strokes_.empty()) {
      fill_strokes(shapes);
      fill_strokes(texts);
    }
    if (drawing_.clips.size() > 1 && options_.hidden_parts == HiddenParts::left_out) {
      clip(shapes, clips);
      clip(texts, clips);
    }
    if (pace_.asks()) return std::nullopt;
    join(layer, shapes);
    append_texts(layer, texts);
  }
  if (pace_.asks()) return std::nullopt;
  report_ignored();
  if (made_.outlines.empty() && made_.points.empty()) {
    if (!diagnostics_.has_errors())
      diagnostics_.error(codes::drawing_empty, file(),
                         options_.layers.empty()
                             ? "the drawing has no outline and no point on its visible layers"
                             : "the layers have no outline and no point: " + joined(options_.layers, ", "));
    return std::nullopt;
  }
  return std::move(made_);
}

}  // namespace

std::optional<DrawingOutlines> drawn_outlines(const dxf::Drawing& drawing,
                                              const DrawingOutlineOptions& options,
                                              Diagnostics& diagnostics) {
  return OutlineDrawer(drawing, options, diagnostics).draw();
}

std::optional<Region> drawn_region(const DrawingOutlines& drawn, Combining combining,
                                   const RegionOptions& options, Diagnostics& diagnostics) {
  std::vector<PaintedOutline> outlines;
  const DrawnOutline* open = nullptr;
  std::size_t strokes = 0;  // of texts
  for (const DrawnOutline& o : drawn.outlines) {
    const bool is_used = o.fill.figure != 0 || o.outline.closed();
    if (is_used) outlines.push_back({o.outline, o.fill});
    if (is_used) continue;
    open = &o;
    if (o.is_text && strokes++ > 0) continue;
    diagnostics.warning(codes::region_open_outline, o.where,
                        o.is_text ? "texts in single strokes bound no region"
                                  : fmt::format("outline {} is open; it bounds no region", o.name));
  }
  if (outlines.empty()) {
    diagnostics.error(codes::region_open_outline, open != nullptr ? open->where : options.where,
                      "there is no closed outline");
    return std::nullopt;
  }
  return painted_region(outlines, combining, options, diagnostics);
}

std::vector<LayerContent> layer_contents(const dxf::Drawing& drawing, const dxf::VisitOptions& options,
                                         Diagnostics& diagnostics) {
  std::vector<LayerContent> contents;
  for (const dxf::Layer& layer : drawing.layers) {
    LayerContent& content = contents.emplace_back();
    content.name = layer.name;
    content.off = layer.off;
    content.frozen = layer.frozen;
    content.colour = layer.colour;
    content.linetype = drawing.linetypes[layer.linetype].name;
  }
  dxf::for_each_placed(drawing, options, diagnostics, [&](const dxf::Placed& placed) {
    LayerContent& content = contents[placed.style.layer];
    ++content.entities;
    const std::string_view type = dxf::type_name(drawing, placed.entity);
    for (auto& [name, count] : content.types)
      if (name == type) return static_cast<void>(++count);
    content.types.emplace_back(type, 1);
  });
  return contents;
}

}  // namespace kerf
