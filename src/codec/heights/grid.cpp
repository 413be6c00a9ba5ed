// Grids of heights whose size and area their file states.
#include "codec/heights/grid.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/number.h"

namespace kerf::heights_detail {

std::size_t count_of(std::optional<double> number) {
  if (!number || !(*number >= 1.0 && *number <= double(kMaxLines)) || *number != std::floor(*number))
    return 0;
  return static_cast<std::size_t>(*number);
}

bool RowReader::take(std::size_t line, const std::vector<double>& numbers) {
  if (next_ == at_.rows) {
    sink_.error(codes::heights_format, line,
                fmt::format("the map has more rows than the {} that it states", at_.rows));
    return false;
  }
  if (numbers.size() != at_.columns) {
    sink_.error(codes::heights_format, line,
                fmt::format("expected {} heights in this row, found {}", at_.columns, numbers.size()));
    return false;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!std::isnan(numbers[i]) && !sink_.add(line, at_.x(i), at_.y(next_), numbers[i], unit_)) return false;
  ++next_;
  last_line_ = line;
  return true;
}

void RowReader::finish() const {
  if (next_ < at_.rows)
    sink_.error(codes::heights_format, last_line_,
                fmt::format("the map states {} rows and ends here after {}", at_.rows, next_));
}

GridPoints::GridPoints(const Rows& at, const HeightsSink& sink, double unit, std::size_t line)
    : at_(at), sink_(sink), unit_(unit) {
  if (at.columns * at.rows <= sink.options.max_heights)
    lines_.assign(at.columns * at.rows, 0);
  else
    sink.error(codes::level_map, line, fmt::format("more than {} heights", sink.options.max_heights));
}

bool GridPoints::put(std::size_t line, std::size_t column, std::size_t row, double x, double y, double z) {
  std::size_t& known = lines_[row * at_.columns + column];
  if (known != 0) {
    sink_.error(codes::heights_format, line,
                fmt::format("the point at X{} Y{} is given a second time, after line {}", number_text(x, 4),
                            number_text(y, 4), known));
    return false;
  }
  known = line;
  ++count_;
  return sink_.add(line, x, y, z, unit_);
}

void GridPoints::finish(std::size_t line) const {
  if (count_ == lines_.size()) return;
  const auto missing = static_cast<std::size_t>(std::find(lines_.begin(), lines_.end(), 0u) - lines_.begin());
  sink_
      .error(codes::heights_format, line,
             fmt::format("the map states {} x {} points and has {}; the first that is missing is at X{} Y{}",
                         at_.columns, at_.rows, count_, number_text(at_.x(missing % at_.columns), 4),
                         number_text(at_.y(missing / at_.columns), 4)))
      .hint = "measure the whole grid, or copy the whole file";
}

}  // namespace kerf::heights_detail
