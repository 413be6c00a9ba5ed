// Finding the squares between columns that walls go through.
#include "sim/walls.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "sim/parallel.h"

namespace kerf::sim {
namespace {

/// A step between two columns that exceeds what the slopes beside it explain by less than this much of a
/// pitch is left to the centres: curved surfaces have such steps everywhere.
constexpr Real kLeastStep = 0.25f;
/// The same between two level surfaces, where nothing else explains a step.
constexpr Real kLeastLevelStep = 0.002f;
/// How much of the lower of the steps beside it explains a step, if all three go the same way: a curve's
/// slope changes from column to column. And of the higher one: ridges and edges of slopes, whose error is
/// small against a wall's; but no more than so many pitches, as that one may be a wall itself.
constexpr Real kExplainedByLower = 2.0f;
constexpr Real kExplainedByHigher = 1.5f;
constexpr Real kMostExplained = 4.0f;
/// Most squares that are counted anew: a share of all and in any case this many; bounds the time.
constexpr double kMostShare = 0.25;
constexpr std::size_t kAlways = 1 << 16;
constexpr std::size_t kMostSquares = 1 << 22;

/// Micros that memory is asked for ahead.
constexpr int kAhead = 8;

constexpr int kGrades = 32;

/// Length of material of a column.
Real length_in(const Tile& tile, int index) {
  const int micro = index / kLanes, lane = index % kLanes;
  if (tile.chain[micro] < 0) return tile.top[micro][lane];
  Real length = 0;
  for (std::int32_t k = tile.chain[micro]; k >= 0; k = tile.slots[static_cast<std::size_t>(k)].next) {
    const Slot& slot = tile.slots[static_cast<std::size_t>(k)];
    if (slot.high[lane] > slot.low[lane]) length += slot.high[lane] - slot.low[lane];
  }
  return length;
}

Real length_at(const Workpiece::Body& body, int i, int j) {
  i = std::clamp(i, 0, body.nx - 1);  // beyond the block it goes on as at its border
  j = std::clamp(j, 0, body.ny - 1);
  const auto tile = static_cast<std::size_t>(j / kTileColumns) * static_cast<std::size_t>(body.tiles_x) +
                    static_cast<std::size_t>(i / kTileColumns);
  if (!body.tiles[tile]) return body.height;
  return length_in(*body.tiles[tile], lane_index(i % kTileColumns, j % kTileColumns));
}

/// A square that a wall may go through, and how high the highest step on its edges is, graded by powers of two
/// of the least that counts.
struct Candidate {
  Square square;
  std::int8_t grade;
  bool is_own;  // not another tile's, which has it too
};
using Candidates = std::vector<Candidate>;

/// Squares from -1 to the last column or row.
constexpr int kSquares = kTileColumns + 1;

/// The steps around the columns of one tile.
class Window {
 public:
  explicit Window(const Workpiece::Body& body);
  Candidates look(std::size_t tile);

 private:
  bool untouched(int tile_x, int tile_y) const;
  void read(int column, int row, const Tile* tile);
  void note(int x, int y, int grade);

  const Workpiece::Body& body_;
  StepRules rules_;
  int columns_ = 0, rows_ = 0;
  WindowLengths length_;
  std::int8_t grade_[kSquares][kSquares];  // by row and column from -1 on; -1: no wall
  std::vector<ColumnStep> steps_;
  std::vector<Square> noted_;
};

Window::Window(const Workpiece::Body& body) : body_(body) {
  const auto pitch = static_cast<Real>(body.pitch);
  rules_.explained_by_lower = kExplainedByLower;
  rules_.explained_by_higher = kExplainedByHigher;
  rules_.most_explained = kMostExplained * pitch;
  rules_.per_least = 1 / (kLeastStep * pitch);
  rules_.per_least_level = 1 / std::max(kLeastLevelStep * pitch, body.same_height);
  rules_.same_height = body.same_height;
  std::fill_n(grade_[0], kSquares * kSquares, std::int8_t{-1});
}

bool Window::untouched(int tile_x, int tile_y) const {
  for (int y = std::max(tile_y - 1, 0); y <= std::min(tile_y + 1, body_.tiles_y - 1); ++y)
    for (int x = std::max(tile_x - 1, 0); x <= std::min(tile_x + 1, body_.tiles_x - 1); ++x)
      if (body_.tiles[static_cast<std::size_t>(y) * static_cast<std::size_t>(body_.tiles_x) +
                      static_cast<std::size_t>(x)])
        return false;
  return true;
}

void Window::read(int column, int row, const Tile* tile) {
  for (int y = 0; y < kWindow; ++y) {
    const bool inside = tile != nullptr && y >= kRing && y < kRing + rows_;
    for (int x = 0; x < kWindow; ++x) {
      if (inside && x == kRing) x += columns_;
      if (x < kWindow) length_[y][x] = length_at(body_, column + x - kRing, row + y - kRing);
    }
  }
  if (tile == nullptr) return;
  for (int micro = 0; micro < kMicros; ++micro) {
    const Place place = place_of(micro * kLanes);
    if (place.x >= columns_ || place.y >= rows_) continue;
    Lanes lengths;
    tile->fetch(micro + kAhead);
    tile->lengths(micro, lengths);
    const int across = std::min(columns_ - place.x, 4);
    for (int y = 0; y < std::min(rows_ - place.y, 4); ++y)
      for (int x = 0; x < across; ++x) length_[place.y + y + kRing][place.x + x + kRing] = lengths[4 * y + x];
  }
}

void Window::note(int x, int y, int grade) {
  if (x < -1 || y < -1 || x >= columns_ || y >= rows_) return;
  std::int8_t& noted = grade_[y + 1][x + 1];
  if (noted < 0) noted_.push_back({static_cast<std::int8_t>(x), static_cast<std::int8_t>(y)});
  noted = static_cast<std::int8_t>(std::max<int>(noted, grade));
}

/// Neighbours follow each other, so that sixteen in a row lie close together.
int order_of(Square square) {
  const int beyond = (square.x < 0 ? 1 : 0) + (square.y < 0 ? 2 : 0);
  return 4 * lane_index(std::max<int>(square.x, 0), std::max<int>(square.y, 0)) + beyond;
}

Candidates Window::look(std::size_t tile) {
  const auto tiles_x = static_cast<std::size_t>(body_.tiles_x);
  const auto tile_x = static_cast<int>(tile % tiles_x), tile_y = static_cast<int>(tile / tiles_x);
  if (!body_.tiles[tile] && untouched(tile_x, tile_y)) return {};
  columns_ = body_.columns_x_of(tile);
  rows_ = body_.columns_y_of(tile);
  read(tile_x * kTileColumns, tile_y * kTileColumns, body_.tiles[tile].get());
  steps_.clear();
  find_steps(rules_, length_, steps_);
  noted_.clear();
  for (const ColumnStep& step : steps_) {
    const int x = step.x - kRing, y = step.y - kRing;
    const int grade = std::min(std::ilogb(step.excess), kGrades - 1);
    note(x, y, grade);
    note(step.way == StepWay::along_x ? x : x - 1, step.way == StepWay::along_x ? y - 1 : y, grade);
  }
  std::sort(noted_.begin(), noted_.end(), [](Square a, Square b) { return order_of(a) < order_of(b); });
  Candidates found;
  for (const Square square : noted_)
    found.push_back({square, grade_[square.y + 1][square.x + 1],
                     (square.x >= 0 || tile_x == 0) && (square.y >= 0 || tile_y == 0)});
  return found;
}

/// The lowest grade that leaves no more squares than are affordable.
int lowest_grade(const std::array<std::atomic<std::size_t>, kGrades>& count, const Workpiece::Body& body) {
  const double all = static_cast<double>(body.nx) * static_cast<double>(body.ny);
  const std::size_t most =
      std::min(kMostSquares, std::max(kAlways, static_cast<std::size_t>(kMostShare * all)));
  std::size_t sum = 0;
  int grade = kGrades;
  while (grade > 0 && sum + count[static_cast<std::size_t>(grade - 1)] <= most)
    sum += count[static_cast<std::size_t>(--grade)];
  return grade;
}

/// The squares with steps of at least a grade.
WallSquares squares_above(int grade, const Candidates& candidates, const Workpiece::Body& body,
                          std::size_t tile) {
  WallSquares walls{static_cast<std::uint32_t>(tile), {}, {}};
  const int columns = body.columns_x_of(tile), rows = body.columns_y_of(tile);
  std::vector<std::uint16_t> corners;
  for (const Candidate& candidate : candidates) {
    if (candidate.grade < grade) continue;
    const Square square = candidate.square;
    if (candidate.is_own) walls.squares.push_back(square);
    for (int y = std::max<int>(square.y, 0); y <= std::min(square.y + 1, rows - 1); ++y)
      for (int x = std::max<int>(square.x, 0); x <= std::min(square.x + 1, columns - 1); ++x)
        corners.push_back(static_cast<std::uint16_t>(lane_index(x, y)));
  }
  std::sort(corners.begin(), corners.end());
  for (const std::uint16_t corner : corners) {
    if (walls.quarters.empty() || walls.quarters.back().column != corner)
      walls.quarters.push_back({corner, 0});
    ++walls.quarters.back().count;
  }
  return walls;
}

}  // namespace

std::vector<WallSquares> find_walls(const Workpiece::Body& body, unsigned threads) {
  std::array<std::atomic<std::size_t>, kGrades> count{};
  std::vector<Candidates> candidates(body.tiles.size());
  const auto look = [&](std::size_t tile) {
    candidates[tile] = Window(body).look(tile);
    for (const Candidate& candidate : candidates[tile])
      if (candidate.is_own) ++count[static_cast<std::size_t>(candidate.grade)];
  };
  parallel_for(threads, body.tiles.size(), look, [] { return false; });
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
