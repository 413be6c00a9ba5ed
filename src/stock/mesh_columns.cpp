// Vertical lines through a mesh. A line is a point in plan; it intersects the triangles that contain the
// point. The test uses integers, and a point on an edge or vertex counts as moved by an infinitesimal
// distance in X and a still smaller one in Y. So each line enters as often as it leaves wherever the mesh is
// closed.
#include <algorithm>
#include <fmt/format.h>

#include "base/codes/stock.h"
#include "stock/body.h"

#include "kerf/base/limits.h"

namespace kerf::solid {
namespace {

__extension__ typedef __int128 Wide;  // of products of differences on the lattice

constexpr int kBand = 64;  // rows of columns processed together
/// Lines this far outside of a triangle's bounds are tested too, as the bounds are rounded.
constexpr std::int64_t kSlack = 2;

struct Plan {
  std::int64_t x, y;
  bool operator==(const Plan&) const = default;
};

/// Twice the area of a, b, p: above 0 if p lies left of a to b. The sign is exact.
double side_of(Plan a, Plan b, Plan p) {
  const auto bx = static_cast<double>(b.x - a.x), by = static_cast<double>(b.y - a.y);
  const auto px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
  const double left = bx * py, right = by * px;
  // Differences are exact in double precision; products and their difference are off by three roundings.
  constexpr double kRounding = 4.0 / 9007199254740992.0;
  const double area = left - right;
  if (std::abs(area) > kRounding * (std::abs(left) + std::abs(right))) return area;
  const Wide exact = Wide{b.x - a.x} * (p.y - a.y) - Wide{b.y - a.y} * (p.x - a.x);
  return static_cast<double>(exact);
}

/// Whether p, moved infinitesimally, lies left of a to b: true for one of the two directions of an edge.
bool is_left(Plan a, Plan b, Plan p, double& area) {
  area = side_of(a, b, p);
  if (area != 0.0) return area > 0.0;
  if (b.y != a.y) return b.y < a.y;
  return b.x > a.x;
}

struct Crossing {
  float z;
  std::int32_t enters;  // 1 going up into the body, -1 out of it
};

/// A triangle for lines that intersect it.
struct Facet {
  Facet(const MeshSolid& mesh, const std::array<std::uint32_t, 3>& t, double floor) {
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = {mesh.points[t[k]].x, mesh.points[t[k]].y};
      z[k] = mesh.at(t[k]).z - floor;
    }
  }
  /// An edge in plan, without a left side.
  bool is_vertical() const { return p[0] == p[1] || p[1] == p[2] || p[2] == p[0]; }
  std::optional<Crossing> at(Plan line) const;
  /// Bounds in X, within rounding, of the part of the outline between two positions in Y; low above high:
  /// none.
  struct Span {
    double low = 1e300, high = -1e300;
  };
  Span between(std::int64_t low_y, std::int64_t high_y) const;

  Plan p[3];
  double z[3];  // mm above the floor
};

std::optional<Crossing> Facet::at(Plan line) const {
  double area[3];  // opposite to corner 2, 0, 1
  const bool left = is_left(p[0], p[1], line, area[2]);
  if (is_left(p[1], p[2], line, area[0]) != left || is_left(p[2], p[0], line, area[1]) != left)
    return std::nullopt;
  const auto [lowest, highest] = std::minmax({z[0], z[1], z[2]});
  const double sum = area[0] + area[1] + area[2];
  const double height = sum != 0.0 ? (area[0] * z[0] + area[1] * z[1] + area[2] * z[2]) / sum : lowest;
  return Crossing{static_cast<float>(std::clamp(height, lowest, highest)), left ? -1 : 1};
}

Facet::Span Facet::between(std::int64_t low_y, std::int64_t high_y) const {
  Span out;
  for (int k = 0; k < 3; ++k) {
    const Plan a = p[k], b = p[(k + 1) % 3];
    if ((a.y < low_y && b.y < low_y) || (a.y > high_y && b.y > high_y)) continue;
    const auto ax = static_cast<double>(a.x), bx = static_cast<double>(b.x);
    for (const Plan end : {a, b}) {
      const std::int64_t y = std::clamp(end.y, low_y, high_y);
      const double x = y == end.y
                           ? static_cast<double>(end.x)
                           : ax + (bx - ax) * static_cast<double>(y - a.y) / static_cast<double>(b.y - a.y);
      out.low = std::min(out.low, x);
      out.high = std::max(out.high, x);
    }
  }
  return out;
}

/// Makes the material on a line of its crossings, and reports lines that a mesh leaves open or that cross
/// overlapping bodies.
class RunMaker {
 public:
  explicit RunMaker(const MeshSolid& mesh) : mesh_(mesh) {}
  /// Sorts the crossings.
  void add_column(std::span<Crossing> crossings, Point2 at, RunSink& sink);
  /// False with an error if a line passes through a hole.
  bool report_faults(Diagnostics& diagnostics) const;

 private:
  const MeshSolid& mesh_;
  std::size_t odd_ = 0, overlapping_ = 0;
  Point2 first_odd_, first_overlap_;
};

void RunMaker::add_column(std::span<Crossing> crossings, Point2 at, RunSink& sink) {
  sink.start_column();
  if (crossings.empty()) return;
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.z != b.z ? a.z < b.z : a.enters > b.enters;
  });
  const bool counts = !mesh_.is_oriented;
  int depth = 0;
  bool overlaps = false;
  float low = 0.0f;
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    const Crossing& c = crossings[k];
    const int before = depth;
    depth = counts ? 1 - depth : depth + c.enters;
    overlaps = overlaps ||
               ((depth > 1 || depth < 0) && k + 1 < crossings.size() && crossings[k + 1].z > c.z + kNoGap);
    if (before == 0) low = c.z;
    if (before != 0 && depth == 0) sink.add(low, c.z);
  }
  if (overlaps && overlapping_++ == 0) first_overlap_ = at;
  if (depth != 0 && odd_++ == 0) first_odd_ = at;
}

bool RunMaker::report_faults(Diagnostics& diagnostics) const {
  const TextLocation file{mesh_.name, 0, 0};
  if (odd_ > 0) {
    diagnostics
        .error(
            codes::mesh_open, file,
            fmt::format("{} vertical lines enter the mesh without leaving it, or the reverse; the first at "
                        "X{:.3f} Y{:.3f}",
                        odd_, first_odd_.x, first_odd_.y))
        .hint = "close the holes of the mesh";
  } else if (overlapping_ > 0) {
    diagnostics.warning(codes::mesh_crossing, file,
                        fmt::format("bodies of the mesh overlap on {} vertical lines, the first at X{:.3f} "
                                    "Y{:.3f}; their union is used",
                                    overlapping_, first_overlap_.x, first_overlap_.y));
  }
  return odd_ == 0;
}

void report_too_many(const MeshSolid& mesh, Diagnostics& diagnostics) {
  diagnostics.error(codes::mesh_too_large, TextLocation{mesh.name, 0, 0},
                    "the mesh has more surfaces above each other than the limit");
}

class Caster {
 public:
  Caster(const MeshSolid& mesh, const ColumnPositions& positions)
      : mesh_(mesh), positions_(positions), maker_(mesh) {
    for (int i = 0; i < positions.nx; ++i) x_.push_back(to_lattice(positions.x_of(i)));
    for (int j = 0; j < positions.ny; ++j) y_.push_back(to_lattice(positions.y_of(j)));
    result_.nx = positions.nx;
    result_.ny = positions.ny;
    result_.first.reserve(x_.size() * y_.size() + 1);
  }

  std::optional<ColumnRuns> run(Diagnostics& diagnostics, Progress* progress);

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  struct Range {
    int first, last;
  };
  /// Lines of one axis between two positions.
  static Range between(const std::vector<std::int64_t>& lines, std::int64_t low, std::int64_t high) {
    const auto begin = std::lower_bound(lines.begin(), lines.end(), low);
    const auto end = std::upper_bound(begin, lines.end(), high);
    return {static_cast<int>(begin - lines.begin()), static_cast<int>(end - lines.begin()) - 1};
  }
  Plan plan(std::uint32_t v) const { return {mesh_.points[v].x, mesh_.points[v].y}; }
  Range rows_of(const Triangle& t) const {
    const auto [low, high] = std::minmax({plan(t[0]).y, plan(t[1]).y, plan(t[2]).y});
    return between(y_, low, high);
  }
  void sort_into_bands();
  template <class Visit>
  void visit_crossings(const Triangle& t, int first_row, int last_row, const Visit& visit) const;
  bool cast_band(int band);

  const MeshSolid& mesh_;
  const ColumnPositions& positions_;
  std::vector<std::int64_t> x_, y_;                 // lines, on the lattice
  std::vector<std::uint32_t> band_first_, listed_;  // triangles by bands of rows
  std::vector<std::size_t> start_;                  // of a band's columns among its crossings
  std::vector<Crossing> crossings_;
  ColumnRuns result_;
  RunMaker maker_;
};

void Caster::sort_into_bands() {
  const std::size_t bands = (y_.size() + kBand - 1) / kBand;
  band_first_.assign(bands + 1, 0);
  const auto each = [this](const auto& visit) {
    for (std::size_t n = 0; n < mesh_.triangles.size(); ++n) {
      const Range rows = rows_of(mesh_.triangles[n]);
      if (rows.first > rows.last) continue;
      for (int band = rows.first / kBand; band <= rows.last / kBand; ++band)
        visit(static_cast<std::size_t>(band), static_cast<std::uint32_t>(n));
    }
  };
  each([this](std::size_t band, std::uint32_t) { ++band_first_[band + 1]; });
  for (std::size_t band = 0; band < bands; ++band) band_first_[band + 1] += band_first_[band];
  listed_.resize(band_first_.back());
  std::vector<std::uint32_t> next(band_first_.begin(), band_first_.end() - 1);
  each([&](std::size_t band, std::uint32_t n) { listed_[next[band]++] = n; });
}

template <class Visit>
void Caster::visit_crossings(const Triangle& t, int first_row, int last_row, const Visit& visit) const {
  const Facet facet(mesh_, t, positions_.z);
  if (facet.is_vertical()) return;
  const Range rows = rows_of(t);
  for (int j = std::max(rows.first, first_row); j <= std::min(rows.last, last_row); ++j) {
    const std::int64_t y = y_[static_cast<std::size_t>(j)];
    const Facet::Span span = facet.between(y, y);
    if (span.low > span.high) continue;
    const Range columns = between(x_, static_cast<std::int64_t>(span.low) - kSlack,
                                  static_cast<std::int64_t>(span.high) + kSlack);
    for (int i = columns.first; i <= columns.last; ++i)
      if (const auto crossing = facet.at({x_[static_cast<std::size_t>(i)], y})) visit(i, j, *crossing);
  }
}

bool Caster::cast_band(int band) {
  const int first_row = band * kBand, last_row = std::min(first_row + kBand, positions_.ny) - 1;
  const auto columns = static_cast<std::size_t>(positions_.nx);
  const std::size_t count = static_cast<std::size_t>(last_row - first_row + 1) * columns;
  const auto number = [&](int i, int j) {
    return static_cast<std::size_t>(j - first_row) * columns + static_cast<std::size_t>(i);
  };
  const auto each = [&](const auto& visit) {
    for (std::uint32_t k = band_first_[static_cast<std::size_t>(band)];
         k < band_first_[static_cast<std::size_t>(band) + 1]; ++k)
      visit_crossings(mesh_.triangles[listed_[k]], first_row, last_row, visit);
  };
  start_.assign(count + 1, 0);
  each([&](int i, int j, const Crossing&) { ++start_[number(i, j) + 1]; });
  for (std::size_t k = 0; k < count; ++k) start_[k + 1] += start_[k];
  if (start_.back() + result_.runs.size() > limits::kMaxStockCrossings) return false;
  crossings_.resize(start_.back());
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  each([&](int i, int j, const Crossing& crossing) { crossings_[next[number(i, j)]++] = crossing; });
  RunSink sink(result_);
  for (int j = first_row; j <= last_row; ++j)
    for (int i = 0; i < positions_.nx; ++i)
      maker_.add_column(
          {crossings_.data() + start_[number(i, j)], crossings_.data() + start_[number(i, j) + 1]},
          {positions_.x_of(i), positions_.y_of(j)}, sink);
  sink.end_columns();
  result_.first.pop_back();  // it is the next band's first
  return true;
}

std::optional<ColumnRuns> Caster::run(Diagnostics& diagnostics, Progress* progress) {
  sort_into_bands();
  const int bands = (positions_.ny + kBand - 1) / kBand;
  for (int band = 0; band < bands; ++band) {
    report(progress, static_cast<double>(band) / bands);
    if (stop_requested(progress)) return std::nullopt;
    if (cast_band(band)) continue;
    report_too_many(mesh_, diagnostics);
    return std::nullopt;
  }
  result_.first.push_back(static_cast<std::uint32_t>(result_.runs.size()));
  if (!maker_.report_faults(diagnostics)) return std::nullopt;
  return std::move(result_);
}

/// Lines at any points. The points are sorted into square buckets, row by row: those of a triangle are in one
/// range of buckets per row.
class PointCaster {
 public:
  PointCaster(const MeshSolid& mesh, std::span<const Point2> points, double floor);
  std::optional<ColumnRuns> run(Diagnostics& diagnostics, Progress* progress);

 private:
  struct Found {
    std::uint32_t point;
    Crossing crossing;
  };
  std::int64_t bucket_x(std::int64_t x) const {
    return std::clamp<std::int64_t>((x - low_.x) / side_, 0, nx_ - 1);
  }
  std::int64_t bucket_y(std::int64_t y) const {
    return std::clamp<std::int64_t>((y - low_.y) / side_, 0, ny_ - 1);
  }
  std::size_t number(std::int64_t x, std::int64_t y) const { return static_cast<std::size_t>(y * nx_ + x); }
  void sort_into_buckets();
  void cross(const Facet& facet);

  const MeshSolid& mesh_;
  std::span<const Point2> points_;
  double floor_;
  std::vector<Plan> lines_;
  Plan low_{}, high_{};
  std::int64_t side_ = 1, nx_ = 1, ny_ = 1;
  std::vector<std::uint32_t> first_, sorted_;  // lines by buckets
  std::vector<Found> found_;
};

PointCaster::PointCaster(const MeshSolid& mesh, std::span<const Point2> points, double floor)
    : mesh_(mesh), points_(points), floor_(floor) {
  lines_.reserve(points.size());
  for (const Point2 p : points) lines_.push_back({to_lattice(p.x), to_lattice(p.y)});
  if (!lines_.empty()) sort_into_buckets();
}

void PointCaster::sort_into_buckets() {
  constexpr double kBuckets = 4.0;  // per point, as points may lie along curves
  low_ = high_ = lines_[0];
  for (const Plan p : lines_) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  }
  const auto wide = static_cast<double>(high_.x - low_.x), deep = static_cast<double>(high_.y - low_.y);
  const double count = kBuckets * static_cast<double>(lines_.size());
  side_ =
      1 + static_cast<std::int64_t>(std::max(std::sqrt(wide / count * deep), std::max(wide, deep) / count));
  nx_ = (high_.x - low_.x) / side_ + 1;
  ny_ = (high_.y - low_.y) / side_ + 1;
  first_.assign(number(0, ny_) + 1, 0);
  const auto bucket = [this](Plan p) { return number(bucket_x(p.x), bucket_y(p.y)); };
  for (const Plan p : lines_) ++first_[bucket(p) + 1];
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  sorted_.resize(lines_.size());
  for (std::uint32_t n = 0; n < lines_.size(); ++n) sorted_[next[bucket(lines_[n])]++] = n;
}

void PointCaster::cross(const Facet& facet) {
  const auto [low, high] = std::minmax({facet.p[0].y, facet.p[1].y, facet.p[2].y});
  if (low > high_.y || high < low_.y || facet.is_vertical()) return;
  for (std::int64_t row = bucket_y(low); row <= bucket_y(high); ++row) {
    const std::int64_t y = low_.y + row * side_;
    const Facet::Span span = facet.between(y, y + side_);
    const std::int64_t x0 = static_cast<std::int64_t>(span.low) - kSlack,
                       x1 = static_cast<std::int64_t>(span.high) + kSlack;
    if (span.low > span.high || x0 > high_.x || x1 < low_.x) continue;
    for (std::uint32_t k = first_[number(bucket_x(x0), row)]; k < first_[number(bucket_x(x1), row) + 1]; ++k)
      if (const auto crossing = facet.at(lines_[sorted_[k]])) found_.push_back({sorted_[k], *crossing});
  }
}

std::optional<ColumnRuns> PointCaster::run(Diagnostics& diagnostics, Progress* progress) {
  constexpr std::size_t kReport = 1 << 16;  // triangles between two reports
  const std::size_t triangles = lines_.empty() ? 0 : mesh_.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t) {
    if (t % kReport == 0) report(progress, static_cast<double>(t) / static_cast<double>(triangles));
    if (t % kReport == 0 && stop_requested(progress)) return std::nullopt;
    cross(Facet(mesh_, mesh_.triangles[t], floor_));
    if (found_.size() <= limits::kMaxStockCrossings) continue;
    report_too_many(mesh_, diagnostics);
    return std::nullopt;
  }
  std::vector<std::size_t> start(lines_.size() + 1, 0);
  for (const Found& f : found_) ++start[f.point + 1];
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  std::vector<Crossing> crossings(found_.size());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (const Found& f : found_) crossings[next[f.point]++] = f.crossing;
  ColumnRuns result{.nx = static_cast<int>(lines_.size()), .ny = 1, .first = {}, .runs = {}};
  RunMaker maker(mesh_);
  RunSink sink(result);
  for (std::size_t n = 0; n < lines_.size(); ++n)
    maker.add_column({crossings.data() + start[n], crossings.data() + start[n + 1]}, points_[n], sink);
  sink.end_columns();
  if (!maker.report_faults(diagnostics)) return std::nullopt;
  return result;
}

}  // namespace

std::optional<ColumnRuns> mesh_columns(const MeshSolid& mesh, const ColumnPositions& positions,
                                       Diagnostics& diagnostics, Progress* progress) {
  if (progress != nullptr) progress->phase("reading the body");
  return Caster(mesh, positions).run(diagnostics, progress);
}

std::optional<ColumnRuns> mesh_runs(const MeshSolid& mesh, std::span<const Point2> points, double floor,
                                    Diagnostics& diagnostics, Progress* progress) {
  return PointCaster(mesh, points, floor).run(diagnostics, progress);
}

}  // namespace kerf::solid
