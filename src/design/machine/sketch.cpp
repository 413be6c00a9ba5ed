// The drawing of the dxf... commands, and its chains of lines and arcs.
#include "design/machine/sketch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kerf/geom/outline.h"

namespace kerf::design {
namespace {

constexpr double kJoin = 1e-5;  // mm: ends closer than this are joined

double bulge_of(Point2 from, const Segment& segment) {
  if (!segment.via) return 0.0;
  const Point2 a = from - *segment.via, b = segment.to - *segment.via;
  const double turn = cross(b, a);                            // above 0: counter-clockwise
  const double seen = std::atan2(std::abs(turn), dot(a, b));  // of the chord from the point between
  return std::copysign(std::tan((std::numbers::pi - seen) / 2), turn);
}

Point2 at(double x, double y, double radius, double angle) {
  const double a = degrees(angle).rad();
  return {x + radius * std::cos(a), y + radius * std::sin(a)};
}

/// The sweep of an arc in degrees, above 0 and below a full turn; 0: a full turn.
double sweep_of(const drawing::Arc& arc) {
  const double sweep = std::fmod(arc.end - arc.start, 360.0);
  return sweep < 0.0 ? sweep + 360.0 : sweep;
}

/// A line or an arc as an outline of one segment; nothing for other entities.
std::optional<Outline> piece_of(const Sketch::Entity& entity) {
  const auto* line = std::get_if<drawing::Line>(&entity);
  if (line != nullptr && (line->z1 != 0.0 || line->z2 != 0.0)) return std::nullopt;  // polylines are flat
  if (line != nullptr) return Outline{{line->x1, line->y1}, {{{line->x2, line->y2}, {}}}};
  const auto* arc = std::get_if<drawing::Arc>(&entity);
  if (arc == nullptr || sweep_of(*arc) == 0.0) return std::nullopt;
  const double end = arc->start + sweep_of(*arc);
  return Outline{
      at(arc->x, arc->y, arc->radius, arc->start),
      {{at(arc->x, arc->y, arc->radius, end), at(arc->x, arc->y, arc->radius, (arc->start + end) / 2)}}};
}

void shift(drawing::Line& e, Point2 by) { e.x1 += by.x, e.x2 += by.x, e.y1 += by.y, e.y2 += by.y; }
void shift(drawing::Arc& e, Point2 by) { e.x += by.x, e.y += by.y; }
void shift(drawing::Circle& e, Point2 by) { e.x += by.x, e.y += by.y; }
void shift(drawing::Text& e, Point2 by) { e.x += by.x, e.y += by.y; }
void shift(drawing::Polyline& e, Point2 by) {
  for (drawing::Vertex& v : e.vertices) v.x += by.x, v.y += by.y;
}

/// Entities with the lines and arcs among them joined end to end, where just two of them meet.
std::vector<Sketch::Entity> chained(const std::vector<Sketch::Entity>& entities) {
  std::vector<Sketch::Entity> result;
  std::vector<Outline> pieces;
  std::vector<std::size_t> sources;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (auto piece = piece_of(entities[i])) {
      pieces.push_back(std::move(*piece));
      sources.push_back(i);
    } else if (const auto* arc = std::get_if<drawing::Arc>(&entities[i])) {
      result.emplace_back(drawing::Circle{arc->x, arc->y, arc->radius});
    } else {
      result.push_back(entities[i]);
    }
  }
  ChainOptions options;
  options.join = mm(kJoin);
  for (const ChainedOutline& made : chain(pieces, options).outlines) {
    if (made.parts.size() == 1 && !made.outline.closed())
      result.push_back(entities[sources[made.parts.front().piece]]);
    else
      result.emplace_back(polyline_of(made.outline));
  }
  return result;
}

}  // namespace

drawing::Polyline polyline_of(const Outline& outline) {
  drawing::Polyline polyline;
  polyline.closed = outline.closed();
  for (std::size_t i = 0; i < outline.segments.size(); ++i) {
    const Point2 from = outline.point(i);
    polyline.vertices.push_back({from.x, from.y, bulge_of(from, outline.segments[i]), 0.0});
  }
  if (!polyline.closed) {
    const Point2 end = outline.segments.empty() ? outline.start : outline.segments.back().to;
    polyline.vertices.push_back({end.x, end.y, 0.0, 0.0});
  }
  return polyline;
}

Outline outline_of(const drawing::Polyline& polyline) {
  Outline outline;
  const std::vector<drawing::Vertex>& v = polyline.vertices;
  outline.start = {v.front().x, v.front().y};
  for (std::size_t i = 0; i + (polyline.closed ? 0 : 1) < v.size(); ++i) {
    const Point2 from{v[i].x, v[i].y};
    const drawing::Vertex& next = v[(i + 1) % v.size()];
    Segment segment{{next.x, next.y}, {}};
    // The midpoint of an arc is the bulge times half the chord to the right of that of the chord.
    if (v[i].bulge != 0.0)
      segment.via = 0.5 * (from + segment.to) - 0.5 * v[i].bulge * left_of(segment.to - from);
    outline.segments.push_back(segment);
  }
  return outline;
}

void Sketch::add(const std::string& layer, int colour, Entity entity) {
  const auto found =
      std::find_if(layers_.begin(), layers_.end(), [&](const Layer& l) { return l.name == layer; });
  const auto index = static_cast<std::size_t>(found - layers_.begin());
  if (found == layers_.end()) layers_.push_back({layer, colour});
  entities_.push_back({index, std::move(entity)});
}

Drawing Sketch::drawing(Chains chains, Point2 stagger) const {
  Drawing drawing;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const int colour = layers_[i].colour;
    std::vector<Entity> parts;
    for (const DrawingEntity& entity : entities_)
      if (entity.layer == i) parts.push_back(entity.shape);
    if (chains == Chains::joined) parts = chained(parts);
    DrawingLayer layer;
    layer.name = layers_[i].name;
    layer.colour = colour;
    layer.rgb = colour_of_index(colour);
    drawing.layers.push_back(std::move(layer));
    for (Entity& part : parts) {
      std::visit([&](auto& entity) { shift(entity, colour * stagger); }, part);
      drawing.entities.push_back({drawing.layers.size() - 1, std::move(part)});
    }
  }
  return drawing;
}

}  // namespace kerf::design
