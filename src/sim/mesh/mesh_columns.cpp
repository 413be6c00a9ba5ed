// Copies the columns of a workpiece or a grid into squares.
#include "sim/mesh/mesh_columns.h"

#include <cstring>

#include "base/parallel.h"
#include "sim/dexel/tile.h"

namespace kerf::meshing {
namespace {

/// A last column is narrower only if it lacks more than this fraction of a pitch.
constexpr double kRounding = 1e-6;

static_assert(kSquare == sim::kTileColumns, "a tile becomes a square");

/// The tops of a tile's columns, row by row instead of micro by micro.
void copy_tops(const sim::Tile& tile, Ends& out) {
  constexpr std::size_t kRow = 4;  // columns of a micro's row
  for (int micro = 0; micro < sim::kMicros; ++micro) {
    const std::size_t at = Columns::cell(sim::column_of(micro), sim::row_of(micro));
    for (std::size_t row = 0; row < kRow; ++row) {
      std::memcpy(out.z.data() + at + row * kSquare, tile.top[micro].v + kRow * row, kRow * sizeof(float));
      std::memcpy(out.step.data() + at + row * kSquare, tile.top_step[micro] + kRow * row,
                  kRow * sizeof(std::uint32_t));
    }
  }
}

/// Block, pitch and numbers of the columns of some squares.
ColumnGrid frame_of(const Workpiece& workpiece, const SquareRange& squares) {
  const Box3& bounds = workpiece.bounds();
  const double pitch = workpiece.pitch().mm();
  const int i = squares.x * kSquare, j = squares.y * kSquare;
  const int end_i = std::min(i + squares.count_x * kSquare, workpiece.columns_x());
  const int end_j = std::min(j + squares.count_y * kSquare, workpiece.columns_y());
  ColumnGrid frame{
      .bounds = bounds, .pitch = pitch, .nx = end_i - i, .ny = end_j - j, .first = {}, .intervals = {}};
  frame.bounds.low.x += i * pitch;
  frame.bounds.low.y += j * pitch;
  if (end_i < workpiece.columns_x()) frame.bounds.high.x = bounds.low.x + end_i * pitch;
  if (end_j < workpiece.columns_y()) frame.bounds.high.y = bounds.low.y + end_j * pitch;
  return frame;
}

}  // namespace

Columns::Columns(ColumnGrid frame, float full_height)
    : frame_(std::move(frame)),
      squares_x_((nx() + kSquare - 1) / kSquare),
      squares_y_((ny() + kSquare - 1) / kSquare),
      size_x_(frame_.bounds.high.x - frame_.bounds.low.x),
      size_y_(frame_.bounds.high.y - frame_.bounds.low.y),
      height_(frame_.bounds.high.z - frame_.bounds.low.z),
      narrow_x_(frame_.nx * frame_.pitch > size_x_ + kRounding * frame_.pitch),
      narrow_y_(frame_.ny * frame_.pitch > size_y_ + kRounding * frame_.pitch),
      squares_(static_cast<std::size_t>(squares_x()) * static_cast<std::size_t>(squares_y())),
      own_(squares_.size()),
      many_(squares_.size()),
      floor_(store_.make()),
      full_(store_.make()) {
  floor_->z.fill(0.0f);
  full_->z.fill(full_height);
  floor_->step.fill(kStockSurface);
  full_->step.fill(kStockSurface);
}

Columns::Columns(const Workpiece& workpiece, unsigned threads)
    : Columns({.bounds = workpiece.bounds(),
               .pitch = workpiece.pitch().mm(),
               .nx = workpiece.columns_x(),
               .ny = workpiece.columns_y(),
               .first = {},
               .intervals = {}},
              workpiece.body().height) {
  fill(threads, [&](std::size_t n) { read_tile(workpiece.body(), n, n); });
}

Columns::Columns(const Workpiece& workpiece, const SquareRange& squares, unsigned threads)
    : Columns(frame_of(workpiece, squares), workpiece.body().height) {
  const auto wide = static_cast<std::size_t>(squares_x());
  fill(threads, [&](std::size_t n) {
    const std::size_t x = static_cast<std::size_t>(squares.x) + n % wide;
    const std::size_t y = static_cast<std::size_t>(squares.y) + n / wide;
    read_tile(workpiece.body(), n, y * static_cast<std::size_t>(workpiece.body().tiles_x) + x);
  });
}

Columns::Columns(const ColumnGrid& grid, unsigned threads)
    : Columns({.bounds = grid.bounds,
               .pitch = grid.pitch,
               .nx = std::max(grid.nx, 0),
               .ny = std::max(grid.ny, 0),
               .first = {},
               .intervals = {}},
              0.0f) {
  if (!grid.intervals.empty()) fill(threads, [&](std::size_t n) { read_grid(grid, n); });
}

template <class Read>
void Columns::fill(unsigned threads, const Read& read) {
  const auto read_one = [&](std::size_t n) {
    read(n);
    ColumnSquare& square = squares_[n];
    square.is_low_level = square.low == floor_.get() || is_level(n, *square.low);
    square.is_high_level = square.high == full_.get() || is_level(n, *square.high);
  };
  parallel_for(threads, squares_.size(), read_one, [] { return false; });
  has_material_ = std::any_of(squares_.begin(), squares_.end(), [](const ColumnSquare& s) {
    return s.many == nullptr || !s.many->runs.empty();
  });
}

int Columns::columns_x(std::size_t square) const {
  return std::min(nx() - static_cast<int>(square % static_cast<std::size_t>(squares_x())) * kSquare, kSquare);
}

int Columns::columns_y(std::size_t square) const {
  return std::min(ny() - static_cast<int>(square / static_cast<std::size_t>(squares_x())) * kSquare, kSquare);
}

Ends& Columns::own(std::size_t square, int end) {
  auto& ends = own_[square][static_cast<std::size_t>(end)];
  if (!ends) ends = store_.make();
  (end == 0 ? squares_[square].low : squares_[square].high) = ends.get();
  return *ends;
}

bool Columns::is_level(std::size_t number, const Ends& ends) const {
  const auto wide = static_cast<std::size_t>(columns_x(number));
  for (int y = 0; y < columns_y(number); ++y) {
    for (std::size_t c = cell(0, y); c < cell(0, y) + wide; ++c)
      if (ends.z[c] != ends.z[0] || ends.step[c] != ends.step[0]) return false;
  }
  return true;
}

template <class Add>
void Columns::fill_many(std::size_t number, const Add& add) {
  auto many = std::make_unique<ManyRuns>();
  Ends &low = own(number, 0), &high = own(number, 1);
  const int wide = columns_x(number), deep = columns_y(number);
  for (int y = 0; y < kSquare; ++y) {
    for (int x = 0; x < kSquare; ++x) {
      const std::size_t c = cell(x, y), begin = many->runs.size();
      many->first[c] = static_cast<std::uint32_t>(begin);
      if (x >= wide || y >= deep) continue;
      const std::uint32_t cut_through = add(x, y, many->runs);
      const bool is_empty = many->runs.size() == begin;
      low.z[c] = is_empty ? sim::kFar : many->runs[begin].low;
      high.z[c] = is_empty ? -sim::kFar : many->runs.back().high;
      low.step[c] = is_empty ? cut_through : many->runs[begin].low_step;
      high.step[c] = is_empty ? cut_through : many->runs.back().high_step;
    }
  }
  many->first[kSquareColumns] = static_cast<std::uint32_t>(many->runs.size());
  squares_[number].many = many.get();
  many_[number] = std::move(many);
}

void Columns::read_tile(const Workpiece::Body& body, std::size_t number, std::size_t tile_number) {
  ColumnSquare& square = squares_[number];
  square.low = floor_.get();
  const sim::Tile* const tile = body.tiles[tile_number].get();
  if (tile == nullptr) {
    square.high = full_.get();
    return;
  }
  Ends& high = own(number, 1);
  copy_tops(*tile, high);
  if (body.step_of)
    for (std::uint32_t& step : high.step) step = body.step(step);
  bool has_many = *std::max_element(tile->chain, tile->chain + sim::kMicros) >= 0;
  const int wide = columns_x(number), deep = columns_y(number);
  for (int y = 0; y < deep && !has_many; ++y) {
    const float* const z = high.z.data() + cell(0, y);
    has_many = !(*std::min_element(z, z + wide) > 0.0f);
  }
  if (!has_many) return;
  fill_many(number, [&](int x, int y, std::vector<Interval>& runs) {
    const int index = sim::lane_index(x, y);
    const std::size_t c = cell(x, y), begin = runs.size();
    if (tile->chain[index / sim::kLanes] < 0 && high.z[c] > 0.0f) {
      runs.push_back({0.0f, high.z[c], kStockSurface, high.step[c]});
    } else {
      body.intervals(*tile, index, runs);
    }
    return runs.size() == begin ? body.cut_through(*tile, index) : kStockSurface;
  });
}

void Columns::read_grid(const ColumnGrid& grid, std::size_t number) {
  const int first_i = static_cast<int>(number % static_cast<std::size_t>(squares_x())) * kSquare;
  const int first_j = static_cast<int>(number / static_cast<std::size_t>(squares_x())) * kSquare;
  const auto column = [&](int x, int y) {
    return static_cast<std::size_t>(first_j + y) * static_cast<std::size_t>(nx()) +
           static_cast<std::size_t>(first_i + x);
  };
  bool has_many = false;
  Ends &low = own(number, 0), &high = own(number, 1);
  for (int y = 0; y < columns_y(number); ++y) {
    for (int x = 0; x < columns_x(number); ++x) {
      const std::size_t n = column(x, y), c = cell(x, y);
      has_many = has_many || grid.first[n + 1] - grid.first[n] != 1;
      if (has_many) break;
      const Interval& run = grid.intervals[grid.first[n]];
      low.z[c] = run.low;
      high.z[c] = run.high;
      low.step[c] = run.low_step;
      high.step[c] = run.high_step;
    }
  }
  if (!has_many) return;
  fill_many(number, [&](int x, int y, std::vector<Interval>& runs) {
    const std::size_t n = column(x, y);
    runs.insert(runs.end(), grid.intervals.data() + grid.first[n], grid.intervals.data() + grid.first[n + 1]);
    return grid.cut_through.empty() ? kStockSurface : grid.cut_through[n];
  });
}

}  // namespace kerf::meshing

namespace kerf {

MeshColumns::MeshColumns(const Workpiece& workpiece, unsigned threads)
    : body_(std::make_unique<Body>(workpiece, thread_count(threads))) {}
MeshColumns::MeshColumns(std::unique_ptr<Body> body) : body_(std::move(body)) {}
MeshColumns::MeshColumns(const ColumnGrid& grid, unsigned threads)
    : body_(std::make_unique<Body>(grid, thread_count(threads))) {}
MeshColumns::MeshColumns(MeshColumns&&) noexcept = default;
MeshColumns& MeshColumns::operator=(MeshColumns&&) noexcept = default;
MeshColumns::~MeshColumns() = default;

}  // namespace kerf
