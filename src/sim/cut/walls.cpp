// Finds the squares between columns that walls pass through.
#include "sim/cut/walls.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/parallel.h"

namespace kerf::sim {
namespace {

/// A step between two columns whose excess over what the slopes beside it explain is below this many pitches
/// is no wall: curved surfaces have such steps everywhere.
constexpr Real kMinStep = 0.25f;
/// The same between two level surfaces, where no slope explains a step.
constexpr Real kMinLevelStep = 0.002f;
/// A step is explained by this multiple of the lower of its neighbouring steps if all three have the same
/// sign (the slope of a curve changes from column to column), and by this multiple of the higher one (ridges
/// and edges of slopes, whose error is small against that of a wall), up to a maximum in pitches, as that one
/// may be a wall itself.
constexpr Real kExplainedByLower = 2.0f;
constexpr Real kExplainedByHigher = 1.5f;
constexpr Real kMaxExplained = 4.0f;
/// Maximum number of squares that are measured: this fraction of all, but at least kAlways, and at limit
/// kMaxSquares; bounds the time.
constexpr double kMaxFraction = 0.25;
constexpr std::size_t kAlways = 1 << 16;
constexpr std::size_t kMaxSquares = 1 << 22;

/// Prefetch distance, micros.
constexpr int kAhead = 8;

constexpr int kGrades = 32;

/// A square that a wall may pass through. `grade`: the highest step on its edges in powers of two of the
/// minimum step.
struct Candidate {
  WallSquare square;
  std::int8_t grade;
  bool is_own;  // this tile owns it (a neighbour may list it too)
};
using Candidates = std::vector<Candidate>;

/// Number of a square: four times that of the column at its low corner, plus bits for corners before the
/// tile. Sixteen in a row are close together in memory.
constexpr int kSquares = 4 * kMicros * kLanes;
int number_of(int x, int y) {
  return 4 * lane_index(std::max(x, 0), std::max(y, 0)) + (x < 0 ? 1 : 0) + (y < 0 ? 2 : 0);
}
WallSquare square_of(int number) {
  const ColumnInTile position = column_in_tile(number / 4);
  return {static_cast<std::int8_t>((number & 1) != 0 ? -1 : position.x),
          static_cast<std::int8_t>((number & 2) != 0 ? -1 : position.y)};
}

/// The steps around the columns of one tile.
class Window {
 public:
  explicit Window(const Workpiece::Body& body);
  Candidates find(std::size_t tile);

 private:
  bool untouched(int tile_x, int tile_y) const;
  void read(const Tile* tile);
  void read_micro(int column, int row);
  void extend_borders();
  void note(int x, int y, int grade);

  const Workpiece::Body& body_;
  StepRules rules_;
  int columns_ = 0, rows_ = 0;            // of the tile
  int first_column_ = 0, first_row_ = 0;  // of the tile
  WindowLengths length_;
  std::int8_t grade_[kSquares];  // by number, valid where `noted_`
  std::array<std::uint64_t, kSquares / 64> noted_{};
  std::vector<ColumnStep> steps_;
};

Window::Window(const Workpiece::Body& body) : body_(body) {
  const auto pitch = static_cast<Real>(body.pitch);
  rules_.explained_by_lower = kExplainedByLower;
  rules_.explained_by_higher = kExplainedByHigher;
  rules_.max_explained = kMaxExplained * pitch;
  rules_.per_min = 1 / (kMinStep * pitch);
  rules_.per_min_level = 1 / std::max(kMinLevelStep * pitch, body.same_height);
  rules_.same_height = body.same_height;
}

bool Window::untouched(int tile_x, int tile_y) const {
  for (int y = std::max(tile_y - 1, 0); y <= std::min(tile_y + 1, body_.tiles_y - 1); ++y)
    for (int x = std::max(tile_x - 1, 0); x <= std::min(tile_x + 1, body_.tiles_x - 1); ++x)
      if (body_.tiles[static_cast<std::size_t>(y) * static_cast<std::size_t>(body_.tiles_x) +
                      static_cast<std::size_t>(x)])
        return false;
  return true;
}

/// Reads the lengths of the micro with its first column at a position.
void Window::read_micro(int column, int row) {
  const std::size_t number =
      static_cast<std::size_t>((row + first_row_) / kTileColumns) * static_cast<std::size_t>(body_.tiles_x) +
      static_cast<std::size_t>((column + first_column_) / kTileColumns);
  const Tile* tile = body_.tiles[number].get();
  const int x = column & (kTileColumns - 1), y = row & (kTileColumns - 1);
  Lanes lengths;
  if (tile != nullptr) {
    tile->lengths(lane_index(x, y) / kLanes, lengths);
  } else {
    std::fill_n(lengths.v, kLanes, body_.height);
  }
  for (int k = 0; k < 4; ++k)
    std::memcpy(&length_[row + kRing + k][column + kRing], lengths.v + 4 * k, 4 * sizeof(Real));
}

/// Repeats the columns at the borders of the block beyond them.
void Window::extend_borders() {
  const int left = std::max(-first_column_, -kRing) + kRing, low = std::max(-first_row_, -kRing) + kRing;
  const int right = std::min(body_.nx - first_column_ + kRing, kWindow) - 1;
  const int high = std::min(body_.ny - first_row_ + kRing, kWindow) - 1;
  for (int y = low; y <= high; ++y) {
    std::fill(length_[y], length_[y] + left, length_[y][left]);
    std::fill(length_[y] + right + 1, length_[y] + kWindow, length_[y][right]);
  }
  for (int y = 0; y < low; ++y) std::copy_n(length_[low], kWindow, length_[y]);
  for (int y = high + 1; y < kWindow; ++y) std::copy_n(length_[high], kWindow, length_[y]);
}

/// Reads the lengths of a tile and its surroundings.
void Window::read(const Tile* tile) {
  const auto read_if_any = [&](int column, int row) {
    const int i = column + first_column_, j = row + first_row_;
    if (i >= 0 && j >= 0 && i < body_.nx && j < body_.ny) read_micro(column, row);
  };
  for (int micro = 0; micro < kMicros; ++micro) {
    if (tile != nullptr) tile->fetch(micro + kAhead);
    read_if_any(column_of(micro), row_of(micro));
  }
  for (int k = -kRing; k <= kTileColumns; k += 4) {
    read_if_any(k, -kRing);
    read_if_any(k, kTileColumns);
    read_if_any(-kRing, k);
    read_if_any(kTileColumns, k);
  }
  extend_borders();
}

void Window::note(int x, int y, int grade) {
  if (x < -1 || y < -1 || x >= columns_ || y >= rows_) return;
  const int number = number_of(x, y);
  std::uint64_t& noted = noted_[static_cast<std::size_t>(number / 64)];
  const std::uint64_t bit = std::uint64_t{1} << (number % 64);
  if ((noted & bit) == 0) grade_[number] = 0;
  noted |= bit;
  grade_[number] = static_cast<std::int8_t>(std::max<int>(grade_[number], grade));
}

Candidates Window::find(std::size_t tile) {
  const auto tiles_x = static_cast<std::size_t>(body_.tiles_x);
  const auto tile_x = static_cast<int>(tile % tiles_x), tile_y = static_cast<int>(tile / tiles_x);
  if (!body_.tiles[tile] && untouched(tile_x, tile_y)) return {};
  columns_ = body_.columns_x_of(tile);
  rows_ = body_.columns_y_of(tile);
  first_column_ = tile_x * kTileColumns;
  first_row_ = tile_y * kTileColumns;
  read(body_.tiles[tile].get());
  steps_.clear();
  find_steps(rules_, length_, steps_);
  noted_ = {};
  for (const ColumnStep& step : steps_) {
    const int x = step.x - kRing, y = step.y - kRing;
    const int grade = std::min(std::ilogb(step.excess), kGrades - 1);
    note(x, y, grade);
    note(step.axis == StepAxis::along_x ? x : x - 1, step.axis == StepAxis::along_x ? y - 1 : y, grade);
  }
  Candidates found;
  for (std::size_t word = 0; word < noted_.size(); ++word) {
    for (std::uint64_t rest = noted_[word]; rest != 0; rest &= rest - 1) {
      const int number = static_cast<int>(word * 64) + __builtin_ctzll(rest);
      const WallSquare square = square_of(number);
      found.push_back(
          {square, grade_[number], (square.x >= 0 || tile_x == 0) && (square.y >= 0 || tile_y == 0)});
    }
  }
  return found;
}

/// The lowest grade for which the number of squares stays within the maximum.
int lowest_grade(const std::array<std::atomic<std::size_t>, kGrades>& count, const Workpiece::Body& body) {
  const double all = static_cast<double>(body.nx) * static_cast<double>(body.ny);
  const std::size_t limit =
      std::min(kMaxSquares, std::max(kAlways, static_cast<std::size_t>(kMaxFraction * all)));
  std::size_t sum = 0;
  int grade = kGrades;
  while (grade > 0 && sum + count[static_cast<std::size_t>(grade - 1)] <= limit)
    sum += count[static_cast<std::size_t>(--grade)];
  return grade;
}

/// Maximum height of a step of a grade, pitches.
double highest_step(int grade) {
  return std::ldexp(static_cast<double>(kMinStep), grade + 1) + static_cast<double>(kMaxExplained);
}

/// The squares with steps of at least this grade.
WallSquares squares_above(int grade, const Candidates& candidates, const Workpiece::Body& body,
                          std::size_t tile) {
  WallSquares walls;
  walls.tile = static_cast<std::uint32_t>(tile);
  if (candidates.empty()) return walls;
  const int columns = body.columns_x_of(tile), rows = body.columns_y_of(tile);
  std::uint8_t quarters[kMicros][kLanes] = {};
  bool any_in[kMicros] = {};
  for (const Candidate& candidate : candidates) {
    if (candidate.grade < grade) continue;
    const WallSquare square = candidate.square;
    if (candidate.is_own) {
      walls.squares.push_back(square);
      walls.max_error += highest_step(candidate.grade) * body.pitch;
    }
    for (int y = std::max<int>(square.y, 0); y <= std::min(square.y + 1, rows - 1); ++y) {
      for (int x = std::max<int>(square.x, 0); x <= std::min(square.x + 1, columns - 1); ++x) {
        const int column = lane_index(x, y);
        const int quarter = (x == square.x ? 1 : 0) + (y == square.y ? 2 : 0);
        quarters[column / kLanes][column % kLanes] |= static_cast<std::uint8_t>(1 << quarter);
        any_in[column / kLanes] = true;
      }
    }
  }
  for (int micro = 0; micro < kMicros; ++micro)
    for (int lane = 0; lane < kLanes && any_in[micro]; ++lane)
      if (const std::uint8_t taken = quarters[micro][lane]; taken != 0)
        walls.quarters.push_back({static_cast<std::uint16_t>(micro * kLanes + lane), taken});
  return walls;
}

}  // namespace

std::vector<WallSquares> find_walls(const Workpiece::Body& body, unsigned threads) {
  std::array<std::atomic<std::size_t>, kGrades> count{};
  std::vector<Candidates> candidates(body.tiles.size());
  const auto find_candidates = [&](std::size_t tile) {
    candidates[tile] = Window(body).find(tile);
    for (const Candidate& candidate : candidates[tile])
      if (candidate.is_own) ++count[static_cast<std::size_t>(candidate.grade)];
  };
  parallel_for(threads, body.tiles.size(), find_candidates, [] { return false; });
  const int lowest = lowest_grade(count, body);
  std::vector<WallSquares> found(body.tiles.size());
  const auto choose = [&](std::size_t tile) {
    found[tile] = squares_above(lowest, candidates[tile], body, tile);
  };
  parallel_for(threads, body.tiles.size(), choose, [] { return false; });
  const auto has_none = [](const WallSquares& walls) { return walls.quarters.empty(); };
  found.erase(std::remove_if(found.begin(), found.end(), has_none), found.end());
  return found;
}

}  // namespace kerf::sim
