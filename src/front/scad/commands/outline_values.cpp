// Outlines as values.
#include "front/scad/commands/outline_values.h"

#include <fmt/format.h>

namespace kerf::scad {
namespace {

Value point_value(Point2 p) { return Value::vector({p.x, p.y}); }

bool is_number_list(const Value& value) {
  if (!value.is(Type::vector)) return false;
  for (const Value& item : value.items())
    if (!item.is_number()) return false;
  return true;
}

Outline circle(const std::vector<double>& numbers, std::string_view name) {
  coordinate(numbers[0], name), coordinate(numbers[1], name);
  return as_outline(Circle{{numbers[0], numbers[1]}, mm(positive(numbers[2], name))});
}

[[noreturn]] void not_an_outline(std::string_view name) {
  refuse(
      fmt::format("{}: an outline is [[x, y], ...] with segments to [x, y] and arcs [via x, via y, x, y], "
                  "or a circle [x, y, radius]",
                  name));
}

/// Whether a value is a vector of outlines.
bool is_nested(const Value& value) { return value.is(Type::vector) && value.nesting() > 2; }

}  // namespace

Value value_of(const Outline& outline) {
  std::vector<Value> rows{point_value(outline.start)};
  for (const Segment& s : outline.segments)
    rows.push_back(s.via ? Value::vector({s.via->x, s.via->y, s.to.x, s.to.y}) : point_value(s.to));
  return Value::vector(std::move(rows));
}

Value value_of(const std::vector<Outline>& outlines) {
  std::vector<Value> values;
  for (const Outline& outline : outlines) values.push_back(value_of(outline));
  return Value::vector(std::move(values));
}

std::vector<double> numbers_of(const Value& value, std::string_view name) {
  std::vector<double> numbers;
  if (!is_number_list(value)) refuse(fmt::format("{} must consist of numbers", name));
  for (const Value& item : value.items()) numbers.push_back(coordinate(item.number(), name));
  return numbers;
}

std::vector<Point2> points_of(const Value& value, std::string_view name) {
  if (!value.is(Type::vector)) refuse(fmt::format("{} must be a vector of points [x, y]", name));
  std::vector<Point2> points;
  for (const Value& item : value.items()) {
    const std::vector<double> numbers = numbers_of(item, name);
    if (numbers.size() != 2) refuse(fmt::format("{} must be a vector of points [x, y]", name));
    points.push_back({numbers[0], numbers[1]});
  }
  return points;
}

Outline outline_of(const Value& value, std::string_view name) {
  if (!value.is(Type::vector) || value.items().empty()) not_an_outline(name);
  if (is_number_list(value) && value.items().size() == 3) return circle(numbers_of(value, name), name);
  Outline outline;
  bool first = true;
  for (const Value& item : value.items()) {
    if (!is_number_list(item)) not_an_outline(name);
    const std::vector<double> n = numbers_of(item, name);
    if (n.size() != 2 && (n.size() != 4 || first)) not_an_outline(name);
    const Point2 to{n[n.size() - 2], n[n.size() - 1]};
    if (first)
      outline.start = to;
    else
      outline.segments.push_back({to, n.size() == 4 ? std::optional(Point2{n[0], n[1]}) : std::nullopt, {}});
    first = false;
  }
  if (outline.segments.empty()) not_an_outline(name);
  return outline;
}

std::vector<Outline> outlines_given(Call& call, std::size_t i) {
  const std::string_view name = call.command().parameters[i].name;
  if (call[i].is_undef()) {
    if (call.site().child_count() == 0)
      refuse(fmt::format("{} is missing: an outline, or a child such as circle(5);", name));
    const Shape shape = call.site().children();
    if (shape.kind != Shape::Kind::area || shape.region.empty())
      refuse("the children must be a shape of the plane that is not empty");
    return shape.region.loops;
  }
  std::vector<Outline> outlines;
  if (is_nested(call[i]))
    for (const Value& item : call[i].items()) outlines.push_back(closed(outline_of(item, name)));
  else
    outlines.push_back(closed(outline_of(call[i], name)));
  return outlines;
}

}  // namespace kerf::scad
