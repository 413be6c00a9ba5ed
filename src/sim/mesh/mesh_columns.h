// The columns for meshing: squares of 64 x 64 columns, row by row. An uncut square takes no memory, one
// without undercuts and through cuts two heights and two steps per column.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/dexel/blocks.h"

#include "kerf/sim/mesh.h"

namespace kerf::meshing {

inline constexpr int kSquare = 64;  // columns along a square's side
inline constexpr int kSquareColumns = kSquare * kSquare;

/// One end of each column of a square.
struct Ends {
  Ends() {}  // not cleared, as all are filled next
  std::array<float, kSquareColumns> z;
  std::array<std::uint32_t, kSquareColumns> step;
};

/// The columns of a square in which not every column has exactly one interval: column c has runs[first[c]] to
/// runs[first[c + 1] - 1].
struct ManyRuns {
  std::array<std::uint32_t, kSquareColumns + 1> first;
  std::vector<Interval> runs;
};

/// The lowest and the highest end of each column, of which the caps are made. The high end of an empty column
/// has the step that removed its last material.
struct ColumnSquare {
  const Ends* low = nullptr;
  const Ends* high = nullptr;
  const ManyRuns* many = nullptr;  // null: each column is one interval
  // Whether all these ends have the same height and step.
  bool is_low_level = false, is_high_level = false;
  /// All columns have one interval, the same one.
  bool is_uniform() const { return many == nullptr && is_low_level && is_high_level; }
};

/// The intervals of a column, lowest first.
using Runs = std::span<const Interval>;

/// Squares of a workpiece: `count_x` by `count_y` of them from (x, y) on.
struct SquareRange {
  int x = 0, y = 0;
  int count_x = 0, count_y = 0;
};

/// Reads columns by number. An interval has two ends: end 2k is the low one of interval k, 2k + 1 the high
/// one.
class Columns {
 public:
  Columns(const Workpiece& workpiece, unsigned threads);
  /// The columns of some squares alone, as if they were the whole workpiece.
  Columns(const Workpiece& workpiece, const SquareRange& squares, unsigned threads);
  Columns(const ColumnGrid& grid, unsigned threads);
  Columns(const Columns&) = delete;

  int nx() const { return frame_.nx; }
  int ny() const { return frame_.ny; }
  double pitch() const { return frame_.pitch; }
  double height() const { return height_; }
  bool has_material() const { return has_material_; }
  /// Block, pitch and numbers of the columns, without the columns.
  const ColumnGrid& frame() const { return frame_; }
  /// Position of corner number i (0 to nx) above the block's low side; the last lies on the block's high
  /// side.
  double corner_x(int i) const { return i >= nx() ? size_x_ : std::min(i * pitch(), size_x_); }
  double corner_y(int j) const { return j >= ny() ? size_y_ : std::min(j * pitch(), size_y_); }
  /// Whether some of the four columns around an inner corner are narrower than a pitch.
  bool uneven(int i, int j) const { return (i == nx() - 1 && narrow_x_) || (j == ny() - 1 && narrow_y_); }
  bool has_narrow() const { return narrow_x_ || narrow_y_; }
  bool narrow_x() const { return narrow_x_; }
  bool narrow_y() const { return narrow_y_; }

  int squares_x() const { return squares_x_; }
  int squares_y() const { return squares_y_; }
  const ColumnSquare& square(int x, int y) const {
    return squares_[static_cast<std::size_t>(y) * static_cast<std::size_t>(squares_x()) +
                    static_cast<std::size_t>(x)];
  }
  /// The square of a column in the grid.
  const ColumnSquare& square_of(int i, int j) const {
    const std::size_t x = static_cast<unsigned>(i) / kSquare, y = static_cast<unsigned>(j) / kSquare;
    return squares_[y * static_cast<unsigned>(squares_x_) + x];
  }
  /// Number of a column in its square.
  static std::size_t cell(int i, int j) {
    return std::size_t{static_cast<unsigned>(j) % kSquare * kSquare + static_cast<unsigned>(i) % kSquare};
  }

  /// Whether all columns from `low` to `high` along both axes that are in the grid have their lowest ends at
  /// one height.
  bool have_level_floor(int low_i, int low_j, int high_i, int high_j) const {
    const int first_x = std::max(low_i, 0) / kSquare, last_x = std::min(high_i, nx() - 1) / kSquare;
    const int first_y = std::max(low_j, 0) / kSquare, last_y = std::min(high_j, ny() - 1) / kSquare;
    const float z = square(first_x, first_y).low->z[0];
    for (int y = first_y; y <= last_y; ++y)
      for (int x = first_x; x <= last_x; ++x)
        if (const ColumnSquare& s = square(x, y); !s.is_low_level || s.low->z[0] != z) return false;
    return true;
  }

  bool inside(int i, int j) const { return i >= 0 && j >= 0 && i < nx() && j < ny(); }
  /// Ends of a column; 0 outside the grid.
  int ends(int i, int j) const {
    if (!inside(i, j)) return 0;
    const ColumnSquare& s = square_of(i, j);
    if (s.many == nullptr) return 2;
    const std::size_t c = cell(i, j);
    return 2 * static_cast<int>(s.many->first[c + 1] - s.many->first[c]);
  }
  /// The intervals of a column, none outside the grid. `one`: storage for the interval of a column without a
  /// list.
  Runs runs(int i, int j, Interval& one) const {
    if (!inside(i, j)) return {};
    const ColumnSquare& s = square_of(i, j);
    const std::size_t c = cell(i, j);
    if (s.many != nullptr)
      return {s.many->runs.data() + s.many->first[c], std::size_t{s.many->first[c + 1] - s.many->first[c]}};
    one = {s.low->z[c], s.high->z[c], s.low->step[c], s.high->step[c]};
    return {&one, 1};
  }
  double z(int i, int j, int end) const {
    const ColumnSquare& s = square_of(i, j);
    const std::size_t c = cell(i, j);
    if (s.many == nullptr) return static_cast<double>(end == 0 ? s.low->z[c] : s.high->z[c]);
    const Interval& run = s.many->runs[s.many->first[c] + static_cast<std::size_t>(end / 2)];
    return static_cast<double>(end % 2 == 0 ? run.low : run.high);
  }
  std::uint32_t step(int i, int j, int end) const {
    const ColumnSquare& s = square_of(i, j);
    const std::size_t c = cell(i, j);
    if (s.many == nullptr) return end == 0 ? s.low->step[c] : s.high->step[c];
    const Interval& run = s.many->runs[s.many->first[c] + static_cast<std::size_t>(end / 2)];
    return end % 2 == 0 ? run.low_step : run.high_step;
  }
  /// The step that removed the last material of an empty column.
  std::uint32_t cut_through(int i, int j) const {
    return inside(i, j) ? square_of(i, j).high->step[cell(i, j)] : kStockSurface;
  }

 private:
  Columns(ColumnGrid frame, float full_height);
  /// Columns of a square that are in the grid.
  int columns_x(std::size_t square) const;
  int columns_y(std::size_t square) const;
  Ends& own(std::size_t square, int end);
  /// Fills square `number` from a tile.
  void read_tile(const Workpiece::Body& body, std::size_t number, std::size_t tile_number);
  void read_grid(const ColumnGrid& grid, std::size_t number);
  /// Calls add(x, y, runs) for each column of a square; add appends the column's intervals and returns the
  /// step that cut through an empty column.
  template <class Add>
  void fill_many(std::size_t number, const Add& add);
  template <class Read>
  void fill(unsigned threads, const Read& read);
  bool is_level(std::size_t number, const Ends& ends) const;

  ColumnGrid frame_;
  int squares_x_, squares_y_;
  double size_x_, size_y_, height_;
  bool narrow_x_, narrow_y_;  // the last column of a row, the last row
  bool has_material_ = false;
  std::vector<ColumnSquare> squares_;
  sim::BlockStore<Ends> store_;
  // Storage of the squares' pointers: ends of their own, or common ones.
  std::vector<std::array<sim::BlockStore<Ends>::Pointer, 2>> own_;
  std::vector<std::unique_ptr<const ManyRuns>> many_;
  sim::BlockStore<Ends>::Pointer floor_,
      full_;  // low ends of columns on the floor; high ends of uncut columns
};

}  // namespace kerf::meshing

namespace kerf {

/// Implementation of MeshColumns.
struct MeshColumns::Body {
  template <class... From>
  explicit Body(const From&... from) : columns(from...) {}
  meshing::Columns columns;
};

}  // namespace kerf
