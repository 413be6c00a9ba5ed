// The shapes of SVG: paths and basic shapes as commands of paths.
#if KERF_WITH_SVG
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/outline.h"
#include "base/names.h"
#include "codec/drawing/svg_reader.h"

namespace kerf::svg {

/// False if the element is not a shape.
bool SvgReader::draw(const Drawn& drawn) {
  const std::string& name = drawn.element.name;
  if (name == "path") {
    draw_path(drawn);
  } else if (name == "rect") {
    draw_rectangle(drawn);
  } else if (name == "circle" || name == "ellipse") {
    draw_ellipse(drawn);
  } else if (name == "line") {
    std::vector<PathCommand> line(2);
    line[0].at[0] = {length_of(drawn, "x1", Axis::x).value_or(0.0),
                     length_of(drawn, "y1", Axis::y).value_or(0.0)};
    line[1].kind = 'L';
    line[1].at[0] = {length_of(drawn, "x2", Axis::x).value_or(0.0),
                     length_of(drawn, "y2", Axis::y).value_or(0.0)};
    writer_.path(line);
  } else if (name == "polyline" || name == "polygon") {
    draw_points(drawn.element, name == "polygon");
  } else {
    return false;
  }
  return true;
}

void SvgReader::draw_path(const Drawn& drawn) {
  std::string_view text = drawn.properties.find("d");
  if (text == "none") return;
  if (text.substr(0, 5) == "path(" && text.size() > 8) text = text.substr(6, text.size() - 8);  // of CSS
  const PathData data = read_path(text);
  segments_ += data.commands.size();
  if (data.error_at) {
    const std::string_view rest = text.substr(std::min(*data.error_at, text.size()));
    diagnostics_.warning(
        codes::svg_value, location(drawn.element),
        fmt::format("path: invalid data at character {}: {}; it is drawn up to there", *data.error_at + 1,
                    trim(rest).empty()
                        ? fmt::format("they end where {} was expected", data.expected)
                        : fmt::format("{} was expected, found \"{}\"", data.expected, clipped(rest, 20))));
  }
  writer_.path(data.commands);
}

void SvgReader::draw_points(const Element& element, bool is_closed) {
  const std::string_view text = element.attribute("points");
  const Numbers numbers = read_numbers(text);
  if (numbers.error_at || numbers.values.size() % 2 != 0)
    warn(element, "points", text, "is invalid; it is drawn up to its last pair of numbers");
  std::vector<PathCommand> line;
  for (std::size_t i = 0; i + 1 < numbers.values.size(); i += 2) {
    PathCommand& command = line.emplace_back();
    command.kind = i == 0 ? 'M' : 'L';
    command.at[0] = {numbers.values[i], numbers.values[i + 1]};
  }
  if (is_closed && !line.empty()) line.emplace_back().kind = 'Z';
  segments_ += line.size();
  writer_.path(line);
}

void SvgReader::draw_ellipse(const Drawn& drawn) {
  const bool is_circle = drawn.element.name == "circle";
  auto rx = is_circle ? length_of(drawn, "r", Axis::both, Range::positive)
                      : length_of(drawn, "rx", Axis::x, Range::positive);
  auto ry = is_circle ? rx : length_of(drawn, "ry", Axis::y, Range::positive);
  if (!rx) rx = ry;
  if (!ry) ry = rx;
  const Vec centre{length_of(drawn, "cx", Axis::x).value_or(0.0),
                   length_of(drawn, "cy", Axis::y).value_or(0.0)};
  if (rx && *rx > 0.0 && *ry > 0.0) writer_.ellipse(centre, *rx, *ry);
}

void SvgReader::draw_rectangle(const Drawn& drawn) {
  const double x = length_of(drawn, "x", Axis::x).value_or(0.0),
               y = length_of(drawn, "y", Axis::y).value_or(0.0);
  const double width = length_of(drawn, "width", Axis::x, Range::positive).value_or(0.0);
  const double height = length_of(drawn, "height", Axis::y, Range::positive).value_or(0.0);
  if (!(width > 0.0) || !(height > 0.0)) return;
  auto given_rx = length_of(drawn, "rx", Axis::x, Range::positive);
  auto given_ry = length_of(drawn, "ry", Axis::y, Range::positive);
  if (!given_rx) given_rx = given_ry;
  if (!given_ry) given_ry = given_rx;
  const double rx = std::min(given_rx.value_or(0.0), 0.5 * width);
  const double ry = std::min(given_ry.value_or(0.0), 0.5 * height);
  std::vector<PathCommand> path;
  const auto add = [&](char kind, Vec p) {
    PathCommand& command = path.emplace_back();
    command.kind = kind;
    command.at[kind == 'A' ? 1 : 0] = p;
    if (kind == 'A') command.at[0] = {rx, ry};
    command.is_sweep = true;
  };
  const double right = x + width, bottom = y + height;
  add('M', {x + rx, y});
  add('L', {right - rx, y});
  add('A', {right, y + ry});
  add('L', {right, bottom - ry});
  add('A', {right - rx, bottom});
  add('L', {x + rx, bottom});
  add('A', {x, bottom - ry});
  add('L', {x, y + ry});
  add('A', {x + rx, y});
  add('Z', {});
  writer_.path(path);
}

}  // namespace kerf::svg
#endif
