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

class Caster {
 public:
  Caster(const MeshSolid& mesh, const ColumnPositions& positions) : mesh_(mesh), positions_(positions) {
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
  Range columns_in_row(const Plan* p, std::int64_t y) const;
  bool cast_band(int band);
  void add_column(std::size_t begin, std::size_t end, int i, int j, RunSink& sink);
  void report_faults(Diagnostics& diagnostics) const;

  const MeshSolid& mesh_;
  const ColumnPositions& positions_;
  std::vector<std::int64_t> x_, y_;                 // lines, on the lattice
  std::vector<std::uint32_t> band_first_, listed_;  // triangles by bands of rows
  std::vector<std::size_t> start_;                  // of a band's columns among its crossings
  std::vector<Crossing> crossings_;
  ColumnRuns result_;
  std::size_t odd_ = 0, overlapping_ = 0;
  Point2 first_odd_, first_overlap_;
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

/// The columns of a row within the outline of a triangle, and one more at each end for the exact test.
Caster::Range Caster::columns_in_row(const Plan* p, std::int64_t y) const {
  double low = 1e300, high = -1e300;
  for (int k = 0; k < 3; ++k) {
    const Plan a = p[k], b = p[(k + 1) % 3];
    if ((a.y < y && b.y < y) || (a.y > y && b.y > y)) continue;
    const auto ax = static_cast<double>(a.x), bx = static_cast<double>(b.x);
    if (a.y == b.y) {
      low = std::min({low, ax, bx});
      high = std::max({high, ax, bx});
      continue;
    }
    const double x = ax + (bx - ax) * static_cast<double>(y - a.y) / static_cast<double>(b.y - a.y);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  if (low > high) return {0, -1};
  return between(x_, static_cast<std::int64_t>(low) - 2, static_cast<std::int64_t>(high) + 2);
}

template <class Visit>
void Caster::visit_crossings(const Triangle& t, int first_row, int last_row, const Visit& visit) const {
  const Plan p[3] = {plan(t[0]), plan(t[1]), plan(t[2])};
  if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) return;  // vertical: an edge without a left side
  double z[3];
  for (std::size_t k = 0; k < 3; ++k) z[k] = mesh_.at(t[k]).z - positions_.z;
  const auto [lowest, highest] = std::minmax({z[0], z[1], z[2]});
  const Range rows = rows_of(t);
  for (int j = std::max(rows.first, first_row); j <= std::min(rows.last, last_row); ++j) {
    const std::int64_t y = y_[static_cast<std::size_t>(j)];
    const Range columns = columns_in_row(p, y);
    for (int i = columns.first; i <= columns.last; ++i) {
      const Plan at{x_[static_cast<std::size_t>(i)], y};
      double area[3];  // opposite to corner 2, 0, 1
      const bool left = is_left(p[0], p[1], at, area[2]);
      if (is_left(p[1], p[2], at, area[0]) != left || is_left(p[2], p[0], at, area[1]) != left) continue;
      const double sum = area[0] + area[1] + area[2];
      double height = sum != 0.0 ? (area[0] * z[0] + area[1] * z[1] + area[2] * z[2]) / sum : lowest;
      height = std::clamp(height, lowest, highest);
      visit(i, j, Crossing{static_cast<float>(height), left ? -1 : 1});
    }
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
      add_column(start_[number(i, j)], start_[number(i, j) + 1], i, j, sink);
  sink.end_columns();
  result_.first.pop_back();  // it is the next band's first
  return true;
}

void Caster::add_column(std::size_t begin, std::size_t end, int i, int j, RunSink& sink) {
  sink.start_column();
  if (begin == end) return;
  Crossing* const first = crossings_.data() + begin;
  Crossing* const last = crossings_.data() + end;
  std::sort(first, last, [](const Crossing& a, const Crossing& b) {
    return a.z != b.z ? a.z < b.z : a.enters > b.enters;
  });
  const Point2 at{positions_.x_of(i), positions_.y_of(j)};
  const bool counts = !mesh_.is_oriented;
  int depth = 0;
  bool overlaps = false;
  float low = 0.0f;
  for (const Crossing* c = first; c != last; ++c) {
    const int before = depth;
    depth = counts ? 1 - depth : depth + c->enters;
    overlaps = overlaps || ((depth > 1 || depth < 0) && c + 1 != last && (c + 1)->z > c->z + kNoGap);
    if (before == 0) low = c->z;
    if (before != 0 && depth == 0) sink.add(low, c->z);
  }
  if (overlaps && overlapping_++ == 0) first_overlap_ = at;
  if (depth != 0 && odd_++ == 0) first_odd_ = at;
}

void Caster::report_faults(Diagnostics& diagnostics) const {
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
}

std::optional<ColumnRuns> Caster::run(Diagnostics& diagnostics, Progress* progress) {
  sort_into_bands();
  const int bands = (positions_.ny + kBand - 1) / kBand;
  for (int band = 0; band < bands; ++band) {
    report(progress, static_cast<double>(band) / bands);
    if (stop_requested(progress)) return std::nullopt;
    if (cast_band(band)) continue;
    diagnostics.error(codes::mesh_too_large, TextLocation{mesh_.name, 0, 0},
                      "the mesh has more surfaces above each other than the limit");
    return std::nullopt;
  }
  result_.first.push_back(static_cast<std::uint32_t>(result_.runs.size()));
  report_faults(diagnostics);
  if (odd_ > 0) return std::nullopt;
  return std::move(result_);
}

}  // namespace

std::optional<ColumnRuns> mesh_columns(const MeshSolid& mesh, const ColumnPositions& positions,
                                       Diagnostics& diagnostics, Progress* progress) {
  if (progress != nullptr) progress->phase("reading the body");
  return Caster(mesh, positions).run(diagnostics, progress);
}

}  // namespace kerf::solid
