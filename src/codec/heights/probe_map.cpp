// Maps of bCNC: "xmin xmax columns", "ymin ymax rows", "zmin zmax feed", blank lines, then a line "x y z" for
// each point of the grid.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/ending.h"
#include "base/number.h"
#include "codec/heights/grid.h"

namespace kerf::heights_detail {
namespace {

using Numbers = std::vector<double>;

constexpr std::size_t kHead = 3;         // lines
constexpr std::size_t kBlankLines = 2;   // below them
constexpr double kGridTolerance = 0.05;  // of a position, in the map's unit; bCNC writes six digits

/// "0 100 5": limits, and a number of columns or rows.
bool is_limits(const Numbers& n) { return n.size() == 3 && n[0] < n[1] && n[2] >= 2.0 && count_of(n[2]) > 0; }

/// "-1 1 50": the heights between which is probed, and the feed.
bool is_probing(const Numbers& n) { return n.size() == 3 && n[0] < n[1] && n[2] > 0.0; }

}  // namespace

bool is_probe_map(std::string_view bytes, std::string_view file) {
  if (has_ending(file, ".probe")) return true;
  std::vector<Numbers> head;
  std::size_t last = 0;
  bool has_gap = false;
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    has_gap = head.size() >= 2 && line == last + 1 + kBlankLines;
    last = line;
    if (!has_gap) head.push_back(numbers_of(text, " \t").value_or(Numbers()));
    return !has_gap && head.size() <= kHead + 1;
  });
  // A line of the head may be damaged, missing or there twice: the blank lines below it are bCNC's.
  if (has_gap) return std::any_of(head.begin(), head.end(), is_limits);
  // Cut off after the limits.
  if (head.size() == 2 && is_limits(head[0]) && is_limits(head[1])) return true;
  return head.size() >= kHead && is_limits(head[0]) && is_limits(head[1]) && is_probing(head[2]) &&
         head[2][0] < 0.0 && head[2][2] != head[0][2];
}

void read_probe_map(std::string_view bytes, const HeightsSink& sink) {
  Rows at;
  std::optional<GridPoints> points;
  std::size_t index = 0, last = 0;
  bool good = true;
  const auto expect = [&](bool holds, std::size_t line, std::string_view what) {
    if (holds) return true;
    sink.error(codes::heights_format, line, fmt::format("expected {}", what)).hint =
        "the file starts as a map of bCNC; if it is a list of points, name its columns in the first line: x "
        "y z";
    return false;
  };
  const auto take_point = [&](std::size_t line, const Numbers& n) {
    if (!expect(n.size() == 3, line, "the X, Y and height of a point")) return false;
    const double dx = (at.x1 - at.x0) / double(at.columns - 1), dy = (at.y1 - at.y0) / double(at.rows - 1);
    const double column = std::round((n[0] - at.x0) / dx), row = std::round((n[1] - at.y0) / dy);
    const bool is_inside = column >= 0.0 && column < double(at.columns) && row >= 0.0 &&
                           row < double(at.rows) &&
                           std::abs(at.x0 + column * dx - n[0]) <= std::min(kGridTolerance, dx / 10.0) &&
                           std::abs(at.y0 + row * dy - n[1]) <= std::min(kGridTolerance, dy / 10.0);
    return expect(is_inside, line,
                  fmt::format("a position of the grid that the map states: X {} to {} in {} columns, Y {} to "
                              "{} in {} rows",
                              number_text(at.x0, 4), number_text(at.x1, 4), at.columns, number_text(at.y0, 4),
                              number_text(at.y1, 4), at.rows)) &&
           points->put(line, static_cast<std::size_t>(column), static_cast<std::size_t>(row), n[0], n[1],
                       n[2]);
  };
  for_each_line(bytes, [&](std::size_t line, std::string_view text) {
    last = line;
    const auto numbers = sink.numbers(line, words_of(text));
    good = numbers.has_value();
    if (!good) return false;
    const Numbers& n = *numbers;
    if (index == 0) {
      good = expect(is_limits(n), line, "the limits of X and the number of columns, such as 0 100 5");
      if (good) at.x0 = n[0], at.x1 = n[1], at.columns = count_of(n[2]);
    } else if (index == 1) {
      good = expect(is_limits(n), line, "the limits of Y and the number of rows, such as 0 100 5");
      if (good) at.y0 = n[0], at.y1 = n[1], at.rows = count_of(n[2]);
    } else if (index == 2) {
      good = expect(is_probing(n), line, "the limits of Z and the feed of probing, such as -1 1 50");
      if (good) good = points.emplace(at, sink, sink.unit(), line).is_good();
    } else {
      good = take_point(line, n);
    }
    ++index;
    return good;
  });
  if (!good) return;
  if (points)
    points->finish(last);
  else
    expect(false, last, "three lines with the limits and the numbers of columns and rows");
}

}  // namespace kerf::heights_detail
