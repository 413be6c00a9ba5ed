// Left-over stock as a file (.kstock): the exact columns of a workpiece for the next job.
//
// The bytes, lowest first: "KERFSTK1"; the block's low and high corner (6 doubles, mm), the first column's x
// and y and the pitch (3 doubles), columns in x and y (2 x 4 bytes); then, row by row, groups of equal
// columns: their number, the number of runs, and low and high of each run (floats, mm above the block's
// floor). Counts are integers of 7 bits per byte, the lowest first; the eighth bit means that more follow.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"

namespace kerf {

struct ColumnData {
  std::array<double, 3> low{}, high{};     // mm, the block's corners
  double x = 0.0, y = 0.0, pitch = 1.0;    // mm, the centre of the first column
  std::uint32_t nx = 0, ny = 0;            // columns
  std::vector<std::uint32_t> first;        // column n has the runs first[n] to first[n + 1] - 1
  std::vector<std::array<float, 2>> runs;  // low and high, mm above the floor
};

struct ColumnLimits {
  std::size_t columns = limits::kMaxLeftOverColumns;
  std::size_t runs = limits::kMaxLeftOverIntervals;
};

std::string write_columns(const ColumnData& columns);
/// Appends an error under the file's name, and returns nothing, for anything that write_columns cannot have
/// written and beyond the limits.
std::optional<ColumnData> read_columns(std::string_view bytes, const std::string& name,
                                       Diagnostics& diagnostics, const ColumnLimits& limits = {});

}  // namespace kerf
