// Outlines as values.
#include "design/commands/outline_values.h"

#include <algorithm>
#include <fmt/format.h>

namespace kerf::design {
namespace {

bool is_number_list(const Value& value) {
  if (!value.is(Type::list)) return false;
  for (const Value& item : value.list())
    if (!item.is(Type::number)) return false;
  return true;
}

Outline circle(const std::vector<double>& numbers, std::string_view name) {
  coordinate(numbers[0], name), coordinate(numbers[1], name);
  return as_outline(Circle{{numbers[0], numbers[1]}, mm(positive(numbers[2], name))});
}

[[noreturn]] void not_an_outline(std::string_view name) {
  refuse_type(
      fmt::format("{}: an outline is [[x, y], ...] with segments to [x, y] and arcs [via x, via y, x, y], "
                  "or a circle [x, y, radius]",
                  name));
}

/// The depth of lists in lists.
std::size_t nesting(const Value& value) {
  if (!value.is(Type::list)) return 0;
  std::size_t deepest = 0;
  for (const Value& item : value.list()) deepest = std::max(deepest, nesting(item));
  return deepest + 1;
}
/// Whether a value is a list of outlines.
bool is_nested(const Value& value) { return nesting(value) > 2; }

}  // namespace

std::vector<double> numbers_of(const Value& value, std::string_view name) {
  std::vector<double> numbers;
  if (!is_number_list(value)) refuse(fmt::format("{} must consist of numbers", name));
  for (const Value& item : value.list()) numbers.push_back(coordinate(item.number(), name));
  return numbers;
}

std::vector<Point2> points_of(const Value& value, std::string_view name) {
  if (!value.is(Type::list)) refuse(fmt::format("{} must be a list of points [x, y]", name));
  std::vector<Point2> points;
  for (const Value& item : value.list()) {
    const std::vector<double> numbers = numbers_of(item, name);
    if (numbers.size() != 2) refuse(fmt::format("{} must be a list of points [x, y]", name));
    points.push_back({numbers[0], numbers[1]});
  }
  return points;
}

Outline outline_of(const Value& value, std::string_view name) {
  if (!value.is(Type::list) || value.list().empty()) not_an_outline(name);
  if (is_number_list(value) && value.list().size() == 3) return circle(numbers_of(value, name), name);
  Outline outline;
  bool first = true;
  for (const Value& item : value.list()) {
    if (!is_number_list(item)) not_an_outline(name);
    const std::vector<double> n = numbers_of(item, name);
    if (n.size() != 2 && (n.size() != 4 || first)) not_an_outline(name);
    const Point2 to{n[n.size() - 2], n[n.size() - 1]};
    if (first)
      outline.start = to;
    else
      outline.segments.push_back({to, n.size() == 4 ? std::optional(Point2{n[0], n[1]}) : std::nullopt});
    first = false;
  }
  if (outline.segments.empty()) not_an_outline(name);
  return outline;
}

std::vector<Outline> outlines_given(Call& call, std::size_t i) {
  const std::string_view name = call.name(i);
  const Value& value = call[i];
  if (value.is(Type::undefined)) {
    auto children = call.site().children();
    if (!children) refuse(fmt::format("{} is missing: an outline, or a child such as circle(5);", name));
    if (children->empty()) refuse("the children must be a shape of the plane that is not empty");
    return std::move(*children);
  }
  std::vector<Outline> outlines;
  if (value.is(Type::outlines))
    for (const Outline& outline : value.outlines().list) outlines.push_back(closed(outline));
  else if (is_nested(value))
    for (const Value& item : value.list()) outlines.push_back(closed(outline_of(item, name)));
  else
    outlines.push_back(closed(outline_of(value, name)));
  return outlines;
}

}  // namespace kerf::design
