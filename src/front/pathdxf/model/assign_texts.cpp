// Assignment of parameter texts by their overlap circles.
#include "front/pathdxf/model/assign_texts.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace kerf::pathdxf {
namespace {

Box2 box_around(Point2 a, Point2 b, double margin) {
  return {{std::min(a.x, b.x) - margin, std::min(a.y, b.y) - margin},
          {std::max(a.x, b.x) + margin, std::max(a.y, b.y) + margin}};
}

Box2 box_of(const Element& element) {
  if (element.shape == Shape::line) return box_around(element.start, element.end, 0.0);
  return box_around(element.centre, element.centre, element.radius);
}

std::optional<double> circle_distance(const Element& circle, const TextCircle& text) {
  const double d = distance(circle.centre, text.centre);
  return d < text.radius + circle.radius ? std::optional(d) : std::nullopt;
}

std::optional<double> arc_distance(const Element& arc, const TextCircle& text) {
  const Point2 direction = text.centre - arc.centre;
  const double d = std::abs(length(direction) - arc.radius);
  if (d > text.radius) return std::nullopt;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double first = arc.turn >= 0.0 ? arc.start_angle : arc.start_angle + arc.turn;
  double angle = std::fmod(std::atan2(direction.y, direction.x) - first, kTurn);
  if (angle < 0.0) angle += kTurn;
  return angle <= std::abs(arc.turn) ? std::optional(d) : std::nullopt;
}

std::optional<double> line_distance(const Element& line, const TextCircle& text) {
  const Point2 along = line.end - line.start, to_text = text.centre - line.start;
  const double square = dot(along, along);
  if (square == 0.0) return std::nullopt;
  const double t = dot(along, to_text) / square;
  if (t < 0.0 || t > 1.0) return std::nullopt;
  const double d = std::abs(cross(along, to_text)) / std::sqrt(square);
  return d < text.radius ? std::optional(d) : std::nullopt;
}

std::optional<double> overlap_distance(const Element& element, const TextCircle& text) {
  switch (element.shape) {
    case Shape::circle: return circle_distance(element, text);
    case Shape::arc: return arc_distance(element, text);
    case Shape::line: break;
  }
  return line_distance(element, text);
}

}  // namespace

void TextTargets::add(const Element& element, std::size_t number) {
  Group& group = element.shape == Shape::circle ? circles_ : element.shape == Shape::arc ? arcs_ : lines_;
  group.targets.push_back({&element, number, false});
}

std::optional<std::size_t> TextTargets::take(const TextCircle& text) {
  for (Group* group : {&circles_, &arcs_, &lines_})
    if (const auto number = take_of(*group, text)) return number;
  return std::nullopt;
}

std::optional<std::size_t> TextTargets::take_of(Group& group, const TextCircle& text) {
  if (!group.tree) {
    std::vector<Box2> boxes;
    boxes.reserve(group.targets.size());
    for (const Target& t : group.targets) boxes.push_back(box_of(*t.element));
    group.tree.emplace(boxes);
  }
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t found = group.targets.size();
  group.tree->query(box_around(text.centre, text.centre, text.radius), [&](std::uint32_t i) {
    if (group.targets[i].taken) return;
    const auto d = overlap_distance(*group.targets[i].element, text);
    if (!d || *d > nearest || (*d == nearest && i > found)) return;
    nearest = *d;
    found = i;
  });
  if (found == group.targets.size()) return std::nullopt;
  group.targets[found].taken = true;
  return group.targets[found].number;
}

}  // namespace kerf::pathdxf
