// The surface of a rotary workpiece: the rays are unrolled into columns, these are meshed, and the mesh is
// rolled up. The columns have a row more at each end, copies of those at the other end, so that the surface
// is the same on both sides of the seam; what belongs to the copies is left out, and the seam is joined. The
// axis of the bar is a face of the columns, which shrinks to a line when it is rolled up.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "sim/mesh/mesh_build.h"

#include "kerf/geom/mesh_check.h"
#include "kerf/sim/rotary.h"

namespace kerf {
namespace {

constexpr double kAxis = 0.1;  // of the distance of the rays: material that ends nearer the axis ends on it
constexpr int kCopies = 4;     // rows at each end: vertices depend on the rows beside theirs

/// The rays as columns whose heights are distances from the axis. Every run end gets a unique number as its
/// step, so that no level faces are merged, which would be flat after rolling up; `ends` has the step and the
/// row of each number.
struct RunEnd {
  std::uint32_t step = 0;
  int row = 0;  // of the unrolled columns
};
ColumnGrid unroll(const RotaryWorkpiece& work, int first_row, std::vector<RunEnd>& ends) {
  ColumnGrid grid;
  grid.pitch = 1.0;
  grid.nx = work.along;
  grid.ny = work.around + 2 * kCopies;
  const double radius = 0.5 * work.bar.diameter;
  grid.bounds.add(Point3{0, 0, 0});
  grid.bounds.add(Point3{static_cast<double>(grid.nx), static_cast<double>(grid.ny), radius / work.dx});
  const auto height = [&work](float r) {
    const double h = static_cast<double>(r) / work.dx;
    return h < kAxis ? 0.0f : static_cast<float>(h);
  };
  for (int j = 0; j < grid.ny; ++j) {
    const int row = (j + first_row + kCopies * (work.around - 1)) % work.around;
    for (int i = 0; i < work.along; ++i) {
      grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
      for (const Interval& run :
           work.rays[static_cast<std::size_t>(row) * static_cast<std::size_t>(work.along) +
                     static_cast<std::size_t>(i)]) {
        if (!(height(run.high) > 0.0f)) continue;
        const auto number = static_cast<std::uint32_t>(ends.size());
        ends.push_back({run.low_step, j});
        ends.push_back({run.high_step, j});
        grid.intervals.push_back({height(run.low), height(run.high), number, number + 1});
      }
    }
  }
  grid.first.push_back(static_cast<std::uint32_t>(grid.intervals.size()));
  return grid;
}

/// Numbers the vertices of an unrolled mesh so that those at one position of the bar are one: on the axis,
/// whatever their angle, and at both ends of the turn, where the positions differ by rounding.
class Welder {
 public:
  Welder(const Mesh& flat, int around)
      : flat_(flat), around_(static_cast<float>(around)), numbers_(flat.positions.size() / 3, kNone) {}

  /// The vertex of the rolled mesh; `positions` receives new ones, unrolled.
  std::uint32_t vertex(std::uint32_t v, std::vector<float>& positions) {
    if (numbers_[v] == kNone) numbers_[v] = weld(v, positions);
    return numbers_[v];
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t number : cell)
        hash = (hash ^ static_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15ull;
      return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
  };
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr float kSame = 2e-3f;  // of the distance of the rays; single precision in 10,000 of them
  static constexpr float kCell = 0.25f;
  static constexpr float kOffGrid =
      0.1f;  // so that few vertices, which mostly lie on a grid, are near two cells

  std::uint32_t weld(std::uint32_t v, std::vector<float>& positions) {
    const float* const p = flat_.positions.data() + std::size_t{3} * v;
    std::array<float, 3> at{p[0], p[1] - static_cast<float>(kCopies), p[2]};
    if (at[1] > 0.5f * around_) at[1] -= around_;
    if (at[2] < static_cast<float>(kAxis)) at = {at[0], 0.0f, 0.0f};
    const Cell low = cell_of(at, -kSame), high = cell_of(at, kSame);
    for (Cell c = low; c[0] <= high[0]; ++c[0])
      for (c[1] = low[1]; c[1] <= high[1]; ++c[1])
        for (c[2] = low[2]; c[2] <= high[2]; ++c[2])
          if (const std::uint32_t found = in_cell(c, at, positions); found != kNone) return found;
    const auto number = static_cast<std::uint32_t>(positions.size() / 3);
    positions.insert(positions.end(), at.begin(), at.end());
    next_.push_back(std::exchange(newest_.try_emplace(cell_of(at, 0.0f), kNone).first->second, number));
    return number;
  }
  /// The vertex of a cell at this position.
  std::uint32_t in_cell(const Cell& cell, const std::array<float, 3>& at,
                        const std::vector<float>& positions) const {
    const auto newest = newest_.find(cell);
    std::uint32_t n = newest == newest_.end() ? kNone : newest->second;
    while (n != kNone && !is_same(at, positions.data() + std::size_t{3} * n)) n = next_[n];
    return n;
  }
  static Cell cell_of(const std::array<float, 3>& p, float beside) {
    const auto number = [beside](float value) {
      return static_cast<std::int64_t>(std::floor((value + kOffGrid + beside) / kCell));
    };
    return {number(p[0]), number(p[1]), number(p[2])};
  }
  static bool is_same(const std::array<float, 3>& a, const float* b) {
    return std::abs(a[0] - b[0]) < kSame && std::abs(a[1] - b[1]) < kSame && std::abs(a[2] - b[2]) < kSame;
  }

  const Mesh& flat_;
  float around_;
  std::vector<std::uint32_t> numbers_;                    // of the vertices of the flat mesh
  std::unordered_map<Cell, std::uint32_t, Hash> newest_;  // the newest vertex of each cell
  std::vector<std::uint32_t> next_;                       // of each vertex: an older one of its cell
};

/// Whether a triangle belongs to the bar, not to the copies of its rows: by the row of the run that it
/// bounds, or, of walls beside empty columns, by its position.
bool is_in_turn(const Mesh& flat, std::size_t t, const std::vector<RunEnd>& ends, int around) {
  if (flat.step[t] < ends.size()) {
    const int row = ends[flat.step[t]].row;
    return row >= kCopies && row < kCopies + around;
  }
  constexpr double kOffLines = 0.123;  // so that no wall along a row is cut by rounding
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += static_cast<double>(flat.positions[std::size_t{3} * flat.triangles[3 * t + k] + 1]);
  const double y = sum / 3.0 - kCopies + kOffLines;
  return y >= 0.0 && y < around;
}

/// Adds triangles, those with a side on the axis divided at all vertices on it. Triangles on the axis are
/// left out: they have no area, and what is left of the others around the axis meets there.
class AxisSplitter {
 public:
  explicit AxisSplitter(Mesh& mesh) : mesh_(mesh) {
    for (std::uint32_t v = 0; v < mesh.positions.size() / 3; ++v)
      if (is_on_axis(v)) on_axis_.emplace_back(x(v), v);
    std::sort(on_axis_.begin(), on_axis_.end());
  }

  void add(std::array<std::uint32_t, 3> corners, std::uint32_t step) {
    int count = 0;
    for (const std::uint32_t v : corners) count += is_on_axis(v) ? 1 : 0;
    if (count == 3) return;
    if (count < 2) return add_one(corners[0], corners[1], corners[2], step);
    while (is_on_axis(corners[2])) std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    auto from = std::lower_bound(on_axis_.begin(), on_axis_.end(), std::pair(x(corners[0]), corners[0]));
    const auto to = std::lower_bound(on_axis_.begin(), on_axis_.end(), std::pair(x(corners[1]), corners[1]));
    const std::ptrdiff_t way = from < to ? 1 : -1;
    for (; from != to; from += way) add_one(from->second, (from + way)->second, corners[2], step);
  }

 private:
  float x(std::uint32_t v) const { return mesh_.positions[std::size_t{3} * v]; }
  bool is_on_axis(std::uint32_t v) const { return !(mesh_.positions[std::size_t{3} * v + 2] > 0.0f); }
  void add_one(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t step) {
    mesh_.triangles.insert(mesh_.triangles.end(), {a, b, c});
    mesh_.step.push_back(step);
  }

  Mesh& mesh_;
  std::vector<std::pair<float, std::uint32_t>> on_axis_;
};

/// The triangles of the turn, with the seam and the axis joined; still unrolled.
Mesh joined(const Mesh& flat, const std::vector<RunEnd>& ends, int around) {
  Mesh out;
  Welder welder(flat, around);
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> welded;
  for (std::size_t t = 0; t < flat.step.size(); ++t) {
    if (!is_in_turn(flat, t, ends, around)) continue;
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = welder.vertex(flat.triangles[3 * t + k], out.positions);
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    welded.emplace_back(corners, flat.step[t]);
  }
  AxisSplitter splitter(out);
  for (const auto& [corners, step] : welded) splitter.add(corners, step);
  return out;
}

/// Rolls the mesh up about an axis at Y0 Z0 from X0 on; lengths are multiplied by `scale`.
void roll_up(Mesh& mesh, const RotaryWorkpiece& work, int first_row, double scale) {
  for (std::size_t v = 0; v + 2 < mesh.positions.size(); v += 3) {
    float* const p = mesh.positions.data() + v;
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(p[1]) + first_row) / work.around;
    const double r = static_cast<double>(p[2]) * work.dx * scale;
    p[0] = static_cast<float>(static_cast<double>(p[0]) * work.dx * scale);
    p[1] = static_cast<float>(-r * std::sin(angle));
    p[2] = static_cast<float>(r * std::cos(angle));
  }
  // (along, around, outwards) is a left-handed frame, so triangles are inverted.
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3)
    std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
}

/// From the scaled coordinates of roll_up to those of the work.
void move_to_bar(Mesh& mesh, const RotaryWorkpiece& work, double scale) {
  const std::array<double, 3> zero{work.bar.x_low, work.bar.axis_y, work.bar.axis_z};
  for (std::size_t k = 0; k < mesh.positions.size(); ++k)
    mesh.positions[k] = static_cast<float>(zero[k % 3] + static_cast<double>(mesh.positions[k]) / scale);
}

/// The mesh with its seam before this row.
Mesh rolled_mesh(const RotaryWorkpiece& work, int first_row, Progress* progress) {
  std::vector<RunEnd> ends;
  const Mesh flat = extract_mesh(unroll(work, first_row, ends), progress);
  Mesh mesh = joined(flat, ends, work.around);
  // Triangles with all corners on one ray have no area, but for rounding: in a bar of this size it is below
  // the height at which triangles are removed.
  constexpr double kSize = 0.5;
  const double scale = kSize / std::max(work.along * work.dx, 0.5 * work.bar.diameter);
  roll_up(mesh, work, first_row, scale);
  // Parts that touch on the axis or along a ray share edges.
  std::vector<std::uint32_t> vertices(mesh.positions.size() / 3);
  std::iota(vertices.begin(), vertices.end(), std::uint32_t{0});
  std::vector<std::size_t> triangles(mesh.step.size());
  std::iota(triangles.begin(), triangles.end(), std::size_t{0});
  meshing::split_non_manifold(mesh, thread_count(0), vertices, triangles);
  meshing::remove_degenerate_triangles(mesh, thread_count(0));
  move_to_bar(mesh, work, scale);
  for (std::uint32_t& step : mesh.step)
    if (step < ends.size()) step = ends[step].step;
  return mesh;
}

}  // namespace

Mesh extract_mesh(const RotaryWorkpiece& work, Progress* progress) {
  // Where the surface is steep at the seam, rounding may divide it differently on both sides: it is moved.
  constexpr int kSeams = 8;
  Mesh mesh;
  for (int seam = 0; seam < kSeams; ++seam) {
    mesh = rolled_mesh(work, seam * work.around / kSeams, progress);
    if (stop_requested(progress) || check_mesh(mesh.positions, mesh.triangles).bad_edges == 0) break;
  }
  return mesh;
}

}  // namespace kerf
