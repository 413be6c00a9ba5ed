// Measures the squares that walls pass through, at lattice points in each.
#include <algorithm>
#include <cassert>
#include <cstdint>

#include "sim/cut/walls.h"
#include "sim/dexel/initial_columns.h"
#include "sim/dexel/wall_lattice.h"

namespace kerf::sim {
namespace {

/// Maximum number of squares kept as points at a time; bounds the memory to about 100 MB.
constexpr std::size_t kGroupSquares = 1 << 17;

/// From the position of a column to that of the next one, or to the border of the block, along one axis.
struct Gap {
  double low, high;
  double length() const { return high - low; }
  double at(double fraction) const { return low + fraction * (high - low); }
};

/// A point, and the column whose square contains it (for stocks with different initial columns).
struct WallPoint {
  Real x, y, weight;
  int i, j;
};

/// The points of one tile, in the order of their micros.
class PointList {
 public:
  PointList(const Workpiece::Body& body, std::size_t tile, std::size_t max_points)
      : body_(body),
        column_(static_cast<int>(tile % static_cast<std::size_t>(body.tiles_x)) * kTileColumns),
        row_(static_cast<int>(tile / static_cast<std::size_t>(body.tiles_x)) * kTileColumns),
        low_x_((column_ + 0.5) * body.pitch),
        low_y_((row_ + 0.5) * body.pitch) {
    points_.reserve(max_points);
  }

  void add_square(WallSquare square, const WallLattice& lattice);
  /// Subtracts from a column what squares replace. Where its surface slopes beside a wall, the centre is a
  /// biased sample of the remaining quarters: `counts_rest` has them replaced by their own centres.
  void add_column(const TileColumns& columns, const WallSquares::Quarters& quarters,
                  const WallLattice& lattice);
  /// Pads the list, so that the next point starts a micro.
  void fill_up();
  const std::vector<WallPoint>& points() const { return points_; }

 private:
  const Workpiece::Body& body_;
  int column_, row_;  // of the tile's first column, and its position
  double low_x_, low_y_;
  std::vector<WallPoint> points_;
};

void PointList::add_square(WallSquare square, const WallLattice& lattice) {
  const double count = lattice.count;
  const int i = column_ + square.x, j = row_ + square.y;
  const Point3 size = body_.bounds.size();
  const Gap x{i < 0 ? 0.0 : body_.column_x(i), i + 1 < body_.nx ? body_.column_x(i + 1) : size.x};
  const Gap y{j < 0 ? 0.0 : body_.column_y(j), j + 1 < body_.ny ? body_.column_y(j + 1) : size.y};
  const auto weight = static_cast<Real>(x.length() * y.length() / (body_.pitch * body_.pitch) / count);
  visit_points(lattice, i, j, [&](double fraction_x, double fraction_y) {
    const double at_x = x.at(fraction_x), at_y = y.at(fraction_y);
    WallPoint point{static_cast<Real>(at_x - low_x_), static_cast<Real>(at_y - low_y_), weight, 0, 0};
    if (body_.start) {
      point.i = std::min(static_cast<int>(at_x / body_.pitch), body_.nx - 1);
      point.j = std::min(static_cast<int>(at_y / body_.pitch), body_.ny - 1);
    }
    points_.push_back(point);
  });
}

void PointList::add_column(const TileColumns& columns, const WallSquares::Quarters& quarters,
                           const WallLattice& lattice) {
  const ColumnInTile position = column_in_tile(quarters.column);
  const Real fraction_x = columns.fraction_x[position.x], fraction_y = columns.fraction_y[position.y];
  const Real quarter = 0.25f * fraction_x * fraction_y;
  const auto quarter_pitch = static_cast<Real>(0.25 * body_.pitch);
  WallPoint centre{columns.x[position.x], columns.y[position.y], 0.0f, column_ + position.x,
                   row_ + position.y};
  for (int k = 0; k < 4; ++k) {
    const bool is_taken = (quarters.taken >> k & 1) != 0;
    if (is_taken || lattice.counts_rest) centre.weight -= quarter;
    if (is_taken || !lattice.counts_rest) continue;
    points_.push_back({centre.x + ((k & 1) != 0 ? fraction_x : -fraction_x) * quarter_pitch,
                       centre.y + ((k & 2) != 0 ? fraction_y : -fraction_y) * quarter_pitch, quarter,
                       centre.i, centre.j});
  }
  points_.push_back(centre);
}

void PointList::fill_up() {
  while (points_.size() % kLanes != 0) {
    points_.push_back(points_.back());
    points_.back().weight = 0.0f;
  }
}

/// The bounds of points or of boxes.
struct Extent {
  Real x0 = kFar, x1 = -kFar, y0 = kFar, y1 = -kFar;
  void add(const Extent& more) {
    x0 = std::min(x0, more.x0);
    x1 = std::max(x1, more.x1);
    y0 = std::min(y0, more.y0);
    y1 = std::max(y1, more.y1);
  }
  void store(PointTile::Boxes& boxes, int lane) const {
    boxes.x[lane] = 0.5f * (x0 + x1);
    boxes.y[lane] = 0.5f * (y0 + y1);
    boxes.half_x[lane] = 0.5f * (x1 - x0);
    boxes.half_y[lane] = 0.5f * (y1 - y0);
  }
};
Extent extent_of(const PointMicro& points) {
  const auto [x0, x1] = std::minmax_element(points.x.v, points.x.v + kLanes);
  const auto [y0, y1] = std::minmax_element(points.y.v, points.y.v + kLanes);
  return {*x0, *x1, *y0, *y1};
}

/// Computes the boxes around micros and supers; boxes without points stay 0.
void enclose(PointTile& tile) {
  tile.around_supers = {};
  for (std::size_t first = 0; first < tile.micros.size(); first += kSupers) {
    const std::size_t super = first / kSupers, end = std::min(first + kSupers, tile.micros.size());
    PointTile::Boxes& boxes = tile.around_micros[super];
    boxes = {};
    Extent all;
    for (std::size_t micro = first; micro < end; ++micro) {
      const Extent extent = extent_of(tile.micros[micro]);
      extent.store(boxes, static_cast<int>(micro - first));
      all.add(extent);
    }
    all.store(tile.around_supers, static_cast<int>(super));
  }
}

/// Fills a part of a tile with points.
void fill_part(const Workpiece::Body& body, const WallPoint* points, WallTile::Part& part) {
  for (std::size_t micro = 0; micro < part.points.micros.size(); ++micro) {
    PointMicro& lanes = part.points.micros[micro];
    for (int lane = 0; lane < kLanes; ++lane) {
      const WallPoint& point = *points++;
      lanes.x[lane] = point.x;
      lanes.y[lane] = point.y;
      lanes.weight[lane] = point.weight;
      if (body.start) put_start_column(body, point.i, point.j, part.tile, static_cast<int>(micro), lane);
    }
  }
  if (body.start) refresh_bounds(part.tile, static_cast<int>(part.points.micros.size()));
  enclose(part.points);
}

}  // namespace

WallTile::WallTile(const Workpiece::Body& body, const Cutter& cutter, const WallSquares& walls,
                   std::size_t all_squares, Parts& memory) {
  const WallLattice& lattice = lattice_of(all_squares);
  const std::size_t a_column = lattice.counts_rest ? 5 : 1;
  PointList list(body, walls.tile,
                 walls.squares.size() * static_cast<std::size_t>(lattice.count) +
                     walls.quarters.size() * a_column + 2 * kLanes);
  for (const WallSquare square : walls.squares) list.add_square(square, lattice);
  list.fill_up();
  const TileColumns columns = cutter.columns_of(walls.tile);
  for (const WallSquares::Quarters& quarters : walls.quarters) list.add_column(columns, quarters, lattice);
  list.fill_up();
  const std::size_t micros = list.points().size() / kLanes;
  for (std::size_t first = 0; first < micros; first += kMicros) {
    const std::size_t count = std::min<std::size_t>(kMicros, micros - first);
    Part& part = *parts_.emplace_back(memory.store.make(body.height, static_cast<int>(count), memory.slots));
    part.points.micros.resize(count);
    fill_part(body, list.points().data() + first * kLanes, part);
  }
}

void WallTile::cut(TileJob job) {
  std::vector<double> removed(job.count);
  double* const sum = job.removed;
  job.removed = removed.data();
  for (const auto& part : parts_) {
    job.tile = &part->tile;
    job.points = &part->points;
    cut_tile(job);
    for (std::size_t k = 0; k < job.count; ++k) sum[k] += removed[k];
    job.contacts->clear();  // already found by the columns
  }
}

WallGroup::WallGroup(const Workpiece::Body& body, const Cutter& cutter, const std::vector<WallSquares>& found,
                     std::size_t all_squares, std::size_t& next, const std::vector<std::size_t>& sweeps)
    : body_(body),
      cutter_(cutter),
      found_(found.data() + next),
      all_squares_(all_squares),
      wanted_(body.tiles.size(), false),
      index_(body.tiles.size(), 0) {
  for (std::size_t squares = 0; next < found.size() && squares < kGroupSquares; ++next) {
    const WallSquares& walls = found[next];
    squares += walls.squares.size();
    wanted_[walls.tile] = true;
    index_[walls.tile] = static_cast<std::uint32_t>(walls_.size());
    walls_.push_back({std::nullopt, sweeps[walls.tile]});
  }
}

void WallGroup::cut(std::size_t tile, const TileJob& job) {
  Walls& walls = walls_[index_[tile]];
  if (!walls.tile) walls.tile.emplace(body_, cutter_, found_[index_[tile]], all_squares_, parts_);
  walls.tile->cut(job);
  assert(walls.sweeps_left >= job.count);
  walls.sweeps_left -= job.count;
  if (walls.sweeps_left == 0) walls.tile.reset();
}

}  // namespace kerf::sim
