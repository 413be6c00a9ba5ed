// The stock: the material before the first cut. Lengths in mm, work coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"

namespace kerf {

class StockBody;

/// A block of material, or a body (StockBody) inside it: an imported mesh, left-over stock.
struct Stock {
  Box3 block;                                       // mm, work coordinates
  std::shared_ptr<const StockBody> body = nullptr;  // null: the full block
};

/// The position of work zero on the block, in plan and in height.
enum class ZeroCorner : unsigned char {
  lower_left,
  lower_centre,
  lower_right,
  centre_left,
  centre,
  centre_right,
  top_left,
  top_centre,
  top_right,
};
enum class ZeroHeight : unsigned char { top, bottom };

/// The position of a corner as fractions of the width and depth from the lower left: 0, a half or 1.
Point2 fraction_of(ZeroCorner corner);

/// A block of `size` (mm) with work zero at the named position.
Stock make_block(Point3 size, ZeroCorner corner, ZeroHeight height);
/// Reads "Lower-Left", "centre left", "TOPLEFT" ...: case, spaces and hyphens are ignored, "center" is
/// "centre".
std::optional<ZeroCorner> parse_zero_corner(std::string_view name);
std::optional<ZeroHeight> parse_zero_height(std::string_view name);
/// The names for messages: "lower-left", ... and "top", "bottom".
const std::vector<std::string>& zero_corner_names();
const std::vector<std::string>& zero_height_names();
/// Whether the block has a volume: finite and low below high in every axis.
bool is_solid(const Stock& stock);

/// Collects the stock from the comments of a program: "STOCK/BLOCK, L, W, H, OX, OY, OZ" (CutViewer: work
/// zero from the lowest corner) and "stockMin: x, y, z" with "stockMax: ...", in all spacings of real files.
class StockComments {
 public:
  /// True if the comment (without parentheses) describes the stock. Errors go to `diagnostics`. Plain numbers
  /// are mm times `scale` (25.4 in a program in inches); numbers may have a unit ("-12.7mm", "4in"). A
  /// stockMin that is not below stockMax is ignored with a warning; STOCK/BLOCK is then used.
  bool read(std::string_view comment, double scale, const Origin& where, Diagnostics& diagnostics);
  /// The stock, from stockMin/stockMax first; nothing if the comments do not suffice.
  std::optional<Stock> stock() const;

 private:
  void check_corners(const Origin& where, Diagnostics& diagnostics);
  void check_agreement(const Origin& where, Diagnostics& diagnostics);

  std::optional<Point3> minimum_, maximum_;
  std::optional<Box3> block_;
};
/// The comments that describe a stock, without parentheses: stockMin, stockMax, STOCK/BLOCK.
std::vector<std::string> write_stock_comments(const Stock& stock);

// A round bar that turns about an axis along X: the stock of a fourth axis (A).

struct RoundBar {
  double diameter = 0.0;              // mm
  double x_low = 0.0, x_high = 0.0;   // mm, its ends
  double axis_y = 0.0, axis_z = 0.0;  // mm, of the axis in work coordinates
};

/// The box around a bar, in work coordinates.
inline Box3 box_of(const RoundBar& bar) {
  const double radius = 0.5 * bar.diameter;
  Box3 box;
  box.add(Point3{bar.x_low, bar.axis_y - radius, bar.axis_z - radius});
  box.add(Point3{bar.x_high, bar.axis_y + radius, bar.axis_z + radius});
  return box;
}

// Stock that is not a block: a closed mesh, or the columns of an earlier job. The simulator queries the
// material on vertical lines; a comparison queries the distance from a mesh's surface.
//
//   Diagnostics diagnostics;
//   auto body = make_mesh_body(positions, triangles, "casting.stl", diagnostics);
//   if (body) stock = stock_of(body);
//
// Frame: mm, work coordinates, Z up.

/// A grid of vertical lines: column (i, j) is at x + i * pitch, y + j * pitch. Heights are relative to z.
struct ColumnPositions {
  double x = 0.0, y = 0.0, z = 0.0;  // mm
  double pitch = 1.0;                // mm
  int nx = 0, ny = 0;
  /// End of the last column and row if they are narrower than a pitch, mm: their lines are at the centre of
  /// the remaining width. Nothing: they have full width.
  std::optional<double> end_x = std::nullopt, end_y = std::nullopt;

  double x_of(int i) const { return position(x, i, nx, end_x); }
  double y_of(int j) const { return position(y, j, ny, end_y); }

 private:
  double position(double first, int k, int count, const std::optional<double>& end) const {
    const bool is_narrow = end && k + 1 == count;
    return is_narrow ? 0.5 * (first + (k - 0.5) * pitch + *end) : first + k * pitch;
  }
};

/// An interval of material on a vertical line, mm above the z of its ColumnPositions.
struct Run {
  float low = 0.0f, high = 0.0f;
  bool operator==(const Run&) const = default;
};

/// The material on the lines: column (i, j) is number j * nx + i and owns the runs first[number] to
/// first[number + 1] - 1, lowest first, separate.
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

/// Columns left by an earlier job.
struct LeftColumns {
  Box3 bounds;  // mm, of the block that they were cut from
  ColumnPositions
      positions;  // from the centre of the first one; a last row or column may extend beyond the block
  ColumnRuns columns;
};

/// Half a turn of the stock about an axis parallel to X or Y, then a shift.
struct StockMove {
  enum class Flip : std::uint8_t { none, about_x, about_y };
  Flip flip = Flip::none;
  std::optional<double>
      across;               // y of an axis along X, x of one along Y, mm; default: through the block's centre
  std::optional<double> z;  // of the axis, mm; default: through the block's centre, so that the block stays
  Point3 shift;             // mm
};

class StockBody {
 public:
  struct Inside;
  explicit StockBody(std::unique_ptr<Inside> inside);
  ~StockBody();

  const Box3& bounds() const;
  /// Exact for a mesh (overlapping bodies count twice), the sum for columns.
  Volume volume() const;
  /// The pitch of the columns; nothing for a mesh.
  std::optional<Length> pitch() const;
  /// The material on the lines. Lines through vertices and edges of a mesh are classified as if moved by an
  /// infinitesimal distance, the same for all triangles, so that none leaks. Appends an error and returns
  /// nothing if a line passes through a hole of the mesh, and warnings if bodies overlap. Nothing, without an
  /// error, if stopped.
  std::optional<ColumnRuns> columns(const ColumnPositions& positions, Diagnostics& diagnostics,
                                    Progress* progress = nullptr) const;
  /// The body after a move. `move` must be complete.
  std::shared_ptr<const StockBody> moved(const StockMove& move) const;
  const Inside& inside() const { return *inside_; }

 private:
  std::unique_ptr<Inside> inside_;
};

/// Makes a body of triangles (positions x y z, three indices each), oriented outwards. Appends an error, and
/// returns nothing, for a mesh without volume; warnings for open edges and for inverted triangles (which are
/// turned, or the inside is determined by parity). `name` is the file name. Nothing, without an error, if
/// stopped.
std::shared_ptr<const StockBody> make_mesh_body(std::span<const double> positions,
                                                std::span<const std::uint32_t> triangles,
                                                const std::string& name, Diagnostics& diagnostics,
                                                Progress* progress = nullptr);
std::shared_ptr<const StockBody> make_columns_body(LeftColumns columns);

/// The triangles of a body, of which make_mesh_body makes the same body again.
struct BodyMesh {
  std::string name;
  std::vector<double> positions;         // x y z, mm
  std::vector<std::uint32_t> triangles;  // three indices each
};
/// Nothing for columns.
std::optional<BodyMesh> mesh_of(const StockBody& body);
/// Nullptr for a mesh.
const LeftColumns* columns_of(const StockBody& body);

/// The stock of a body: its block is the bounds of the body.
Stock stock_of(std::shared_ptr<const StockBody> body);
/// The stock and its block after a move.
Stock moved(const Stock& stock, StockMove move);

/// Distances of points from the surface of a mesh.
class SurfaceDistance {
 public:
  /// Of a mesh body, which must outlive this; for columns all distances are infinite.
  explicit SurfaceDistance(const StockBody& body);
  ~SurfaceDistance();
  /// mm; at most `limit`, which shortens the search.
  double at(Point3 p, double limit) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace kerf
