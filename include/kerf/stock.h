// The stock: the material before the first cut. Lengths in mm, work coordinates (program zero is 0, 0, 0).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/geometry.h"

namespace kerf {

class StockBody;

/// A block of material, or what a body (stock_body.h) has of it: an imported mesh, the left-over of a job.
struct Stock {
  Box3 block;                                       // mm, work coordinates
  std::shared_ptr<const StockBody> body = nullptr;  // nothing: the block is full
};

/// Where program zero lies on the block, in plan and in height.
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

/// A block of `size` (mm) with program zero at the named place.
Stock make_block(Point3 size, ZeroCorner corner, ZeroHeight height);
/// Reads "Lower-Left", "centre left", "TOPLEFT" ...: case, spaces and hyphens do not count, "center" is
/// "centre".
std::optional<ZeroCorner> parse_zero_corner(std::string_view name);
std::optional<ZeroHeight> parse_zero_height(std::string_view name);
/// The names as they are known, for messages: "lower-left", ... and "top", "bottom".
const std::vector<std::string>& zero_corner_names();
const std::vector<std::string>& zero_height_names();
/// Whether the block has a volume: finite and low below high in every axis.
bool is_solid(const Stock& stock);

/// Gathers what a program's comments say of the stock: "STOCK/BLOCK, L, W, H, OX, OY, OZ" (CutViewer: program
/// zero from the lowest corner) and "stockMin: x, y, z" with "stockMax: ...", in all the spacings seen in
/// real files (spec/gcodepreview.md sections 2 and 13).
class StockComments {
 public:
  /// True if the comment (without brackets) was one of the stock. Errors go to `diagnostics`. Plain numbers
  /// are mm times `scale` (25.4 in a program in inches); with a unit ("-12.7mm", "4in") they are what they
  /// say. A stockMin that is not below stockMax is passed over with a warning, and STOCK/BLOCK tells the
  /// stock then.
  bool read(std::string_view comment, double scale, const Origin& where, Diagnostics& diagnostics);
  /// The stock told, stockMin/stockMax first; nothing where the comments do not suffice.
  std::optional<Stock> stock() const;

 private:
  void check_corners(const Origin& where, Diagnostics& diagnostics);
  void check_agreement(const Origin& where, Diagnostics& diagnostics);

  std::optional<Point3> minimum_, maximum_;
  std::optional<Box3> block_;
};
/// The comments that describe a stock, without brackets: stockMin, stockMax, STOCK/BLOCK.
std::vector<std::string> write_stock_comments(const Stock& stock);

}  // namespace kerf
