// Data of StockBody: triangles on an integer lattice, or columns.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "kerf/stock/stock.h"

namespace kerf::solid {

/// Vertices lie on a lattice of 2^-20 mm (about a nanometre). With integers the side on which a line passes
/// an edge is exact, and both triangles of the edge agree.
inline constexpr double kPerMm = 1 << 20;
struct Lattice {
  std::int64_t x = 0, y = 0, z = 0;
  bool operator==(const Lattice&) const = default;
};
inline std::int64_t to_lattice(double v) { return std::llround(v * kPerMm); }

struct MeshSolid {
  std::string name;
  std::vector<Lattice> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool is_oriented = true;  // all triangles face outwards; otherwise the inside is found by parity

  Point3 at(std::uint32_t v) const {
    const Lattice& p = points[v];
    return {static_cast<double>(p.x) / kPerMm, static_cast<double>(p.y) / kPerMm,
            static_cast<double>(p.z) / kPerMm};
  }
};

std::optional<ColumnRuns> mesh_columns(const MeshSolid& mesh, const ColumnPositions& positions,
                                       Diagnostics& diagnostics, Progress* progress);
/// The material on the vertical lines at any points: the runs of point n are those of column (n, 0), mm above
/// `floor`. Errors and warnings as StockBody::columns.
std::optional<ColumnRuns> mesh_runs(const MeshSolid& mesh, std::span<const Point2> points, double floor,
                                    Diagnostics& diagnostics, Progress* progress);
ColumnRuns resampled(const LeftColumns& left, const ColumnPositions& positions);

/// Runs closer than this to the next one are joined, and shorter ones dropped, mm: rounding of touching faces
/// in single precision and on the lattice.
inline constexpr float kNoGap = 1e-5f;
/// Appends the runs of a column, in order, without such gaps and crumbs.
class RunSink {
 public:
  explicit RunSink(ColumnRuns& out) : out_(out) {}
  void start_column() {
    finish();
    out_.first.push_back(static_cast<std::uint32_t>(out_.runs.size()));
  }
  void add(float low, float high) {
    if (open_ && low <= run_.high + kNoGap) {
      run_.high = high > run_.high ? high : run_.high;
      return;
    }
    finish();
    run_ = {low, high};
    open_ = true;
  }
  void end_columns() { start_column(); }

 private:
  void finish() {
    if (open_ && run_.high > run_.low + kNoGap) out_.runs.push_back(run_);
    open_ = false;
  }
  ColumnRuns& out_;
  Run run_;
  bool open_ = false;
};

}  // namespace kerf::solid

namespace kerf {
struct StockBody::Inside {
  std::variant<solid::MeshSolid, LeftColumns> what;
  Box3 bounds;
  double volume = 0.0;  // mm3
};
}  // namespace kerf
