// The stock: the material before the first cut. Lengths in mm, work coordinates.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/geom/geometry.h"

namespace kerf {

class StockBody;

/// A block of material, or a body (stock_body.h) inside it: an imported mesh, left-over stock.
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

}  // namespace kerf
