// Grids of heights whose size and area their file states.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "codec/heights/sink.h"

namespace kerf::heights_detail {

constexpr std::size_t kMaxLines = 2000;  // rows or columns of a map

/// A map of rows at equal distances over an area.
struct Rows {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  std::size_t columns = 0, rows = 0;

  double x(std::size_t i) const {
    return columns < 2 ? x0 : x0 + (x1 - x0) * double(i) / double(columns - 1);
  }
  double y(std::size_t j) const { return rows < 2 ? y0 : y0 + (y1 - y0) * double(j) / double(rows - 1); }
  /// Whether the limits ascend, as those of several columns and rows do.
  bool has_area() const { return x0 < x1 && y0 < y1; }
};

/// A number of rows or columns; 0 if it is none.
std::size_t count_of(std::optional<double> number);

/// The rows of a map whose size is known, from the lowest Y upwards.
class RowReader {
 public:
  RowReader(const Rows& at, const HeightsSink& sink, double unit) : at_(at), sink_(sink), unit_(unit) {}

  /// Heights that are NaN are points that were not measured.
  bool take(std::size_t line, const std::vector<double>& numbers);
  void finish() const;

 private:
  Rows at_;
  const HeightsSink& sink_;
  double unit_;
  std::size_t next_ = 0, last_line_ = 0;
};

/// The points of a grid in any order: each is needed once.
class GridPoints {
 public:
  /// Nothing is read of a grid of more points than are allowed: an error, and is_good() is false.
  GridPoints(const Rows& at, const HeightsSink& sink, double unit, std::size_t line);

  bool is_good() const { return !lines_.empty(); }
  /// The height at `column` and `row`, measured at x, y. False after an error.
  bool put(std::size_t line, std::size_t column, std::size_t row, double x, double y, double z);
  /// An error if a point is missing.
  void finish(std::size_t line) const;

 private:
  Rows at_;
  const HeightsSink& sink_;
  double unit_;
  std::size_t count_ = 0;
  std::vector<std::size_t> lines_;  // of the points; 0: missing
};

}  // namespace kerf::heights_detail
