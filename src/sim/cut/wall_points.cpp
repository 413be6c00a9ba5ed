// Counting the squares that walls go through at points of a lattice each.
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <iterator>

#include "sim/cut/walls.h"
#include "sim/dexel/initial_columns.h"

namespace kerf::sim {
namespace {

/// The points of a square: a lattice that is even in every direction, with one point in each of as many
/// columns and rows. What is told is the row of each column's point.
struct Lattice {
  int count;
  int row[16];
  std::size_t most_squares;  // for which this many are needed
  bool counts_rest;          // see PointList::add_column
};
/// Squares have their lattices shifted by amounts that follow no pattern, so that what all of them are off by
/// grows with the root of their number only: of many squares few points do. Along the whole outline the error
/// is then less than a thousandth of a pitch.
constexpr Lattice kLattices[] = {
    {16, {0, 5, 10, 15, 4, 9, 14, 3, 8, 13, 2, 7, 12, 1, 6, 11}, 1 << 14, true},
    {4, {1, 3, 0, 2}, 1 << 16, true},
    {2, {0, 1}, SIZE_MAX, false},
};
const Lattice& lattice_of(std::size_t squares) {
  return *std::find_if(std::begin(kLattices), std::end(kLattices),
                       [=](const Lattice& lattice) { return squares <= lattice.most_squares; });
}

/// Squares kept as points at a time; bounds the memory to about 100 MB.
constexpr std::size_t kGroupSquares = 1 << 17;

/// Numbers between 0 and 1 that follow no pattern, from a square's place.
std::uint32_t scrambled(std::uint32_t i, std::uint32_t j) {
  std::uint32_t v = i * 0x9e3779b1u ^ (j * 0x85ebca77u + 0x165667b1u);
  v = (v ^ (v >> 15)) * 0x2c1b3c6du;
  v = (v ^ (v >> 12)) * 0x297a2d39u;
  return v ^ (v >> 15);
}
double unit_share(std::uint32_t bits) { return static_cast<double>(bits & 0xffffu) / 65536.0; }
double fraction(double v) { return v < 1.0 ? v : v - 1.0; }

/// From one column's place to the next one's or to the block's border, along one axis.
struct Gap {
  double low, high;
  double length() const { return high - low; }
  double at(double share) const { return low + share * (high - low); }
};

/// A point, and the column of the workpiece in whose square it is, where columns do not all begin alike.
struct WallPoint {
  Real x, y, weight;
  int i, j;
};

/// The points of one tile, in the order in which they fill micros.
class PointList {
 public:
  PointList(const Workpiece::Body& body, std::size_t tile, std::size_t most_points)
      : body_(body),
        column_(static_cast<int>(tile % static_cast<std::size_t>(body.tiles_x)) * kTileColumns),
        row_(static_cast<int>(tile / static_cast<std::size_t>(body.tiles_x)) * kTileColumns),
        low_x_((column_ + 0.5) * body.pitch),
        low_y_((row_ + 0.5) * body.pitch) {
    points_.reserve(most_points);
  }

  void add_square(WallSquare square, const Lattice& lattice);
  /// Takes from a column what squares replace. Where it slopes beside a wall, its centre says too little of
  /// the quarters that are left, to the first order: `counts_rest` has them replaced by their own middles.
  void add_column(const TileColumns& columns, const WallSquares::Quarters& quarters, const Lattice& lattice);
  /// Lets what follows begin with a new micro.
  void fill_up();
  const std::vector<WallPoint>& points() const { return points_; }

 private:
  const Workpiece::Body& body_;
  int column_, row_;  // of the tile's first column, and where that is
  double low_x_, low_y_;
  std::vector<WallPoint> points_;
};

void PointList::add_square(WallSquare square, const Lattice& lattice) {
  const double count = lattice.count;
  const int i = column_ + square.x, j = row_ + square.y;
  const Point3 size = body_.bounds.size();
  const Gap x{i < 0 ? 0.0 : body_.place_x(i), i + 1 < body_.nx ? body_.place_x(i + 1) : size.x};
  const Gap y{j < 0 ? 0.0 : body_.place_y(j), j + 1 < body_.ny ? body_.place_y(j + 1) : size.y};
  const auto weight = static_cast<Real>(x.length() * y.length() / (body_.pitch * body_.pitch) / count);
  const std::uint32_t bits = scrambled(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
  for (int k = 0; k < lattice.count; ++k) {
    const double at_x = x.at(fraction(unit_share(bits) + k / count));
    const double at_y = y.at(fraction(unit_share(bits >> 16) + lattice.row[k] / count));
    WallPoint point{static_cast<Real>(at_x - low_x_), static_cast<Real>(at_y - low_y_), weight, 0, 0};
    if (body_.start) {
      point.i = std::min(static_cast<int>(at_x / body_.pitch), body_.nx - 1);
      point.j = std::min(static_cast<int>(at_y / body_.pitch), body_.ny - 1);
    }
    points_.push_back(point);
  }
}

void PointList::add_column(const TileColumns& columns, const WallSquares::Quarters& quarters,
                           const Lattice& lattice) {
  const ColumnInTile place = column_in_tile(quarters.column);
  const Real share_x = columns.share_x[place.x], share_y = columns.share_y[place.y];
  const Real quarter = 0.25f * share_x * share_y;
  const auto quarter_pitch = static_cast<Real>(0.25 * body_.pitch);
  WallPoint centre{columns.x[place.x], columns.y[place.y], 0.0f, column_ + place.x, row_ + place.y};
  for (int k = 0; k < 4; ++k) {
    const bool is_taken = (quarters.taken >> k & 1) != 0;
    if (is_taken || lattice.counts_rest) centre.weight -= quarter;
    if (is_taken || !lattice.counts_rest) continue;
    points_.push_back({centre.x + ((k & 1) != 0 ? share_x : -share_x) * quarter_pitch,
                       centre.y + ((k & 2) != 0 ? share_y : -share_y) * quarter_pitch, quarter, centre.i,
                       centre.j});
  }
  points_.push_back(centre);
}

void PointList::fill_up() {
  while (points_.size() % kLanes != 0) {
    points_.push_back(points_.back());
    points_.back().weight = 0.0f;
  }
}

/// What encloses points, or boxes.
struct Extent {
  Real x0 = kFar, x1 = -kFar, y0 = kFar, y1 = -kFar;
  void add(const Extent& more) {
    x0 = std::min(x0, more.x0);
    x1 = std::max(x1, more.x1);
    y0 = std::min(y0, more.y0);
    y1 = std::max(y1, more.y1);
  }
  void tell(PointTile::Boxes& boxes, int lane) const {
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

/// Finds the boxes around micros and supers; those without any stay at 0.
void enclose(PointTile& tile) {
  tile.around_supers = {};
  for (std::size_t first = 0; first < tile.micros.size(); first += kSupers) {
    const std::size_t super = first / kSupers, end = std::min(first + kSupers, tile.micros.size());
    PointTile::Boxes& boxes = tile.around_micros[super];
    boxes = {};
    Extent all;
    for (std::size_t micro = first; micro < end; ++micro) {
      const Extent extent = extent_of(tile.micros[micro]);
      extent.tell(boxes, static_cast<int>(micro - first));
      all.add(extent);
    }
    all.tell(tile.around_supers, static_cast<int>(super));
  }
}

/// Fills a part with points.
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
  const Lattice& lattice = lattice_of(all_squares);
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
    job.contacts->clear();  // the columns have told them
  }
}

WallGroup::WallGroup(const Workpiece::Body& body, const Cutter& cutter, const std::vector<WallSquares>& found,
                     std::size_t all_squares, std::size_t& next, const std::vector<std::size_t>& sweeps)
    : body_(body),
      cutter_(cutter),
      found_(found.data() + next),
      all_squares_(all_squares),
      wanted_(body.tiles.size(), false),
      place_(body.tiles.size(), 0) {
  for (std::size_t squares = 0; next < found.size() && squares < kGroupSquares; ++next) {
    const WallSquares& walls = found[next];
    squares += walls.squares.size();
    wanted_[walls.tile] = true;
    place_[walls.tile] = static_cast<std::uint32_t>(walls_.size());
    walls_.push_back({std::nullopt, sweeps[walls.tile]});
  }
}

void WallGroup::cut(std::size_t tile, const TileJob& job) {
  Walls& walls = walls_[place_[tile]];
  if (!walls.tile) walls.tile.emplace(body_, cutter_, found_[place_[tile]], all_squares_, parts_);
  walls.tile->cut(job);
  assert(walls.sweeps_left >= job.count);
  walls.sweeps_left -= job.count;
  if (walls.sweeps_left == 0) walls.tile.reset();
}

}  // namespace kerf::sim
