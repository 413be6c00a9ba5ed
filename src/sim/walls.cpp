// Finding the columns that walls go through, and counting them at 16 points each.
#include "sim/walls.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "sim/parallel.h"
#include "sim/start.h"

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
/// Most columns that are counted anew: a share of all columns and in any case this many; bounds the time.
constexpr double kMostShare = 0.25;
constexpr std::size_t kAlways = 1 << 16;
constexpr std::size_t kMostColumns = 1 << 22;
/// Columns kept as points at a time; bounds the memory to about 100 MB.
constexpr std::size_t kGroupColumns = 1 << 16;

/// Micros that memory is asked for ahead.
constexpr int kAhead = 8;

// ---- finding

constexpr int kGrades = 32;

/// Place of a column in its tile, from its lane_index.
struct Place {
  int x, y;
};
Place place_of(int index) {
  const int super = index >> 8, micro = (index >> 4) & 15, lane = index & 15;
  return {(super & 3) * 16 + (micro & 3) * 4 + (lane & 3),
          (super >> 2) * 16 + (micro >> 2) * 4 + (lane >> 2)};
}

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

/// The columns of a tile that walls may go through, by lane_index, and how high the steps there are, graded
/// by powers of two of the least that counts.
struct Candidates {
  std::vector<std::uint16_t> columns;
  std::vector<std::int8_t> grades;
};

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
  std::int8_t grade_[kTileColumns * kTileColumns];  // by lane_index; -1: no wall
  std::vector<ColumnStep> steps_;
  std::vector<std::uint16_t> noted_;
};

Window::Window(const Workpiece::Body& body) : body_(body) {
  const auto pitch = static_cast<Real>(body.pitch);
  rules_.explained_by_lower = kExplainedByLower;
  rules_.explained_by_higher = kExplainedByHigher;
  rules_.most_explained = kMostExplained * pitch;
  rules_.per_least = 1 / (kLeastStep * pitch);
  rules_.per_least_level = 1 / std::max(kLeastLevelStep * pitch, body.same_height);
  rules_.same_height = body.same_height;
  std::fill(std::begin(grade_), std::end(grade_), std::int8_t{-1});
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
  if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return;
  const int index = lane_index(x, y);
  if (grade_[index] < 0) noted_.push_back(static_cast<std::uint16_t>(index));
  grade_[index] = static_cast<std::int8_t>(std::max<int>(grade_[index], grade));
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
    note(step.way == StepWay::along_x ? x + 1 : x, step.way == StepWay::along_x ? y : y + 1, grade);
  }
  Candidates found;
  std::sort(noted_.begin(), noted_.end());
  for (const std::uint16_t index : noted_) {
    found.columns.push_back(index);
    found.grades.push_back(std::exchange(grade_[index], std::int8_t{-1}));
  }
  return found;
}

/// The lowest grade that leaves no more columns than are affordable.
int lowest_grade(const std::array<std::atomic<std::size_t>, kGrades>& count, const Workpiece::Body& body) {
  const double all = static_cast<double>(body.nx) * static_cast<double>(body.ny);
  const std::size_t most =
      std::min(kMostColumns, std::max(kAlways, static_cast<std::size_t>(kMostShare * all)));
  std::size_t sum = 0;
  int grade = kGrades;
  while (grade > 0 && sum + count[static_cast<std::size_t>(grade - 1)] <= most)
    sum += count[static_cast<std::size_t>(--grade)];
  return grade;
}

// ---- points

/// Numbers between 0 and 1 that follow no pattern, from a column's place.
std::uint32_t scrambled(std::uint32_t i, std::uint32_t j) {
  std::uint32_t v = i * 0x9e3779b1u ^ (j * 0x85ebca77u + 0x165667b1u);
  v = (v ^ (v >> 15)) * 0x2c1b3c6du;
  v = (v ^ (v >> 12)) * 0x297a2d39u;
  return v ^ (v >> 15);
}
Real unit_share(std::uint32_t bits) { return static_cast<Real>(bits & 0xffffu) / 65536.0f; }

/// Leaves only the micros that `wanted` names to be cut.
template <class Wanted>
void keep_micros(Tile& tile, const Wanted& wanted) {
  for (int micro = 0; micro < kMicros; ++micro)
    if (!wanted(micro)) tile.micro_top[micro] = -kFar;
  for (int super = 0; super < kSupers; ++super)
    tile.super_top[super] =
        *std::max_element(tile.micro_top + super * kSupers, tile.micro_top + (super + 1) * kSupers);
}

/// A square around each 16 columns that are points.
void enclose(PointPlaces& points, int count, Real pitch) {
  for (int super = 0; super * kSupers < count; ++super) {
    const int begin = super * kSupers, end = std::min(count, begin + kSupers);
    const auto [x0, x1] = std::minmax_element(points.x + begin, points.x + end);
    const auto [y0, y1] = std::minmax_element(points.y + begin, points.y + end);
    points.super_x[super] = 0.5f * (*x0 + *x1);
    points.super_y[super] = 0.5f * (*y0 + *y1);
    points.super_half[super] = 0.5f * std::max(*x1 - *x0, *y1 - *y0) + 0.5f * pitch;
  }
}

double weighted_length(const Tile& tile, const std::vector<Real>& weights) {
  double sum = 0.0;
  for (int micro = 0; micro < kMicros; ++micro) {
    const Real* weight = weights.data() + micro * kLanes;
    if (std::all_of(weight, weight + kLanes, [](Real v) { return v == 0; })) continue;
    Lanes lengths;
    tile.fetch(micro + kAhead);
    tile.lengths(micro, lengths);
    for (int i = 0; i < kLanes; ++i) sum += static_cast<double>(lengths[i]) * static_cast<double>(weight[i]);
  }
  return sum;
}

}  // namespace

std::vector<WallColumns> find_walls(const Workpiece::Body& body, unsigned threads) {
  std::array<std::atomic<std::size_t>, kGrades> count{};
  std::vector<Candidates> candidates(body.tiles.size());
  const auto look = [&](std::size_t tile) {
    candidates[tile] = Window(body).look(tile);
    for (const std::int8_t grade : candidates[tile].grades) ++count[static_cast<std::size_t>(grade)];
  };
  parallel_for(threads, body.tiles.size(), look, [] { return false; });
  const int lowest = lowest_grade(count, body);
  std::vector<WallColumns> found;
  for (std::size_t tile = 0; tile < candidates.size(); ++tile) {
    const Candidates& here = candidates[tile];
    WallColumns walls{static_cast<std::uint32_t>(tile), {}};
    for (std::size_t n = 0; n < here.columns.size(); ++n)
      if (here.grades[n] >= lowest) walls.columns.push_back(here.columns[n]);
    if (!walls.columns.empty()) found.push_back(std::move(walls));
  }
  return found;
}

WallTile::WallTile(const Workpiece::Body& body, const WallColumns& walls, Parts& store)
    : centres_(body.height, body.columns_x_of(walls.tile), body.columns_y_of(walls.tile)),
      centre_weights_(kMicros * kLanes, 0.0f) {
  fill_start_tile(body, walls.tile, centres_);
  const auto tiles_x = static_cast<std::uint32_t>(body.tiles_x);
  const int column = static_cast<int>(walls.tile % tiles_x) * kTileColumns;
  const int row = static_cast<int>(walls.tile / tiles_x) * kTileColumns;
  bool has_wall[kMicros] = {};
  for (const std::uint16_t index : walls.columns) {
    const Place place = place_of(index);
    centre_weights_[index] = -static_cast<Real>(body.share_x(column + place.x) * body.share_y(row + place.y));
    has_wall[index / kLanes] = true;
  }
  keep_micros(centres_, [&](int micro) { return has_wall[micro]; });
  const auto pitch = static_cast<Real>(body.pitch);
  for (std::size_t first = 0; first < walls.columns.size(); first += kMicros) {
    const int count = static_cast<int>(std::min<std::size_t>(kMicros, walls.columns.size() - first));
    Part& part = *parts_.emplace_back(store.make(body.height));
    part.weights.assign(kMicros * kLanes, 0.0f);
    for (int n = 0; n < count; ++n)
      add_point_column(part, body, walls.tile, n, walls.columns[first + static_cast<std::size_t>(n)]);
    enclose(part.points, count, pitch);
    if (body.start) refresh_bounds(part.tile);
    keep_micros(part.tile, [&](int micro) { return micro < count; });
  }
}

void WallTile::add_point_column(Part& part, const Workpiece::Body& body, std::uint32_t tile, int number,
                                int lane) const {
  const auto tiles_x = static_cast<std::uint32_t>(body.tiles_x);
  const Place place = place_of(lane);
  const int i = static_cast<int>(tile % tiles_x) * kTileColumns + place.x;
  const int j = static_cast<int>(tile / tiles_x) * kTileColumns + place.y;
  const double share_x = body.share_x(i), share_y = body.share_y(j);
  PointPlaces& points = part.points;
  points.x[number] = static_cast<Real>((place.x - 0.5 + 0.5 * share_x) * body.pitch);
  points.y[number] = static_cast<Real>((place.y - 0.5 + 0.5 * share_y) * body.pitch);
  points.size_x[number] = static_cast<Real>(share_x * body.pitch);
  points.size_y[number] = static_cast<Real>(share_y * body.pitch);
  const std::uint32_t bits = scrambled(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
  points.shift_x[number] = unit_share(bits);
  points.shift_y[number] = unit_share(bits >> 16);
  if (body.start) put_start_column(body, i, j, part.tile, number);
  std::fill_n(part.weights.begin() + number * kLanes, kLanes, static_cast<Real>(share_x * share_y / kLanes));
}

void WallTile::cut(TileJob job) {
  std::vector<double> removed(job.count);
  double* const sum = job.removed;
  job.removed = removed.data();
  const auto cut_one = [&](Tile& tile, const std::vector<Real>& weights, const PointPlaces* points) {
    job.tile = &tile;
    job.weights = weights.data();
    job.points = points;
    cut_tile(job);
    for (std::size_t k = 0; k < job.count; ++k) sum[k] += removed[k];
    job.contacts->clear();  // the columns' centres have told them
  };
  cut_one(centres_, centre_weights_, nullptr);
  for (const Parts::Pointer& part : parts_) cut_one(part->tile, part->weights, &part->points);
}

double WallTile::excess() const {
  double sum = weighted_length(centres_, centre_weights_);
  for (const Parts::Pointer& part : parts_) sum += weighted_length(part->tile, part->weights);
  return sum;
}

WallGroup::WallGroup(const Workpiece::Body& body, const std::vector<WallColumns>& found, std::size_t& next,
                     unsigned threads)
    : threads_(threads), wanted_(body.tiles.size(), false), place_(body.tiles.size(), 0) {
  const std::size_t first = next;
  for (std::size_t columns = 0; next < found.size() && columns < kGroupColumns; ++next) {
    const WallColumns& walls = found[next];
    columns += walls.columns.size();
    wanted_[walls.tile] = true;
    place_[walls.tile] = static_cast<std::uint32_t>(next - first);
  }
  walls_.resize(next - first);
  parallel_for(
      threads_, walls_.size(),
      [&](std::size_t n) { walls_[n] = store_.make(body, found[first + n], parts_); }, [] { return false; });
}

double WallGroup::excess() const {
  std::vector<double> each(walls_.size());
  parallel_for(
      threads_, walls_.size(), [&](std::size_t n) { each[n] = walls_[n]->excess(); }, [] { return false; });
  double sum = 0.0;
  for (const double excess : each) sum += excess;
  return sum;
}

}  // namespace kerf::sim
