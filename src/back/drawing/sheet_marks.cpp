// Dimension lines and the mark of the zero.
#include "back/drawing/sheet_marks.h"

#include <utility>

#include "back/drawing/shapes.h"
#include "base/names.h"

namespace kerf::drawings {
namespace {

constexpr double kArrow = 1.5;              // mm, of dimension lines
constexpr std::size_t kMaxTextBytes = 120;  // of one text

}  // namespace

void add_line(Drawing& drawing, std::size_t layer, Point2 a, Point2 b) {
  add(drawing, layer, drawing::Line{a.x, a.y, b.x, b.y, 0, 0});
}

void add_rectangle(Drawing& drawing, std::size_t layer, const Box2& box) {
  const Point2 a = box.low, b = box.high;
  add(drawing, layer, drawing::Polyline{{{a.x, a.y}, {b.x, a.y}, {b.x, b.y}, {a.x, b.y}}, true});
}

void add_text(Drawing& drawing, std::size_t layer, Point2 at, double height, const std::string& text) {
  add(drawing, layer, drawing::Text{at.x, at.y, height, clipped(text, kMaxTextBytes)});
}

void add_dimension(Drawing& drawing, std::size_t layer, Point2 a, Point2 b, Point2 offset,
                   const std::string& value) {
  const double size = distance(a, b);
  if (!(size > 0.0)) return;
  const Point2 p = a + offset, q = b + offset, along = (1.0 / size) * (b - a), across{-along.y, along.x};
  add_line(drawing, layer, a, p);
  add_line(drawing, layer, b, q);
  add_line(drawing, layer, p, q);
  for (const auto& [tip, way] : {std::pair(p, along), std::pair(q, -1.0 * along)})
    for (const double side : {0.3, -0.3})
      add_line(drawing, layer, tip, tip + kArrow * way + side * kArrow * across);
  add_text(drawing, layer, 0.5 * (p + q) + Point2{0.6, 0.6}, kTextHeight, value);
}

void add_zero_mark(Drawing& drawing, std::size_t layer, Point2 at) {
  add_line(drawing, layer, at - Point2{kArrow, 0}, at + Point2{kArrow, 0});
  add_line(drawing, layer, at - Point2{0, kArrow}, at + Point2{0, kArrow});
  add_text(drawing, layer, at + Point2{0.5, -kTextHeight - 0.5}, kLabelHeight, "X0 Y0");
}

}  // namespace kerf::drawings
