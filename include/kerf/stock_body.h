// Material that is no full block: a closed mesh, or the columns that an earlier job has left. The simulator
// asks a body for the material on vertical lines; a comparison asks a mesh how far its surface is.
//
//   Diagnostics diagnostics;
//   auto body = make_mesh_body(positions, triangles, "casting.stl", diagnostics);
//   if (body) stock = stock_of(body);
//
// Frame: mm, work coordinates, Z up.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/geometry.h"
#include "kerf/progress.h"
#include "kerf/stock.h"
#include "kerf/units.h"

namespace kerf {

/// A grid of vertical lines: column (i, j) stands at x + i * pitch, y + j * pitch. Heights count from z.
struct ColumnPlaces {
  double x = 0.0, y = 0.0, z = 0.0;  // mm
  double pitch = 1.0;                // mm
  int nx = 0, ny = 0;
  /// Where the last column and row end that are narrower than a pitch, mm: their lines stand in the middle of
  /// what is left of them. Nothing: they are as wide as all.
  std::optional<double> end_x = std::nullopt, end_y = std::nullopt;

  double x_of(int i) const { return place(x, i, nx, end_x); }
  double y_of(int j) const { return place(y, j, ny, end_y); }

 private:
  double place(double first, int k, int count, const std::optional<double>& end) const {
    const bool is_narrow = end && k + 1 == count;
    return is_narrow ? 0.5 * (first + (k - 0.5) * pitch + *end) : first + k * pitch;
  }
};

/// A stretch of material on a vertical line, mm above the z of its ColumnPlaces.
struct Run {
  float low = 0.0f, high = 0.0f;
  bool operator==(const Run&) const = default;
};

/// The material on the lines: column (i, j) is number j * nx + i and owns the runs first[number] to
/// first[number + 1] - 1, lowest first and apart.
struct ColumnRuns {
  int nx = 0, ny = 0;
  std::vector<std::uint32_t> first;
  std::vector<Run> runs;

  std::span<const Run> column(int i, int j) const {
    const std::size_t n =
        static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i);
    return {runs.data() + first[n], first[n + 1] - first[n]};
  }
};

/// Columns that an earlier job has left.
struct LeftColumns {
  Box3 bounds;          // mm, of the block that they were cut from
  ColumnPlaces places;  // the first one's middle; a last row or column may reach beyond the block
  ColumnRuns columns;
};

/// Half a turn of the stock about an axis that is parallel to X or Y, then a shift.
struct StockMove {
  enum class Flip : std::uint8_t { none, about_x, about_y };
  Flip flip = Flip::none;
  std::optional<double>
      across;               // y of an axis along X, x of one along Y, mm; else through the block's middle
  std::optional<double> z;  // of the axis, mm; else through the block's middle, so that the block stays
  Point3 shift;             // mm
};

class StockBody {
 public:
  struct Inside;
  explicit StockBody(std::unique_ptr<Inside> inside);
  ~StockBody();

  const Box3& bounds() const;
  /// Of a mesh exactly (parts that overlap count twice), of columns by their sum.
  Volume volume() const;
  /// The pitch that the body is known at; nothing for a mesh, which is known at any.
  std::optional<Length> pitch() const;
  /// The material on the lines. Lines through corners and edges of a mesh are told in or out as if they were
  /// moved by the smallest distance there is, the same for all triangles, so that none leaks. Appends an
  /// error and returns nothing where a mesh has a hole that a line goes through, and warnings where its parts
  /// overlap. Nothing, without an error, if stopped.
  std::optional<ColumnRuns> columns(const ColumnPlaces& places, Diagnostics& diagnostics,
                                    Progress* progress = nullptr) const;
  /// The body after a move. `move` must be complete.
  std::shared_ptr<const StockBody> moved(const StockMove& move) const;
  const Inside& inside() const { return *inside_; }

 private:
  std::unique_ptr<Inside> inside_;
};

/// Makes a body of triangles (positions x y z, three indices each). They are to enclose it, facing outwards.
/// Appends an error, and returns nothing, for a mesh without volume; warnings for edges without a partner and
/// for triangles that face the wrong way (which are turned, or told in and out by counting). `name` is the
/// file's.
std::shared_ptr<const StockBody> make_mesh_body(std::span<const double> positions,
                                                std::span<const std::uint32_t> triangles,
                                                const std::string& name, Diagnostics& diagnostics);
std::shared_ptr<const StockBody> make_columns_body(LeftColumns columns);

/// The stock that a body is: its block is the body's bounds.
Stock stock_of(std::shared_ptr<const StockBody> body);
/// The stock after a move, its block with it.
Stock moved(const Stock& stock, StockMove move);

/// How far points are from a mesh's surface.
class SurfaceDistance {
 public:
  /// Of a mesh body, which must outlive this; of columns everything is infinitely far.
  explicit SurfaceDistance(const StockBody& body);
  ~SurfaceDistance();
  /// mm; at most `limit`, which makes the search short.
  double at(Point3 p, double limit) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace kerf
