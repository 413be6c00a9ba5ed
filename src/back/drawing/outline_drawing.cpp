// Outlines as the entities of a drawing.
#include "back/drawing/outline_drawing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "back/drawing/shapes.h"

namespace kerf {
namespace {

using drawings::add;
using drawings::set_widths;

void draw_pieces(Drawing& drawing, std::size_t layer, const Outline& outline) {
  Point2 from = outline.start;
  for (const Segment& segment : outline.segments) {
    if (const auto circle = arc_circle(from, segment)) {
      const auto angle = [&](Point2 p) {
        return radians(std::atan2(p.y - circle->centre.y, p.x - circle->centre.x)).deg();
      };
      const bool ccw = circle->turn == Turn::ccw;
      const double start = angle(ccw ? from : segment.to), end = angle(ccw ? segment.to : from);
      const Point2 centre = circle->centre;
      add(drawing, layer, drawing::Arc{centre.x, centre.y, circle->radius, start, end});
    } else {
      add(drawing, layer, drawing::Line{from.x, from.y, segment.to.x, segment.to.y});
    }
    from = segment.to;
  }
}

void draw_polyline(Drawing& drawing, std::size_t layer, const Outline& outline) {
  drawing::Polyline line;
  line.closed = outline.closed();
  Point2 from = outline.start;
  for (const Segment& segment : outline.segments) {
    double bulge = 0.0;
    if (const auto circle = arc_circle(from, segment))
      bulge = (circle->turn == Turn::ccw ? 1.0 : -1.0) * std::tan(0.25 * circle->sweep.rad());
    line.vertices.push_back({from.x, from.y, bulge});
    from = segment.to;
  }
  if (!line.closed) line.vertices.push_back({from.x, from.y, 0.0});
  add(drawing, layer, std::move(line));
}

/// The router bit at a changed corner: the circle of the single arc that replaces the corner.
void draw_bit(Drawing& drawing, std::size_t layer, const Outline& cut, const CornerReport& report) {
  for (std::uint32_t i = report.first; i + 1 < report.first + report.count; ++i) {
    const Segment& piece = cut.segments[i];
    if (const auto circle = arc_circle(cut.point(i), piece))
      add(drawing, layer, drawing::Circle{circle->centre.x, circle->centre.y, circle->radius});
  }
}

DrawingLayer ideal_layer() { return {"ideal", 30, {0xe0, 0x80, 0x10}, 1.0, LineKind::dashed}; }
DrawingLayer cut_layer() { return {"cut", 1, {0xc0, 0x10, 0x20}, 1.5, LineKind::solid}; }

}  // namespace

void draw(Drawing& drawing, std::size_t layer, const Outline& outline, OutlineEntities as) {
  if (outline.segments.empty()) return;
  if (as == OutlineEntities::pieces)
    draw_pieces(drawing, layer, outline);
  else
    draw_polyline(drawing, layer, outline);
}

void draw(Drawing& drawing, std::size_t layer, const Circle& circle) {
  add(drawing, layer, drawing::Circle{circle.centre.x, circle.centre.y, circle.radius.mm()});
}

void draw(Drawing& drawing, std::size_t layer, const Figure& figure, OutlineEntities as) {
  for (const auto& shape : figure) {
    if (const auto* outline = std::get_if<Outline>(&shape))
      draw(drawing, layer, *outline, as);
    else
      draw(drawing, layer, std::get<Circle>(shape));
  }
}

Drawing corner_picture(const std::vector<CutPair>& pairs, std::string title) {
  Drawing drawing;
  drawing.title = std::move(title);
  drawing.layers = {ideal_layer(), {"bit", 5, {0x30, 0x60, 0xd0}, 0.5, LineKind::solid}, cut_layer()};
  for (const CutPair& pair : pairs) {
    draw(drawing, 0, pair.ideal, OutlineEntities::polyline);
    draw(drawing, 2, pair.cut.outline, OutlineEntities::polyline);
    for (const CornerReport& report : pair.cut.corners) draw_bit(drawing, 1, pair.cut.outline, report);
  }
  set_widths(drawing);
  return drawing;
}

Drawing overlay_picture(const Figure& over, const Figure& under, std::string title) {
  Drawing drawing;
  drawing.title = std::move(title);
  drawing.layers = {ideal_layer(), cut_layer()};
  draw(drawing, 0, under, OutlineEntities::polyline);
  draw(drawing, 1, over, OutlineEntities::polyline);
  set_widths(drawing);
  return drawing;
}

}  // namespace kerf
