// The dexel columns of a workpiece: making and reading them, their volume.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/dexel/initial_columns.h"
#include "sim/dexel/tile.h"

namespace kerf {
namespace sim {

Tile::Tile(Real height, int columns_x, int columns_y, std::shared_ptr<SlotPages> memory)
    : slots(std::move(memory)) {
  const bool is_whole = columns_x == kTileColumns && columns_y == kTileColumns;
  const Real everywhere = is_whole ? height : 0.0f;
  std::fill_n(top[0].v, kMicros * kLanes, everywhere);
  std::fill_n(top_step[0], kMicros * kLanes, kStockSurface);
  std::fill_n(micro_top, kMicros, everywhere);
  std::fill_n(micro_bottom, kMicros, 0.0f);
  std::fill_n(chain, kMicros, -1);
  for (int y = 0; y < columns_y && !is_whole; ++y) {
    for (int x = 0; x < columns_x; ++x) {
      const int index = lane_index(x, y);
      top[index / kLanes][index % kLanes] = height;
      micro_top[index / kLanes] = height;
    }
  }
  for (int super = 0; super < kSupers; ++super) {
    super_top[super] = *std::max_element(micro_top + super * kSupers, micro_top + (super + 1) * kSupers);
    super_bottom[super] = 0.0f;
  }
}

Tile::Tile(Real height, int micros, std::shared_ptr<SlotPages> memory) : slots(std::move(memory)) {
  std::fill_n(top[0].v, micros * kLanes, height);
  std::fill_n(top_step[0], micros * kLanes, kStockSurface);
  std::fill_n(micro_top, kMicros, -kFar);
  std::fill_n(micro_top, micros, height);
  std::fill_n(micro_bottom, kMicros, kFar);
  std::fill_n(micro_bottom, micros, 0.0f);
  std::fill_n(chain, kMicros, -1);
  for (int super = 0; super < kSupers; ++super) {
    super_top[super] = *std::max_element(micro_top + super * kSupers, micro_top + (super + 1) * kSupers);
    super_bottom[super] = 0.0f;
  }
}

namespace {

/// Free slots up to this number, or up to this fraction (1 / divisor) of all slots, are kept.
constexpr std::int32_t kMaxUnused = 16;
constexpr std::int32_t kUnusedDivisor = 3;

}  // namespace

Slot& Tile::add_slot(int micro) {
  std::int32_t* link = &chain[micro];
  while (*link >= 0) link = &slots.next(*link);
  was_undercut = true;
  std::int32_t added = free_slot;
  if (added < 0) {
    added = slots.size();
    slots.add();
  } else {
    free_slot = slots.next(added);
  }
  *link = added;
  slots.next(added) = -1;
  Slot& slot = slots[added];
  for (int i = 0; i < kLanes; ++i) {
    slot.low[i] = kFar;
    slot.high[i] = -kFar;
    slot.low_step[i] = slot.high_step[i] = kStockSurface;
  }
  return slot;
}

void Tile::store_remnant(int micro, const Remnant& rest) {
  Slot* free = nullptr;
  for (std::int32_t k = chain[micro]; k >= 0 && free == nullptr; k = slots.next(k)) {
    Slot& slot = slots[k];
    if (slot.low[rest.lane] > slot.high[rest.lane]) free = &slot;
  }
  if (free == nullptr) free = &add_slot(micro);
  free->low[rest.lane] = rest.low;
  free->high[rest.lane] = rest.high;
  free->low_step[rest.lane] = rest.low_step;
  free->high_step[rest.lane] = rest.high_step;
}

void Tile::drop_chain(int micro) {
  std::int32_t* link = &chain[micro];
  while (*link >= 0) link = &slots.next(*link);
  *link = free_slot;
  free_slot = std::exchange(chain[micro], -1);
}

void Tile::pack_slots() {
  std::int32_t unused = 0;
  for (std::int32_t k = free_slot; k >= 0; k = slots.next(k)) ++unused;
  if (unused < kMaxUnused || unused < slots.size() / kUnusedDivisor) return;
  Slots packed = slots.none();
  for (std::int32_t& first : chain) {
    std::int32_t* link = &first;
    for (std::int32_t k = first; k >= 0; k = slots.next(k)) {
      *link = packed.size();
      packed.add();
      packed[*link] = slots[k];
      link = &packed.next(*link);
    }
    *link = -1;
  }
  slots = std::move(packed);
  free_slot = -1;
}

void Tile::lengths(int micro, Lanes& out) const {
  out = top[micro];
  for (std::int32_t k = chain[micro]; k >= 0; k = slots.next(k)) {
    const Slot& slot = slots[k];
    for (int i = 0; i < kLanes; ++i) {
      const Real length = slot.high[i] - slot.low[i];
      out[i] += length > 0 ? length : 0;
    }
  }
}

void Tile::intervals(int index, std::vector<Interval>& out) const {
  const int micro = index / kLanes, lane = index % kLanes;
  const Real high = top[micro][lane];
  if (high > 0.0f) out.push_back({0.0f, high, kStockSurface, top_step[micro][lane]});
  const auto begin = static_cast<std::ptrdiff_t>(out.size());
  for (std::int32_t k = chain[micro]; k >= 0; k = slots.next(k)) {
    const Slot& slot = slots[k];
    if (slot.high[lane] > slot.low[lane])
      out.push_back({slot.low[lane], slot.high[lane], slot.low_step[lane], slot.high_step[lane]});
  }
  std::sort(out.begin() + begin, out.end(),
            [](const Interval& a, const Interval& b) { return a.low < b.low; });
}

void Tile::cut_through(int index, std::vector<std::uint32_t>& out) const {
  const int micro = index / kLanes, lane = index % kLanes;
  // The high end of an empty interval has the step that removed it.
  out.push_back(top_step[micro][lane]);
  for (std::int32_t k = chain[micro]; k >= 0; k = slots.next(k)) out.push_back(slots[k].high_step[lane]);
}

namespace {

/// A last column narrower than this fraction of a pitch comes from rounding of the division.
constexpr double kNoColumn = 1e-6;
/// Minimum difference of two heights, mm, and in ulps of the height.
constexpr double kSameHeight = 1e-5;
constexpr double kSameHeightUlps = 4.0;

int column_count(double size, double pitch) {
  const double count = std::ceil(size / pitch - kNoColumn);
  assert(count >= 1.0 && count < static_cast<double>(std::numeric_limits<int>::max() - kTileColumns));
  return static_cast<int>(count);
}

double fraction_inside(int i, double pitch, double size) { return std::clamp(size / pitch - i, 0.0, 1.0); }

double centre_inside(int i, double pitch, double size) {
  return 0.5 * (i * pitch + std::min((i + 1) * pitch, size));
}

}  // namespace
}  // namespace sim

Workpiece::Body::Body(const Box3& block, double column_pitch) : bounds(block), pitch(column_pitch) {
  const Point3 size = bounds.size();
  nx = sim::column_count(size.x, pitch);
  ny = sim::column_count(size.y, pitch);
  tiles_x = (nx + sim::kTileColumns - 1) / sim::kTileColumns;
  tiles_y = (ny + sim::kTileColumns - 1) / sim::kTileColumns;
  height = static_cast<sim::Real>(size.z);
  const double ulp = std::nextafter(height, sim::kFar) - height;
  same_height = static_cast<sim::Real>(std::max(sim::kSameHeight, sim::kSameHeightUlps * ulp));
  tiles.resize(static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y));
}

int Workpiece::Body::columns_x_of(std::size_t tile) const {
  const int first = static_cast<int>(tile % static_cast<std::size_t>(tiles_x)) * sim::kTileColumns;
  return std::min(nx - first, sim::kTileColumns);
}

int Workpiece::Body::columns_y_of(std::size_t tile) const {
  const int first = static_cast<int>(tile / static_cast<std::size_t>(tiles_x)) * sim::kTileColumns;
  return std::min(ny - first, sim::kTileColumns);
}

void Workpiece::Body::intervals(const sim::Tile& tile, int index, std::vector<Interval>& out) const {
  const std::size_t begin = out.size();
  tile.intervals(index, out);
  if (!step_of) return;
  for (std::size_t k = begin; k < out.size(); ++k) {
    out[k].low_step = step(out[k].low_step);
    out[k].high_step = step(out[k].high_step);
  }
}

std::uint32_t Workpiece::Body::cut_through(const sim::Tile& tile, int index) const {
  std::vector<std::uint32_t> numbers;
  tile.cut_through(index, numbers);
  std::uint32_t last = kStockSurface;  // steps are in order of time
  for (const std::uint32_t number : numbers)
    if (number != kStockSurface && (last == kStockSurface || step(number) > last)) last = step(number);
  return last;
}

sim::Tile& Workpiece::Body::touch(std::size_t tile) {
  if (!tiles[tile]) tiles[tile] = store.make(height, columns_x_of(tile), columns_y_of(tile), slot_pages);
  return *tiles[tile];
}

void Workpiece::Body::restore(std::size_t tile) {
  *tiles[tile] = sim::Tile(height, columns_x_of(tile), columns_y_of(tile), slot_pages);
  sim::fill_start_tile(*this, tile, *tiles[tile]);
}

double Workpiece::Body::column_x(int i) const { return sim::centre_inside(i, pitch, bounds.size().x); }
double Workpiece::Body::column_y(int j) const { return sim::centre_inside(j, pitch, bounds.size().y); }
double Workpiece::Body::fraction_x(int i) const { return sim::fraction_inside(i, pitch, bounds.size().x); }
double Workpiece::Body::fraction_y(int j) const { return sim::fraction_inside(j, pitch, bounds.size().y); }

Workpiece::Workpiece(const Stock& stock, Length pitch)
    : body_(std::make_unique<Body>(stock.block, pitch.mm())) {}
Workpiece::Workpiece(Workpiece&&) noexcept = default;
Workpiece& Workpiece::operator=(Workpiece&&) noexcept = default;
Workpiece::~Workpiece() = default;

const Box3& Workpiece::bounds() const { return body_->bounds; }
Length Workpiece::pitch() const { return mm(body_->pitch); }
int Workpiece::columns_x() const { return body_->nx; }
int Workpiece::columns_y() const { return body_->ny; }

std::vector<Interval> Workpiece::column(int i, int j) const {
  assert(i >= 0 && i < body_->nx && j >= 0 && j < body_->ny);
  std::vector<Interval> out;
  const std::size_t tile =
      static_cast<std::size_t>(j / sim::kTileColumns) * static_cast<std::size_t>(body_->tiles_x) +
      static_cast<std::size_t>(i / sim::kTileColumns);
  if (!body_->tiles[tile]) {
    out.push_back({0.0f, body_->height, kStockSurface, kStockSurface});
  } else {
    body_->intervals(*body_->tiles[tile], sim::lane_index(i % sim::kTileColumns, j % sim::kTileColumns), out);
  }
  return out;
}

double ColumnGrid::column_x(int i) const { return sim::centre_inside(i, pitch, bounds.size().x); }
double ColumnGrid::column_y(int j) const { return sim::centre_inside(j, pitch, bounds.size().y); }

ColumnGrid Workpiece::grid() const {
  const Body& body = *body_;
  ColumnGrid grid{
      .bounds = body.bounds, .pitch = body.pitch, .nx = body.nx, .ny = body.ny, .first = {}, .intervals = {}};
  const std::size_t count = static_cast<std::size_t>(body.nx) * static_cast<std::size_t>(body.ny);
  grid.first.reserve(count + 1);
  grid.intervals.reserve(count);
  sim::use_huge_pages(grid.first.data(), (count + 1) * sizeof grid.first[0]);
  sim::use_huge_pages(grid.intervals.data(), count * sizeof grid.intervals[0]);
  for (int j = 0; j < body.ny; ++j) {
    const std::size_t row =
        static_cast<std::size_t>(j / sim::kTileColumns) * static_cast<std::size_t>(body.tiles_x);
    for (int i = 0; i < body.nx; ++i) {
      grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
      const sim::Tile* tile = body.tiles[row + static_cast<std::size_t>(i / sim::kTileColumns)].get();
      if (tile == nullptr) {
        grid.intervals.push_back({0.0f, body.height, kStockSurface, kStockSurface});
      } else {
        const int index = sim::lane_index(i % sim::kTileColumns, j % sim::kTileColumns);
        body.intervals(*tile, index, grid.intervals);
        if (grid.first.back() != grid.intervals.size()) continue;
        if (grid.cut_through.empty()) grid.cut_through.assign(count, kStockSurface);
        grid.cut_through[grid.first.size() - 1] = body.cut_through(*tile, index);
      }
    }
  }
  grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
  return grid;
}

Volume Workpiece::volume() const {
  const Body& body = *body_;
  double sum = 0.0;
  std::vector<Interval> column;
  for (int j = 0; j < body.ny; ++j) {
    const std::size_t row =
        static_cast<std::size_t>(j / sim::kTileColumns) * static_cast<std::size_t>(body.tiles_x);
    double line = 0.0;
    for (int i = 0; i < body.nx; ++i) {
      const sim::Tile* tile = body.tiles[row + static_cast<std::size_t>(i / sim::kTileColumns)].get();
      double length = body.height;
      if (tile != nullptr) {
        column.clear();
        tile->intervals(sim::lane_index(i % sim::kTileColumns, j % sim::kTileColumns), column);
        length = 0.0;
        for (const Interval& run : column)
          length += static_cast<double>(run.high) - static_cast<double>(run.low);
      }
      line += length * body.fraction_x(i);
    }
    sum += line * body.fraction_y(j);
  }
  return mm3(sum * body.pitch * body.pitch + body.wall_volume);
}

}  // namespace kerf
