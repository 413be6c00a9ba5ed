// The shapes that each operation of a job selects.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/names.h"
#include "front/cut/order.h"

#include "kerf/drawing/svg.h"

namespace kerf::cut_detail {
namespace {

constexpr std::string_view kStockName = "stock";  // of an outline: the stock, seen from above

bool listed(const std::vector<std::string>& names, const std::string& name) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& n) { return fold_name(n) == fold_name(name); });
}

/// The names of layers, those of colours as drawings name them.
std::vector<std::string> layer_names(const std::vector<std::string>& names,
                                     const std::vector<ArtShape>& art) {
  std::vector<std::string> out = names;
  for (std::string& name : out) {
    const bool is_layer = std::any_of(art.begin(), art.end(), [&](const ArtShape& shape) {
      return fold_name(shape.layer) == fold_name(name);
    });
    if (!is_layer) name = colour_layer(name);
  }
  return out;
}

/// Whether the top of the stock is cut: by its name, or by an operation that has no area otherwise.
bool takes_stock(const CutOperation& operation, const std::vector<std::string>& found,
                 const std::vector<const ArtShape*>& shapes) {
  const std::string name(kStockName);
  if (listed(operation.outlines, name)) return std::find(found.begin(), found.end(), name) == found.end();
  const auto has_area = [](const ArtShape* s) {
    return s->outline && (s->fill.figure != 0 || s->outline->closed());
  };
  return operation.row->input == CutInput::region_or_stock && selects_all(operation) &&
         std::none_of(shapes.begin(), shapes.end(), has_area);
}

CutUnit select(const CutOperation& operation, const CutJob& job, const std::vector<ArtShape>& art,
               const ArtShape& stock_top, Diagnostics& diagnostics) {
  CutUnit unit{&operation, {}, operation.row->cuts_mesh() || operation.row->input == CutInput::nothing};
  if (operation.row->input == CutInput::nothing) return unit;
  std::vector<std::string> found;
  const std::vector<std::string> layers = layer_names(operation.layers, art);
  for (const ArtShape& shape : art) {
    const bool by_layer = listed(layers, shape.layer), by_name = listed(operation.outlines, shape.name);
    if (by_layer) found.push_back(fold_name(shape.layer));
    if (by_name) found.push_back(fold_name(shape.name));
    if (by_layer || by_name || selects_all(operation)) unit.shapes.push_back(&shape);
  }
  if (job.stock_box && takes_stock(operation, found, unit.shapes)) {
    std::erase_if(unit.shapes, [](const ArtShape* shape) { return shape->outline.has_value(); });
    unit.shapes.push_back(&stock_top), unit.whole = true;
    found.push_back(std::string(kStockName));
  }
  for (const auto* names : {&layers, &operation.outlines})
    for (const std::string& name : *names)
      if (std::find(found.begin(), found.end(), fold_name(name)) == found.end())
        diagnostics
            .error(codes::cut_job_outlines, operation.where,
                   fmt::format("{}: no {} \"{}\" in the art", operation.name,
                               names == &layers ? "layer" : "outline", name.substr(0, 60)))
            .hint = "kerf outline --list-layers prints the layers of a drawing";
  return unit;
}

}  // namespace

std::optional<Circle> circle_of(const ArtShape& shape) {
  if (shape.circle || !shape.outline || !shape.outline->closed()) return shape.circle;
  const double weld = Tolerance{}.weld.mm();
  std::optional<Circle> circle;
  Point2 from = shape.outline->start;
  double turned = 0.0;
  for (const Segment& segment : shape.outline->segments) {
    const auto arc = arc_circle(from, segment);
    if (!arc) return std::nullopt;
    if (!circle) circle = Circle{arc->centre, mm(arc->radius)};
    if (distance(circle->centre, arc->centre) > weld || std::abs(circle->radius.mm() - arc->radius) > weld)
      return std::nullopt;
    turned += (arc->turn == Turn::ccw ? 1.0 : -1.0) * arc->sweep.deg();
    from = segment.to;
  }
  return std::abs(std::abs(turned) - 360.0) < 1e-3 ? circle : std::nullopt;
}

ArtShape top_of(const Box3& stock) {
  ArtShape shape;
  shape.name = kStockName;
  Outline& outline = shape.outline.emplace();
  outline.start = stock.low.xy();
  for (const Point2 p : {Point2{stock.high.x, stock.low.y}, stock.high.xy(),
                         Point2{stock.low.x, stock.high.y}, stock.low.xy()})
    outline.segments.push_back({p, {}});
  return shape;
}

bool selects_all(const CutOperation& operation) {
  return operation.layers.empty() && operation.outlines.empty();
}

std::optional<std::vector<CutUnit>> select_shapes(const CutJob& job, const std::vector<ArtShape>& art,
                                                  const ArtShape& stock_top, Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  std::vector<CutUnit> units;
  for (const CutOperation& operation : job.operations)
    units.push_back(select(operation, job, art, stock_top, diagnostics));
  return diagnostics.errors() == errors ? std::optional(std::move(units)) : std::nullopt;
}

}  // namespace kerf::cut_detail
