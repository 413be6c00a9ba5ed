// The sheet for the workshop.
#include "back/drawing/path_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>

#include "back/drawing/sheet_marks.h"
#include "base/number.h"

namespace kerf {
namespace {

using drawings::kLabelHeight, drawings::kTextHeight;
constexpr double kLineStep = 4.0;     // mm, of texts
constexpr double kFaultRadius = 4.0;  // mm
constexpr double kProbeRadius = 3.0;  // mm
constexpr double kGap = 8.0;          // mm, between drawing, dimensions and text
constexpr double kMinRadius = 0.1;    // mm
constexpr double kCharacter = 0.6;    // width of a character in heights
constexpr std::size_t kMaxLabels = 5000, kMaxFaults = 200;

struct LayerStyle {
  std::string_view name;
  std::array<std::uint8_t, 3> rgb;
  double width;
  LineKind line;
};
constexpr LayerStyle kLayers[] = {
    {"room", {226, 232, 240}, 0.0, LineKind::solid},     {"drawn", {170, 170, 170}, 0.1, LineKind::solid},
    {"cuts", {20, 60, 160}, 0.25, LineKind::solid},      {"rapids", {0, 140, 70}, 0.15, LineKind::dashed},
    {"order", {20, 60, 160}, 0.18, LineKind::solid},     {"probes", {150, 70, 0}, 0.25, LineKind::solid},
    {"dimensions", {60, 60, 60}, 0.13, LineKind::solid}, {"faults", {210, 0, 0}, 0.5, LineKind::solid},
    {"text", {0, 0, 0}, 0.18, LineKind::solid}};

/// An element of the path at its deepest pass.
struct Element {
  double depth = HUGE_VAL;
  std::size_t order = 0;
  std::vector<DrawingEntity> strokes;
  Point2 end, label;
  double length = 0.0;  // of the stroke that has the label
};

class SheetMaker {
 public:
  explicit SheetMaker(const PathSheet& sheet) : sheet_(sheet) {
    for (const LayerStyle& style : kLayers) {
      DrawingLayer layer;
      layer.name = std::string(style.name);
      layer.rgb = style.rgb;
      layer.line_width = style.width;
      layer.line = style.line;
      out_.layers.push_back(std::move(layer));
    }
    out_.layers.erase(out_.layers.begin());  // the layer "0" that every drawing starts with
    out_.layers[sheet_layer("room")].line_width = std::max(sheet.tool_diameter.mm(), 0.01);
    out_.title = sheet.title;
  }

  Drawing make() {
    if (sheet_.path != nullptr) walk(*sheet_.path);
    for (const auto& [key, element] : elements_) draw(element);
    for (std::size_t i = 0; i < sheet_.probes.size(); ++i) draw_probe(i);
    if (!bounds_.empty()) draw_dimensions();
    for (const PathSheet::Mark& fault : sheet_.faults) bounds_.add(fault.at);
    draw_faults();
    write_texts();
    return std::move(out_);
  }

 private:
  void add(std::string_view layer, decltype(DrawingEntity::shape) shape) {
    out_.entities.push_back({sheet_layer(layer), std::move(shape)});
  }
  void text(std::string_view layer, Point2 at, double height, const std::string& value) {
    drawings::add_text(out_, sheet_layer(layer), at, height, value);
  }
  void line(std::string_view layer, Point2 a, Point2 b) {
    drawings::add_line(out_, sheet_layer(layer), a, b);
  }
  Point2 drawn(Point3 p) const { return p.xy() + sheet_.start; }
  void walk(const Toolpath& path);
  void cut(const Step& s, const MotionContext& context);
  void draw(const Element& element);
  void draw_probe(std::size_t i);
  void draw_dimensions();
  void dimension(Point2 a, Point2 b, Point2 offset, double value) {
    drawings::add_dimension(out_, sheet_layer("dimensions"), a, b, offset, number_text(value, 2));
  }
  void draw_faults();
  void write_texts();

  const PathSheet& sheet_;
  Drawing out_;
  Box2 bounds_;  // of the tool's width
  std::map<OriginId, Element> elements_;
};

void SheetMaker::walk(const Toolpath& path) {
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    if (((context.unknown_from | s.unknown_axes()) & 3u) != 0) return;
    if (s.is_cutting()) return cut(s, context);
    const Point2 a = drawn(context.from), b = drawn(s.to());
    if (s.kind() == StepKind::rapid && distance(a, b) > 0.0) line("rapids", a, b);
  });
}

void SheetMaker::cut(const Step& s, const MotionContext& context) {
  const Point2 a = drawn(context.from), b = drawn(s.to());
  const double radius = 0.5 * sheet_.tool_diameter.mm();
  const auto [entry, is_new] = elements_.try_emplace(s.origin());
  Element& e = entry->second;
  if (is_new) e.order = elements_.size();
  const double z = std::min(context.from.z, s.to().z);
  if (z < e.depth - 1e-9) e.strokes.clear(), e.length = 0.0;
  e.depth = std::min(e.depth, z);
  if (z > e.depth + 1e-9) return;
  Box2 box;
  DrawingEntity stroke{sheet_layer("cuts"), drawing::Line{a.x, a.y, b.x, b.y, 0, 0}};
  Point2 label = 0.5 * (a + b);
  double length = distance(a, b);
  if (s.kind() == StepKind::arc && s.arc().plane == Plane::xy) {
    const ArcWalk arc = walk_of(s, context.from);
    const Point2 centre = s.arc().centre + sheet_.start;
    const double degrees = 180.0 / std::numbers::pi;
    const double first = std::min(arc.start_angle, arc.start_angle + arc.sweep) * degrees;
    length = std::abs(arc.sweep) * arc.start_radius;
    if (std::abs(arc.sweep) > 2.0 * std::numbers::pi - 1e-6)
      stroke.shape = drawing::Circle{centre.x, centre.y, arc.start_radius, 0};
    else
      stroke.shape =
          drawing::Arc{centre.x, centre.y, arc.start_radius, first, first + std::abs(arc.sweep) * degrees, 0};
    label = drawn(arc.at(0.5));
    const Box3 extent = arc.bounds();
    box.add(drawn(extent.low));
    box.add(drawn(extent.high));
  }
  box.add(a);
  box.add(b);
  bounds_.add(box.low - Point2{radius, radius});
  bounds_.add(box.high + Point2{radius, radius});
  if (length >= e.length) e.length = length, e.label = label;
  e.end = b;
  if (length > 0.0) e.strokes.push_back(std::move(stroke));
}

void SheetMaker::draw(const Element& element) {
  for (const DrawingEntity& stroke : element.strokes) {
    DrawingEntity wide = stroke;
    wide.layer = sheet_layer("room");
    out_.entities.push_back(std::move(wide));
    out_.entities.push_back(stroke);
  }
  if (element.strokes.empty())  // a drilled hole
    add("cuts", drawing::Circle{element.end.x, element.end.y,
                                std::max(0.5 * sheet_.tool_diameter.mm(), kMinRadius), 0});
  if (element.order > kMaxLabels) return;
  text("order", element.label + Point2{0.5, 0.5}, kLabelHeight,
       fmt::format("{}: Z{}", element.order, number_text(element.depth, 3)));
}

void SheetMaker::draw_probe(std::size_t i) {
  const auto& [at, label] = sheet_.probes[i];
  add("probes", drawing::Circle{at.x, at.y, kProbeRadius, 0});
  line("probes", at - Point2{kProbeRadius, 0}, at + Point2{kProbeRadius, 0});
  line("probes", at - Point2{0, kProbeRadius}, at + Point2{0, kProbeRadius});
  text("probes", at + Point2{kProbeRadius + 0.5, 0.5}, kTextHeight, fmt::format("{}. {}", i + 1, label));
}

void SheetMaker::draw_dimensions() {
  const Point2 low = bounds_.low, high = bounds_.high;
  dimension(low, {high.x, low.y}, {0.0, -kGap}, high.x - low.x);
  dimension(low, {low.x, high.y}, {-kGap, 0.0}, high.y - low.y);
  drawings::add_zero_mark(out_, sheet_layer("dimensions"), sheet_.start);
}

void SheetMaker::draw_faults() {
  std::map<std::pair<double, double>, std::string> labels;  // one for all faults of a position
  for (std::size_t i = 0; i < std::min(sheet_.faults.size(), kMaxFaults); ++i) {
    std::string& label = labels[{sheet_.faults[i].at.x, sheet_.faults[i].at.y}];
    label += fmt::format("{}!{}", label.empty() ? "" : " ", i + 1);
  }
  for (const auto& [position, label] : labels) {
    const Point2 at{position.first, position.second};
    add("faults", drawing::Circle{at.x, at.y, kFaultRadius, 0});
    text("faults", at + Point2{kFaultRadius, kFaultRadius}, kTextHeight, label);
  }
}

/// Title, lines and faults below the drawing.
void SheetMaker::write_texts() {
  for (const auto& probe : sheet_.probes) bounds_.add(probe.at);
  const Point2 corner = bounds_.empty() ? Point2{} : bounds_.low;
  Point2 at = corner - Point2{kGap, 2.5 * kGap};
  const auto row = [&](std::string_view layer, double height, const std::string& value) {
    text(layer, at, height, value);
    at.y -= kLineStep;
  };
  row("text", 1.4 * kTextHeight, sheet_.title);
  for (const std::string& value : sheet_.lines) row("text", kTextHeight, value);
  for (std::size_t i = 0; i < std::min(sheet_.faults.size(), kMaxFaults); ++i)
    row("faults", kTextHeight, fmt::format("!{} {}", i + 1, sheet_.faults[i].text));
  // The right end of the longest row, so that the sheet has room for it.
  std::size_t longest = sheet_.title.size();
  for (const std::string& value : sheet_.lines) longest = std::max(longest, value.size());
  for (const auto& fault : sheet_.faults)
    longest = std::max(longest, std::min<std::size_t>(fault.text.size() + 4, 120));
  const double width = kCharacter * kTextHeight * static_cast<double>(longest);
  line("text", at, at + Point2{width, 0.0});
}

}  // namespace

std::size_t sheet_layer(std::string_view name) {
  const auto found = std::find_if(std::begin(kLayers), std::end(kLayers),
                                  [&](const LayerStyle& style) { return style.name == name; });
  return static_cast<std::size_t>(found - std::begin(kLayers));
}

Drawing path_sheet(const PathSheet& sheet) { return SheetMaker(sheet).make(); }

}  // namespace kerf
