// The plan view of a setup.
#include "back/drawing/setup_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include "back/drawing/sheet_marks.h"
#include "base/number.h"

#include "kerf/drawing/toolpath_drawing.h"

namespace kerf {
namespace {

constexpr double kGap = 7.0;                        // mm, of dimension lines
constexpr double kSameLabel = 3.0;                  // mm: operations that start this close have one label
constexpr double kFarZero = 1.0;                    // sizes of the setup that the zero may be away from it
constexpr std::size_t kMaxLabels = 60;              // more would cover the paths
constexpr double kSmallest = 1e-3, kLargest = 1e3;  // scales of the drawing
enum Layer : std::size_t { stock, fixtures, dimensions, zero, operations, first_tool };

struct LayerStyle {
  const char* name;
  std::array<std::uint8_t, 3> rgb;
  double width;
  LineKind line;
};
constexpr LayerStyle kLayers[] = {{"stock", {0, 0, 0}, 0.5, LineKind::solid},
                                  {"fixtures", {120, 120, 120}, 0.6, LineKind::dashed},
                                  {"dimensions", {60, 60, 60}, 0.13, LineKind::solid},
                                  {"zero", {0, 0, 0}, 0.4, LineKind::solid},
                                  {"operations", {0, 0, 0}, 0.18, LineKind::solid}};
/// Of the tools in their order: dark and light shades, solid and dashed.
constexpr LayerStyle kTools[] = {
    {"", {20, 50, 140}, 0.3, LineKind::solid}, {"", {215, 100, 0}, 0.3, LineKind::solid},
    {"", {0, 90, 50}, 0.3, LineKind::dashed},  {"", {170, 60, 160}, 0.3, LineKind::dashed},
    {"", {110, 20, 20}, 0.6, LineKind::solid}, {"", {110, 130, 150}, 0.6, LineKind::solid}};

DrawingLayer layer_of(const LayerStyle& style) {
  DrawingLayer layer;
  layer.name = style.name;
  layer.rgb = style.rgb, layer.line_width = style.width, layer.line = style.line;
  return layer;
}

class PlanMaker {
 public:
  explicit PlanMaker(const SetupPlan& plan) : plan_(plan) {
    out_.layers.clear();
    for (const LayerStyle& style : kLayers) out_.layers.push_back(layer_of(style));
    shown_ = plan.stock;
    shown_.add(plan.cuts);
    for (const auto& [name, box] : plan.fixtures) shown_.add(box);
    if (shown_.empty()) shown_.add(Point2{});
    Point2 sides = shown_.high - shown_.low;
    Box2 origin;
    origin.add(Point2{});
    zero_shown_ = shown_.grown(std::max({kFarZero * sides.x, kFarZero * sides.y, 1.0})).contains(origin);
    if (zero_shown_) shown_.add(origin);
    sides = shown_.high - shown_.low;
    scale_ = std::clamp(std::min(plan.width / std::max(sides.x, 1e-9), plan.height / std::max(sides.y, 1e-9)),
                        kSmallest, kLargest);
  }

  Drawing make() {
    if (plan_.path != nullptr) add_paths();
    if (!plan_.stock.empty()) drawings::add_rectangle(out_, stock, on_paper(plan_.stock));
    for (const auto& [name, box] : plan_.fixtures) {
      const Box2 drawn = on_paper(box);
      drawings::add_rectangle(out_, fixtures, drawn);
      drawings::add_text(out_, fixtures, drawn.low + Point2{0.6, 0.6}, drawings::kLabelHeight, name);
    }
    add_dimensions();
    if (zero_shown_) add_zero();
    add_operations();
    return std::move(out_);
  }

 private:
  Point2 on_paper(Point2 p) const { return scale_ * (p - shown_.low); }
  Box2 on_paper(const Box2& box) const {
    Box2 drawn;
    drawn.add(on_paper(box.low)), drawn.add(on_paper(box.high));
    return drawn;
  }
  std::string value(double mm) const { return number_text(mm / plan_.unit, plan_.unit == 1.0 ? 2 : 3); }
  void dimension(Point2 a, Point2 b, Point2 offset) {
    drawings::add_dimension(out_, dimensions, on_paper(a), on_paper(b), offset, value(distance(a, b)));
  }

  void add_paths();
  void add_dimensions();
  void add_zero();
  void add_operations();

  // Shapes of the path's drawing on paper.
  void to_paper(drawing::Line& l) const {
    const Point2 a = on_paper(Point2{l.x1, l.y1}), b = on_paper(Point2{l.x2, l.y2});
    l.x1 = a.x, l.y1 = a.y, l.x2 = b.x, l.y2 = b.y;
  }
  void to_paper(drawing::Arc& a) const { shift_centre(a); }
  void to_paper(drawing::Circle& c) const { shift_centre(c); }
  void to_paper(drawing::Polyline& line) const {
    for (drawing::Vertex& v : line.vertices) {
      const Point2 p = on_paper(Point2{v.x, v.y});
      v.x = p.x, v.y = p.y, v.radius *= scale_;
    }
  }
  void to_paper(drawing::Text&) const {}
  template <class Round>
  void shift_centre(Round& round) const {
    const Point2 p = on_paper(Point2{round.x, round.y});
    round.x = p.x, round.y = p.y, round.radius *= scale_;
  }

  const SetupPlan& plan_;
  Drawing out_;
  Box2 shown_;
  bool zero_shown_ = false;
  double scale_ = 1.0;  // mm on paper per mm
};

void PlanMaker::add_paths() {
  ToolpathDrawingOptions options;
  options.tool_diameters = plan_.tool_diameters;
  Drawing paths = toolpath_drawing(*plan_.path, options);
  for (std::size_t i = 0; i < paths.layers.size(); ++i) {
    DrawingLayer layer = layer_of(kTools[i % std::size(kTools)]);
    layer.name = paths.layers[i].name;
    out_.layers.push_back(std::move(layer));
  }
  for (DrawingEntity& entity : paths.entities) {
    std::visit([&](auto& shape) { to_paper(shape); }, entity.shape);
    entity.layer += first_tool;
    out_.entities.push_back(std::move(entity));
  }
}

/// The sizes of the stock, or of the cuts, and where the zero is on it.
void PlanMaker::add_dimensions() {
  const Box2& box = plan_.stock.empty() ? plan_.cuts : plan_.stock;
  if (box.empty()) return;
  const Point2 low = box.low, high = box.high;
  const double below = scale_ * (low.y - shown_.low.y), beside = scale_ * (low.x - shown_.low.x);
  dimension(low, {high.x, low.y}, {0.0, -below - kGap});
  dimension(low, {low.x, high.y}, {-beside - kGap, 0.0});
  if (!zero_shown_) return;
  const double tiny = 1e-6;
  const double above = scale_ * (shown_.high.y - high.y), right = scale_ * (shown_.high.x - high.x);
  if (std::abs(low.x) > tiny && std::abs(high.x) > tiny)
    dimension({std::min(low.x, 0.0), high.y}, {std::max(low.x, 0.0), high.y}, {0.0, above + 0.6 * kGap});
  if (std::abs(low.y) > tiny && std::abs(high.y) > tiny)
    dimension({high.x, std::min(low.y, 0.0)}, {high.x, std::max(low.y, 0.0)}, {right + 0.6 * kGap, 0.0});
}

/// A circle with a cross, larger than the mark of a path drawing: it must be found at once.
void PlanMaker::add_zero() {
  constexpr double kRadius = 2.2, kCross = 4.0;  // mm
  const Point2 at = on_paper(Point2{});
  out_.entities.push_back({zero, drawing::Circle{at.x, at.y, kRadius}});
  drawings::add_line(out_, zero, at - Point2{kCross, 0}, at + Point2{kCross, 0});
  drawings::add_line(out_, zero, at - Point2{0, kCross}, at + Point2{0, kCross});
  drawings::add_text(out_, zero, at + Point2{kRadius + 0.4, -kRadius - 1.6}, drawings::kTextHeight, "X0 Y0");
}

void PlanMaker::add_operations() {
  std::vector<SetupPlan::Mark> labels;
  for (std::size_t i = 0; i < std::min(plan_.operations.size(), kMaxLabels); ++i) {
    const SetupPlan::Mark mark{on_paper(plan_.operations[i].at), plan_.operations[i].text};
    const auto near = std::find_if(labels.begin(), labels.end(), [&](const SetupPlan::Mark& other) {
      return distance(other.at, mark.at) < kSameLabel;
    });
    if (near == labels.end())
      labels.push_back(mark);
    else
      near->text += ", " + mark.text;
  }
  constexpr double kDot = 0.5;  // mm
  for (const SetupPlan::Mark& label : labels) {
    out_.entities.push_back({operations, drawing::Circle{label.at.x, label.at.y, kDot}});
    drawings::add_text(out_, operations, label.at + Point2{0.7, 0.7}, drawings::kTextHeight, label.text);
  }
}

}  // namespace

Drawing setup_plan(const SetupPlan& plan) { return PlanMaker(plan).make(); }

std::optional<std::size_t> layer_of_tool(const Drawing& plan, int tool) {
  const std::string name = fmt::format("T{}", tool);
  const auto found = std::find_if(plan.layers.begin(), plan.layers.end(),
                                  [&](const DrawingLayer& layer) { return layer.name == name; });
  if (found == plan.layers.end()) return std::nullopt;
  return static_cast<std::size_t>(found - plan.layers.begin());
}

}  // namespace kerf
