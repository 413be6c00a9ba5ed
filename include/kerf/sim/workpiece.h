// The workpiece as the simulator keeps it: a grid of vertical columns of material.
//
// Each column is a few intervals [low, high] in z, so that undercuts are exact. Every end of an interval has
// the index of the step that made it. See docs/decisions/0005-simulator-engine.md.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"
#include "kerf/stock/stock.h"

namespace kerf {

/// The step of a surface that no step made: the stock's own faces.
inline constexpr std::uint32_t kStockSurface = 0xffffffffu;

/// One vertical run of material in a column. low_step and high_step are indices of the steps that made its
/// ends, or kStockSurface.
struct Interval {
  float low = 0.0f;   // mm above the workpiece's floor
  float high = 0.0f;  // mm above the workpiece's floor
  std::uint32_t low_step = kStockSurface;
  std::uint32_t high_step = kStockSurface;
};

/// A copy of the columns as plain arrays: column (i, j) is number j * nx + i and owns the intervals
/// first[number] to first[number + 1] - 1, lowest first. Its centre is at bounds.low.x + column_x(i), y
/// likewise; heights are relative to bounds.low.z. Where the pitch does not divide the block, the last column
/// of a row is narrower and its centre is that of the remaining width, so that no column is outside the
/// block.
struct ColumnGrid {
  Box3 bounds;         // mm, the stock's block
  double pitch = 0.0;  // mm
  int nx = 0, ny = 0;
  std::vector<std::uint32_t> first;
  std::vector<Interval> intervals;
  /// Empty, or one per column: of a column without material the step that removed the last of it, which made
  /// the walls around a through cut; else unspecified.
  std::vector<std::uint32_t> cut_through = {};

  /// Position of the centre of column i or j, mm from the block's low side.
  double column_x(int i) const;
  double column_y(int j) const;
};

/// The material during and after cutting, as columns.
class Workpiece {
 public:
  Workpiece(const Stock& stock, Length pitch);
  Workpiece(Workpiece&&) noexcept;
  Workpiece& operator=(Workpiece&&) noexcept;
  ~Workpiece();

  const Box3& bounds() const;  // mm, the stock's block
  Length pitch() const;
  int columns_x() const;
  int columns_y() const;
  /// The material of a column, lowest first; empty where all of it is removed.
  std::vector<Interval> column(int i, int j) const;
  ColumnGrid grid() const;
  Volume volume() const;

  struct Body;
  Body& body() { return *body_; }
  const Body& body() const { return *body_; }

 private:
  std::unique_ptr<Body> body_;
};

/// The workpiece as the stock of a following job (make_columns_body), without the steps that made its
/// surfaces.
LeftColumns left_columns(const Workpiece& workpiece);

}  // namespace kerf
