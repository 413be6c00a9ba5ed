// What a mesh should hold, told by the columns that it is made of.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "sim/parallel.h"

#include "kerf/rotary.h"
#include "kerf/simulate.h"

namespace kerf {
namespace {

/// How far the side faces of columns may all be from where the mesh has them, in pitches. Why one is enough,
/// and how far they are: docs/decisions/0006-mesh.md.
constexpr double kSideShare = 1.0;
constexpr int kBandRows = 64;

using Runs = std::span<const Interval>;

/// Columns by what their faces are: what they hold, the area of their ends, and the area of their sides that
/// stand bare beside their neighbours'.
struct Faces {
  double volume = 0.0, ends = 0.0, sides = 0.0;  // mm3, mm2
};

/// The measure of what is in one of two columns and not in the other; measure(low, high) of a run.
template <class Measure>
double unshared(Runs a, Runs b, const Measure& measure) {
  if (a.size() == 1 && b.size() == 1 && a[0].low < b[0].high && b[0].low < a[0].high)
    return measure(std::min(a[0].low, b[0].low), std::max(a[0].low, b[0].low)) +
           measure(std::min(a[0].high, b[0].high), std::max(a[0].high, b[0].high));
  double sum = 0.0;
  for (const Interval& run : a) sum += measure(run.low, run.high);
  for (const Interval& run : b) sum += measure(run.low, run.high);
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    const float low = std::max(a[i].low, b[k].low), high = std::min(a[i].high, b[k].high);
    if (low < high) sum -= 2.0 * measure(low, high);
    (a[i].high < b[k].high ? i : k) += 1;
  }
  return sum;
}

double height(float low, float high) { return static_cast<double>(high) - static_cast<double>(low); }

class BlockFaces {
 public:
  explicit BlockFaces(const ColumnGrid& grid) : grid_(grid), size_(grid.bounds.size()) {}

  Faces of_rows(int first, int end) const {
    Faces faces;
    for (int j = first; j < end; ++j) {
      const double deep = width(j, size_.y);
      for (int i = 0; i < grid_.nx; ++i) {
        const double wide = width(i, size_.x);
        const Runs runs = column(i, j);
        for (const Interval& run : runs) faces.volume += wide * deep * height(run.low, run.high);
        faces.ends += 2.0 * wide * deep * static_cast<double>(runs.size());
        if (i + 1 < grid_.nx) faces.sides += deep * unshared(runs, column(i + 1, j), height);
        if (j + 1 < grid_.ny) faces.sides += wide * unshared(runs, column(i, j + 1), height);
      }
    }
    return faces;
  }

 private:
  /// The last column may be narrower.
  double width(int i, double size) const { return std::clamp(size - i * grid_.pitch, 0.0, grid_.pitch); }
  Runs column(int i, int j) const {
    const std::size_t n =
        static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.nx) + static_cast<std::size_t>(i);
    return {grid_.intervals.data() + grid_.first[n], grid_.first[n + 1] - grid_.first[n]};
  }

  const ColumnGrid& grid_;
  Point3 size_;
};

Faces faces_of(const ColumnGrid& grid, unsigned threads) {
  if (grid.nx <= 0 || grid.ny <= 0 || grid.intervals.empty()) return {};
  const BlockFaces block(grid);
  std::vector<Faces> bands(static_cast<std::size_t>((grid.ny + kBandRows - 1) / kBandRows));
  sim::parallel_for(
      sim::thread_count(threads), bands.size(),
      [&](std::size_t band) {
        const int first = static_cast<int>(band) * kBandRows;
        bands[band] = block.of_rows(first, std::min(grid.ny, first + kBandRows));
      },
      [] { return false; });
  Faces sum;
  for (const Faces& faces : bands) {
    sum.volume += faces.volume;
    sum.ends += faces.ends;
    sum.sides += faces.sides;
  }
  return sum;
}

/// By how much the rounding of coordinates up to `farthest` mm to single precision may move a face.
double rounding(double farthest) {
  return farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
}

double farthest(const Box3& box) {
  if (box.empty()) return 0.0;
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    most = std::max({most, std::abs(box.low[axis]), std::abs(box.high[axis])});
  return most;
}

VolumeRange range_of(const Faces& faces, double pitch, double moved) {
  return {mm3(faces.volume), mm3(kSideShare * pitch * faces.sides + moved * (faces.ends + faces.sides))};
}

}  // namespace

VolumeRange mesh_volume(const ColumnGrid& columns, const MeshOptions& options) {
  return range_of(faces_of(columns, options.threads), columns.pitch,
                  options.tolerance.mm() + rounding(farthest(columns.bounds)));
}

VolumeRange mesh_volume(const RotaryWorkpiece& work) {
  const double turn = 2.0 * std::numbers::pi / work.around, radius = 0.5 * work.bar.diameter;
  const auto sector = [turn](float low, float high) {
    return 0.5 * turn * (static_cast<double>(high) * high - static_cast<double>(low) * low);
  };
  const auto ray = [&work](int i, int j) -> Runs {
    return work.rays[static_cast<std::size_t>(j) * static_cast<std::size_t>(work.along) +
                     static_cast<std::size_t>(i)];
  };
  Faces faces;
  for (int j = 0; j < work.around; ++j) {
    for (int i = 0; i < work.along; ++i) {
      const Runs runs = ray(i, j);
      for (const Interval& run : runs) {
        faces.volume += work.dx * sector(run.low, run.high);
        faces.ends += work.dx * turn * (static_cast<double>(run.low) + static_cast<double>(run.high));
      }
      if (i + 1 < work.along) faces.sides += unshared(runs, ray(i + 1, j), sector);
      faces.sides += work.dx * unshared(runs, ray(i, (j + 1) % work.around), height);
    }
  }
  const double most = std::max({std::abs(work.bar.x_low), std::abs(work.bar.x_high),
                                std::abs(work.bar.axis_y) + radius, std::abs(work.bar.axis_z) + radius});
  // Between two rays the surface is flat: a chord instead of an arc.
  const double sagitta = radius * turn * turn / 4.0;
  return range_of(faces, std::max(work.dx, radius * turn), sagitta + rounding(most));
}

MeshCheck check_mesh(const Mesh& mesh) { return check_mesh(mesh.positions, mesh.triangles); }

bool verify_mesh(const Mesh& mesh, const VolumeRange& volume, Diagnostics& diagnostics) {
  return verify_mesh(mesh.positions, mesh.triangles, volume, diagnostics);
}

}  // namespace kerf
