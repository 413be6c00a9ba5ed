// Compares part and target column by column, and at points in the columns at walls. The depth of a difference
// is its largest distance from the target's surface; neighbouring columns with differences of one kind form a
// region.
#include "kerf/sim/compare.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/sim.h"
#include "base/number.h"
#include "base/parallel.h"
#include "sim/compare/wall_samples.h"
#include "sim/dexel/initial_columns.h"
#include "sim/dexel/tile.h"

#include "kerf/sim/exact_mesh.h"

namespace kerf {
namespace {

constexpr float kNoLength = 1e-5f;            // mm; shorter differences are rounding
constexpr Length kMeshTolerance = mm(0.001);  // of the part's mesh

/// An interval of one column that belongs to only one of part and target.
struct Difference {
  DifferenceKind kind;
  float low, high;  // mm above the floor
};

/// Appends a - b: the intervals of `a` outside those of `b`.
template <class A, class B>
void subtract(const A& a, const B& b, DifferenceKind kind, std::vector<Difference>& out) {
  std::size_t k = 0;
  for (const auto& run : a) {
    float low = run.low;
    while (k < b.size() && b[k].high <= low) ++k;
    for (std::size_t n = k; n < b.size() && b[n].low < run.high; ++n) {
      if (b[n].low > low + kNoLength) out.push_back({kind, low, b[n].low});
      low = std::max(low, b[n].high);
    }
    if (run.high > low + kNoLength) out.push_back({kind, low, run.high});
  }
}

/// The differences of one kind in one column that are longer than the tolerance.
struct Cell {
  double volume = 0.0;                          // mm3
  float depth = 0.0f;                           // mm; 0: none
  float at_x = 0.0f, at_y = 0.0f, at_z = 0.0f;  // the deepest point, mm from the block's low corner
  float low = 0.0f, high = 0.0f;                // mm above the floor
  bool counts = false;                          // as beyond the tolerance

  bool is_empty() const { return !(high > low); }
  bool overlaps(const Cell& other) const { return low <= other.high && other.low <= high; }
};

class Comparer {
 public:
  /// `walls`: null if part and target are known on the columns only.
  Comparer(const Workpiece& part, const StockBody& target, const sim::WallSamples* walls,
           const CompareOptions& options)
      : part_(part),
        walls_(walls),
        distance_(target),
        tolerance_(options.tolerance.mm()),
        max_regions_(options.max_regions),
        nx_(part.columns_x()),
        ny_(part.columns_y()) {}

  /// Compares all columns. False if stopped.
  bool compare_columns(const ColumnPositions& grid, const ColumnRuns& target, Progress* progress);
  /// The points of the part's surface in columns at walls that have a difference, or are next to one that
  /// has: vertices, and midpoints of edges. On a wall between two levels a vertex may be next to a level
  /// surface of the target, a midpoint is not.
  std::vector<Point3> points_of_surface(const solid::MeshSolid& part) const;
  /// Takes the depths of those points, whose material of the target is `target`.
  void add_depths(const std::vector<Point3>& points, const ColumnRuns& target);
  Comparison finish();

 private:
  void compare_column(int i, int j, std::span<const Run> target);
  void compare_samples(std::size_t wall, double area, std::size_t number);
  template <class Part>
  void compare_line(const Part& part, std::span<const Run> target, Point2 at, double area,
                    std::size_t number);
  double distance_to(Point3 p);
  void weigh(const Difference& difference, Point2 at, double area, std::size_t number);
  void deepen(Cell& cell, double depth, Point3 p) const;
  template <class Visit>
  void visit_neighbours(std::size_t number, const Visit& visit) const;
  std::optional<std::size_t> column_at(Point2 p) const;
  void count(DifferenceKind kind);
  void gather_regions(DifferenceKind kind);
  DifferenceRegion flood(DifferenceKind kind, std::size_t from, std::vector<bool>& seen);
  std::vector<Cell>& cells(DifferenceKind kind) { return kind == DifferenceKind::gouge ? gouges_ : rests_; }

  const Workpiece& part_;
  const sim::WallSamples* walls_;
  std::size_t next_wall_ = 0;  // among the columns of `walls_`
  SurfaceDistance distance_;
  double tolerance_;
  std::size_t max_regions_;
  int nx_, ny_;
  ColumnPositions grid_;
  Point3 low_;
  double reach_ = 0.0;
  Point3 last_point_;
  double last_distance_ = std::numeric_limits<double>::infinity();
  Comparison out_;
  std::vector<Cell> gouges_, rests_;
  std::vector<Difference> found_;
};

/// Distance to the target's surface. It differs from that of the previous query point by no more than the
/// distance between the two points, which limits the search.
double Comparer::distance_to(Point3 p) {
  constexpr double kSlack = 1e-6;  // mm, for rounding
  const double limit = last_distance_ + distance(p, last_point_) + kSlack;
  last_distance_ = distance_.at(p, std::min(limit, reach_));
  last_point_ = p;
  return last_distance_;
}

void Comparer::deepen(Cell& cell, double depth, Point3 p) const {
  if (!(depth > static_cast<double>(cell.depth))) return;
  cell.depth = static_cast<float>(depth);
  cell.at_x = static_cast<float>(p.x - low_.x);
  cell.at_y = static_cast<float>(p.y - low_.y);
  cell.at_z = static_cast<float>(p.z - low_.z);
}

void Comparer::weigh(const Difference& d, Point2 at, double area, std::size_t number) {
  const double length = static_cast<double>(d.high) - static_cast<double>(d.low), volume = length * area;
  Volume& all = d.kind == DifferenceKind::gouge ? out_.gouge : out_.rest;
  all = all + mm3(volume);
  if (length <= tolerance_) return;  // one of its ends lies on the target's surface
  Cell& cell = cells(d.kind)[number];
  const bool is_first = cell.is_empty();
  cell.low = is_first ? d.low : std::min(cell.low, d.low);
  cell.high = is_first ? d.high : std::max(cell.high, d.high);
  cell.volume += volume;
  for (const double fraction : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Point3 p{at.x, at.y, low_.z + static_cast<double>(d.low) + fraction * length};
    deepen(cell, distance_to(p), p);
  }
}

/// Compares part and target on one vertical line that represents an area.
template <class Part>
void Comparer::compare_line(const Part& part, std::span<const Run> target, Point2 at, double area,
                            std::size_t number) {
  double of_target = 0.0, of_part = 0.0;
  for (const Run& run : target) of_target += static_cast<double>(run.high - run.low);
  for (const auto& run : part) of_part += static_cast<double>(run.high - run.low);
  out_.target = out_.target + mm3(of_target * area);
  out_.part = out_.part + mm3(of_part * area);
  found_.clear();
  subtract(target, part, DifferenceKind::gouge, found_);
  subtract(part, target, DifferenceKind::rest, found_);
  for (const Difference& d : found_) weigh(d, at, area, number);
}

void Comparer::compare_samples(std::size_t wall, double area, std::size_t number) {
  const std::uint32_t begin = walls_->first[wall], end = walls_->first[wall + 1];
  for (std::uint32_t n = begin; n < end; ++n)
    compare_line(walls_->part.column(static_cast<int>(n), 0), walls_->target.column(static_cast<int>(n), 0),
                 walls_->points[n], area / (end - begin), number);
}

void Comparer::compare_column(int i, int j, std::span<const Run> target) {
  const Workpiece::Body& body = part_.body();
  const double area = body.fraction_x(i) * body.fraction_y(j) * body.pitch * body.pitch;
  const std::size_t number =
      static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
  out_.in_target[number] = !target.empty();
  if (walls_ != nullptr && next_wall_ < walls_->columns.size() && walls_->columns[next_wall_] == number) {
    compare_samples(next_wall_++, area, number);
  } else {
    compare_line(part_.column(i, j), target, {grid_.x_of(i), grid_.y_of(j)}, area, number);
  }
}

template <class Visit>
void Comparer::visit_neighbours(std::size_t number, const Visit& visit) const {
  const int i = static_cast<int>(number % static_cast<std::size_t>(nx_));
  const int j = static_cast<int>(number / static_cast<std::size_t>(nx_));
  for (int y = std::max(j - 1, 0); y <= std::min(j + 1, ny_ - 1); ++y)
    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, nx_ - 1); ++x)
      visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x));
}

/// The column whose square contains a point.
std::optional<std::size_t> Comparer::column_at(Point2 p) const {
  const double pitch = part_.body().pitch;
  const double i = std::floor((p.x - low_.x) / pitch), j = std::floor((p.y - low_.y) / pitch);
  if (!(i >= -1.0 && j >= -1.0 && i <= nx_ && j <= ny_)) return std::nullopt;
  const auto x = static_cast<std::size_t>(std::clamp(i, 0.0, nx_ - 1.0));
  return static_cast<std::size_t>(std::clamp(j, 0.0, ny_ - 1.0)) * static_cast<std::size_t>(nx_) + x;
}

std::vector<Point3> Comparer::points_of_surface(const solid::MeshSolid& part) const {
  std::vector<bool> wanted(gouges_.size(), false);
  for (const std::uint32_t n : walls_->columns)
    visit_neighbours(n, [&](std::size_t m) {
      if (!gouges_[m].is_empty() || !rests_[m].is_empty()) wanted[n] = true;
    });
  std::vector<Point3> points;
  const auto add = [&](Point3 p) {
    const auto column = column_at(p.xy());
    if (column && wanted[*column]) points.push_back(p);
  };
  for (std::uint32_t v = 0; v < part.points.size(); ++v) add(part.at(v));
  for (const auto& t : part.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] < t[(k + 1) % 3]) add(0.5 * (part.at(t[k]) + part.at(t[(k + 1) % 3])));
  return points;
}

void Comparer::add_depths(const std::vector<Point3>& points, const ColumnRuns& target) {
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Point3 p = points[n];
    const auto column = column_at(p.xy());
    if (!column) continue;
    bool is_inside = false;
    for (const Run& run : target.column(static_cast<int>(n), 0))
      is_inside = is_inside || (static_cast<double>(run.low) < p.z - low_.z &&
                                p.z - low_.z < static_cast<double>(run.high));
    std::vector<Cell>& of_kind = cells(is_inside ? DifferenceKind::gouge : DifferenceKind::rest);
    // The surface ends the difference: it may lie on the border of the next column.
    const double depth = distance_to(p);
    std::size_t owner = *column;
    if (of_kind[owner].is_empty())
      visit_neighbours(*column, [&](std::size_t m) {
        if (of_kind[m].volume > of_kind[owner].volume) owner = m;
      });
    if (!of_kind[owner].is_empty()) deepen(of_kind[owner], depth, p);
  }
}

/// Chooses the columns of one kind that count as beyond the tolerance. Beside the target's wall a difference
/// is within the tolerance; it is part of one that is deeper if that is at most the tolerance away.
void Comparer::count(DifferenceKind kind) {
  std::vector<Cell>& of_kind = cells(kind);
  std::vector<std::size_t> reached, next;
  for (std::size_t n = 0; n < of_kind.size(); ++n) {
    of_kind[n].counts = static_cast<double>(of_kind[n].depth) > tolerance_;
    if (of_kind[n].counts) reached.push_back(n);
  }
  const double steps = std::ceil(tolerance_ / part_.body().pitch);
  for (double step = 0.0; step < steps && !reached.empty(); ++step) {
    next.clear();
    for (const std::size_t n : reached)
      visit_neighbours(n, [&](std::size_t m) {
        if (of_kind[m].counts || of_kind[m].is_empty() || !of_kind[m].overlaps(of_kind[n])) return;
        of_kind[m].counts = true;
        next.push_back(m);
      });
    reached.swap(next);
  }
  Volume& beyond = kind == DifferenceKind::gouge ? out_.gouge_beyond : out_.rest_beyond;
  for (const Cell& cell : of_kind)
    if (cell.counts) beyond = beyond + mm3(cell.volume);
}

/// The region of columns connected to one along sides or corners.
DifferenceRegion Comparer::flood(DifferenceKind kind, std::size_t from, std::vector<bool>& seen) {
  const std::vector<Cell>& of_kind = cells(kind);
  DifferenceRegion region{.kind = kind, .depth = {}, .at = {}, .volume = {}, .bounds = {}};
  double volume = 0.0;
  std::vector<std::size_t> open{from};
  seen[from] = true;
  while (!open.empty()) {
    const std::size_t number = open.back();
    open.pop_back();
    const int i = static_cast<int>(number % static_cast<std::size_t>(nx_));
    const int j = static_cast<int>(number / static_cast<std::size_t>(nx_));
    const Cell& cell = of_kind[number];
    const double x = grid_.x_of(i), y = grid_.y_of(j);
    volume += cell.volume;
    region.bounds.add(Point3{x, y, low_.z + static_cast<double>(cell.low)});
    region.bounds.add(Point3{x, y, low_.z + static_cast<double>(cell.high)});
    ++region.columns;
    if (static_cast<double>(cell.depth) > region.depth.mm()) {
      region.depth = mm(static_cast<double>(cell.depth));
      region.at = low_ + Point3{static_cast<double>(cell.at_x), static_cast<double>(cell.at_y),
                                static_cast<double>(cell.at_z)};
    }
    visit_neighbours(number, [&](std::size_t next) {
      if (seen[next] || !of_kind[next].counts) return;
      seen[next] = true;
      open.push_back(next);
    });
  }
  region.volume = mm3(volume);
  return region;
}

void Comparer::gather_regions(DifferenceKind kind) {
  const std::vector<Cell>& of_kind = cells(kind);
  std::vector<bool> seen(of_kind.size(), false);
  for (std::size_t n = 0; n < of_kind.size(); ++n) {
    if (seen[n] || !of_kind[n].counts) continue;
    out_.regions.push_back(flood(kind, n, seen));
    ++out_.region_count;
    if (out_.regions.size() < 2 * max_regions_ + 64) continue;  // keeps memory bounded
    std::sort(out_.regions.begin(), out_.regions.end(),
              [](const auto& a, const auto& b) { return a.depth > b.depth; });
    out_.regions.resize(max_regions_);
  }
}

bool Comparer::compare_columns(const ColumnPositions& grid, const ColumnRuns& target, Progress* progress) {
  if (progress != nullptr) progress->phase("comparing");
  grid_ = grid;
  low_ = part_.bounds().low;
  reach_ = 2.0 * length(part_.bounds().size());
  out_.nx = nx_;
  out_.ny = ny_;
  const std::size_t count = static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_);
  gouges_.resize(count);
  rests_.resize(count);
  out_.in_target.assign(count, false);
  for (int j = 0; j < ny_; ++j) {
    report(progress, static_cast<double>(j) / ny_);
    if (stop_requested(progress)) return false;
    for (int i = 0; i < nx_; ++i) compare_column(i, j, target.column(i, j));
  }
  return true;
}

Comparison Comparer::finish() {
  out_.map.assign(gouges_.size(), 0.0f);
  for (std::size_t n = 0; n < gouges_.size(); ++n) {
    const float gouge = gouges_[n].depth, rest = rests_[n].depth;
    if (static_cast<double>(std::max(gouge, rest)) > tolerance_) out_.map[n] = gouge > rest ? -gouge : rest;
  }
  for (const DifferenceKind kind : {DifferenceKind::gouge, DifferenceKind::rest}) {
    count(kind);
    gather_regions(kind);
  }
  std::sort(out_.regions.begin(), out_.regions.end(),
            [](const auto& a, const auto& b) { return a.depth > b.depth; });
  out_.regions.resize(std::min(out_.regions.size(), max_regions_));
  return std::move(out_);
}

ColumnPositions grid_of(const Workpiece::Body& body) {
  const Point3 low = body.bounds.low;
  return {low.x + 0.5 * body.pitch, low.y + 0.5 * body.pitch, low.z, body.pitch, body.nx, body.ny,
          body.bounds.high.x,       body.bounds.high.y};
}

void warn_outside(const Box3& part, const StockBody& target, Diagnostics& diagnostics) {
  constexpr double kTouching = 1e-3;  // mm
  double outside = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    outside = std::max(
        {outside, part.low[axis] - target.bounds().low[axis], target.bounds().high[axis] - part.high[axis]});
  if (outside <= kTouching) return;
  diagnostics
      .warning(codes::target_outside, {},
               fmt::format("the target extends {} mm beyond the stock; that part is not compared",
                           number_text(outside, 3)))
      .hint = "the target must be given in the program's work coordinates";
}

std::uint8_t between(double fraction, int from, int to) {
  return static_cast<std::uint8_t>(std::lround(from + fraction * (to - from)));
}

}  // namespace

std::string_view to_string(DifferenceKind kind) { return kind == DifferenceKind::gouge ? "gouge" : "rest"; }

std::optional<Comparison> compare(const Workpiece& part, const StockBody& target,
                                  const CompareOptions& options, Diagnostics& diagnostics,
                                  Progress* progress) {
  const ColumnPositions grid = grid_of(part.body());
  const auto columns = target.columns(grid, diagnostics, progress);
  if (!columns) return std::nullopt;
  warn_outside(part.bounds(), target, diagnostics);
  Comparer comparer(part, target, nullptr, options);
  if (!comparer.compare_columns(grid, *columns, progress)) return std::nullopt;
  return comparer.finish();
}

std::optional<Comparison> compare(const Simulation& simulation, const StockBody& target,
                                  const CompareOptions& options, Diagnostics& diagnostics,
                                  Progress* progress) {
  const Workpiece& part = simulation.workpiece;
  const auto* const target_mesh = std::get_if<solid::MeshSolid>(&target.inside().what);
  if (target_mesh == nullptr) return compare(part, target, options, diagnostics, progress);
  Workpiece as_columns(Stock{part.bounds()}, part.pitch());
  if (!sim::fill_from_body(as_columns.body(), target, diagnostics, progress)) return std::nullopt;
  warn_outside(part.bounds(), target, diagnostics);
  const unsigned threads = simulation.job.options.threads;
  const auto mesh = extract_exact_mesh(simulation, {.tolerance = kMeshTolerance, .threads = threads},
                                       diagnostics, progress, {.threads = threads});
  if (!mesh) return std::nullopt;
  const solid::MeshSolid part_mesh = sim::solid_of(mesh->mesh);
  std::vector<std::uint32_t> columns =
      sim::columns_at_walls(part.body(), as_columns.body(), thread_count(threads));
  const auto walls =
      sim::sample_walls(std::move(columns), part.body(), part_mesh, *target_mesh, diagnostics, progress);
  if (!walls) return std::nullopt;
  Comparer comparer(part, target, &*walls, options);
  if (!comparer.compare_columns(grid_of(part.body()), *as_columns.body().start, progress))
    return std::nullopt;
  const std::vector<Point3> surface = comparer.points_of_surface(part_mesh);
  std::vector<Point2> lines;
  for (const Point3 p : surface) lines.push_back(p.xy());
  const auto at_surface = sim::runs_again(*target_mesh, lines, part.bounds().low.z, diagnostics, progress);
  if (!at_surface) return std::nullopt;
  comparer.add_depths(surface, *at_surface);
  return comparer.finish();
}

std::array<std::uint8_t, 3> difference_colour(double depth, Length full) {
  const double fraction = std::clamp(std::abs(depth) / std::max(full.mm(), 1e-9), 0.0, 1.0);
  if (depth < 0.0)
    return {between(fraction, 250, 170), between(fraction, 190, 0), between(fraction, 150, 20)};
  return {between(fraction, 170, 10), between(fraction, 205, 40), between(fraction, 250, 160)};
}

Image draw_map(const Comparison& c, Length full, int max_pixels) {
  constexpr int kLargestDot = 8;  // pixels per column
  Image image;
  const int largest = std::max({c.nx, c.ny, 1});
  const int dot = std::clamp(max_pixels / largest, 1, kLargestDot);
  const int skip = (largest * dot + max_pixels - 1) / max_pixels;  // columns per pixel of a large grid
  image.width = std::max(c.nx * dot / skip, 1);
  image.height = std::max(c.ny * dot / skip, 1);
  image.rgba.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4);
  for (int y = image.height - 1; y >= 0; --y) {
    for (int x = 0; x < image.width; ++x) {
      // A pixel shows the largest difference of its columns.
      float depth = 0.0f;
      bool in_target = false;
      for (int j = y * skip / dot; j <= std::min(((y + 1) * skip - 1) / dot, c.ny - 1); ++j) {
        for (int i = x * skip / dot; i <= std::min(((x + 1) * skip - 1) / dot, c.nx - 1); ++i) {
          const std::size_t n =
              static_cast<std::size_t>(j) * static_cast<std::size_t>(c.nx) + static_cast<std::size_t>(i);
          if (std::abs(c.map[n]) > std::abs(depth)) depth = c.map[n];
          in_target = in_target || c.in_target[n];
        }
      }
      std::array<std::uint8_t, 3> colour{245, 245, 245};
      if (in_target) colour = {176, 206, 160};
      if (depth != 0.0f) colour = difference_colour(static_cast<double>(depth), full);
      image.rgba.insert(image.rgba.end(), {colour[0], colour[1], colour[2], 255});
    }
  }
  return image;
}

}  // namespace kerf
