// Compares part and target column by column. The depth of a difference is its largest distance from the
// target's surface; neighbouring columns with differences of one kind form a region.
#include "kerf/sim/compare.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "base/codes/sim.h"
#include "base/number.h"
#include "sim/dexel/tile.h"

namespace kerf {
namespace {

constexpr float kNoLength = 1e-5f;  // mm; shorter differences are rounding

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

/// The differences of one kind beyond the tolerance in one column.
struct Cell {
  float depth = 0.0f;   // mm; 0: none
  float at = 0.0f;      // height of the deepest point, mm above the floor
  float volume = 0.0f;  // mm3
  float low = 0.0f, high = 0.0f;
};

class Comparer {
 public:
  Comparer(const Workpiece& part, const StockBody& target, const CompareOptions& options)
      : part_(part),
        distance_(target),
        tolerance_(options.tolerance.mm()),
        max_regions_(options.max_regions),
        nx_(part.columns_x()),
        ny_(part.columns_y()) {}

  std::optional<Comparison> run(const ColumnPositions& grid, const ColumnRuns& target, Progress* progress);

 private:
  void compare_column(int i, int j, std::span<const Run> target);
  double distance_to(Point3 p);
  void weigh(const Difference& difference, Point2 at, double area, std::size_t number);
  void gather_regions(DifferenceKind kind);
  DifferenceRegion flood(DifferenceKind kind, std::size_t from, std::vector<bool>& seen);
  std::vector<Cell>& cells(DifferenceKind kind) { return kind == DifferenceKind::gouge ? gouges_ : rests_; }

  const Workpiece& part_;
  SurfaceDistance distance_;
  double tolerance_;
  std::size_t max_regions_;
  int nx_, ny_;
  ColumnPositions grid_;
  double floor_ = 0.0, reach_ = 0.0;
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

void Comparer::weigh(const Difference& d, Point2 at, double area, std::size_t number) {
  const double length = static_cast<double>(d.high) - static_cast<double>(d.low), volume = length * area;
  (d.kind == DifferenceKind::gouge ? out_.gouge : out_.rest) =
      (d.kind == DifferenceKind::gouge ? out_.gouge : out_.rest) + mm3(volume);
  if (length <= tolerance_) return;  // one of its ends lies on the target's surface
  float deepest = 0.0f, deepest_z = 0.0f;
  for (const double fraction : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double z = static_cast<double>(d.low) + fraction * length;
    const auto depth = static_cast<float>(distance_to({at.x, at.y, floor_ + z}));
    if (depth <= deepest) continue;
    deepest = depth;
    deepest_z = static_cast<float>(z);
  }
  if (!(static_cast<double>(deepest) > tolerance_)) return;
  Volume& beyond = d.kind == DifferenceKind::gouge ? out_.gouge_beyond : out_.rest_beyond;
  beyond = beyond + mm3(volume);
  Cell& cell = cells(d.kind)[number];
  cell.low = cell.depth > 0.0f ? std::min(cell.low, d.low) : d.low;
  cell.high = cell.depth > 0.0f ? std::max(cell.high, d.high) : d.high;
  cell.volume += static_cast<float>(volume);
  if (deepest <= cell.depth) return;
  cell.depth = deepest;
  cell.at = deepest_z;
}

void Comparer::compare_column(int i, int j, std::span<const Run> target) {
  const Workpiece::Body& body = part_.body();
  const double area = body.fraction_x(i) * body.fraction_y(j) * body.pitch * body.pitch;
  const std::vector<Interval> part = part_.column(i, j);
  double of_target = 0.0, of_part = 0.0;
  for (const Run& run : target) of_target += static_cast<double>(run.high - run.low);
  for (const Interval& run : part) of_part += static_cast<double>(run.high - run.low);
  out_.target = out_.target + mm3(of_target * area);
  out_.part = out_.part + mm3(of_part * area);
  const std::size_t number =
      static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
  out_.in_target[number] = !target.empty();
  found_.clear();
  subtract(target, part, DifferenceKind::gouge, found_);
  subtract(part, target, DifferenceKind::rest, found_);
  for (const Difference& d : found_) weigh(d, {grid_.x_of(i), grid_.y_of(j)}, area, number);
  const float gouge = gouges_[number].depth, rest = rests_[number].depth;
  out_.map[number] = gouge > rest ? -gouge : rest;
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
    volume += static_cast<double>(cell.volume);
    region.bounds.add(Point3{x, y, floor_ + static_cast<double>(cell.low)});
    region.bounds.add(Point3{x, y, floor_ + static_cast<double>(cell.high)});
    ++region.columns;
    if (static_cast<double>(cell.depth) > region.depth.mm()) {
      region.depth = mm(static_cast<double>(cell.depth));
      region.at = {x, y, floor_ + static_cast<double>(cell.at)};
    }
    for (int y1 = std::max(j - 1, 0); y1 <= std::min(j + 1, ny_ - 1); ++y1) {
      for (int x1 = std::max(i - 1, 0); x1 <= std::min(i + 1, nx_ - 1); ++x1) {
        const std::size_t next =
            static_cast<std::size_t>(y1) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(x1);
        if (seen[next] || !(of_kind[next].depth > 0.0f)) continue;
        seen[next] = true;
        open.push_back(next);
      }
    }
  }
  region.volume = mm3(volume);
  return region;
}

void Comparer::gather_regions(DifferenceKind kind) {
  const std::vector<Cell>& of_kind = cells(kind);
  std::vector<bool> seen(of_kind.size(), false);
  for (std::size_t n = 0; n < of_kind.size(); ++n) {
    if (seen[n] || !(of_kind[n].depth > 0.0f)) continue;
    out_.regions.push_back(flood(kind, n, seen));
    ++out_.region_count;
    if (out_.regions.size() < 2 * max_regions_ + 64) continue;  // keeps memory bounded
    std::sort(out_.regions.begin(), out_.regions.end(),
              [](const auto& a, const auto& b) { return a.depth > b.depth; });
    out_.regions.resize(max_regions_);
  }
}

std::optional<Comparison> Comparer::run(const ColumnPositions& grid, const ColumnRuns& target,
                                        Progress* progress) {
  if (progress != nullptr) progress->phase("comparing");
  grid_ = grid;
  floor_ = part_.bounds().low.z;
  reach_ = 2.0 * length(part_.bounds().size());
  out_.nx = nx_;
  out_.ny = ny_;
  const std::size_t count = static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_);
  gouges_.resize(count);
  rests_.resize(count);
  out_.map.assign(count, 0.0f);
  out_.in_target.assign(count, false);
  for (int j = 0; j < ny_; ++j) {
    report(progress, static_cast<double>(j) / ny_);
    if (stop_requested(progress)) return std::nullopt;
    for (int i = 0; i < nx_; ++i) compare_column(i, j, target.column(i, j));
  }
  gather_regions(DifferenceKind::gouge);
  gather_regions(DifferenceKind::rest);
  std::sort(out_.regions.begin(), out_.regions.end(),
            [](const auto& a, const auto& b) { return a.depth > b.depth; });
  out_.regions.resize(std::min(out_.regions.size(), max_regions_));
  return std::move(out_);
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
  const Workpiece::Body& body = part.body();
  const Point3 low = body.bounds.low;
  const ColumnPositions grid{
      low.x + 0.5 * body.pitch, low.y + 0.5 * body.pitch, low.z, body.pitch, body.nx, body.ny,
      body.bounds.high.x,       body.bounds.high.y};
  const auto columns = target.columns(grid, diagnostics, progress);
  if (!columns) return std::nullopt;
  warn_outside(body.bounds, target, diagnostics);
  return Comparer(part, target, options).run(grid, *columns, progress);
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
