// Compares a cut part with the target mesh: gouges, where material of the target was removed, and rests,
// where material is left outside the target.
//
// Both are compared on the part's columns. The depth of a difference is the largest distance of its points
// from the target's surface: a wall that is off by 0.1 mm has a depth of 0.1 mm whatever its height. Along
// the columns' centre lines the comparison is exact; between two columns walls are only known to half a
// pitch.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/sim/render.h"
#include "kerf/sim/workpiece.h"
#include "kerf/stock/stock.h"

namespace kerf {

enum class DifferenceKind : std::uint8_t { gouge, rest };
std::string_view to_string(DifferenceKind kind);

struct CompareOptions {
  Length tolerance = default_tolerance::kComparison;  // smaller differences are not reported
  std::size_t max_regions = 50;                       // reported, the deepest ones
};

/// Neighbouring columns with the same kind of difference.
struct DifferenceRegion {
  DifferenceKind kind{};
  Length depth;   // largest distance from the target's surface
  Point3 at;      // mm, its position
  Volume volume;  // beyond the tolerance
  Box3 bounds;    // mm
  std::size_t columns = 0;
};

struct Comparison {
  Volume target, part;                    // both measured on the columns
  Volume gouge, rest;                     // of all differences, including those within the tolerance
  Volume gouge_beyond, rest_beyond;       // of those beyond the tolerance
  std::size_t region_count = 0;           // all, also those that are not in `regions`
  std::vector<DifferenceRegion> regions;  // deepest first
  int nx = 0, ny = 0;
  /// Per column (j * nx + i), mm: depth of its largest difference beyond the tolerance, negative for a gouge;
  /// 0 if there is none.
  std::vector<float> map;
  /// Whether the target has material on the column.
  std::vector<bool> in_target;
};

/// Appends an error and returns nothing if the columns of the target cannot be computed; appends a warning if
/// the target extends beyond the stock. If stopped, nothing without an error.
std::optional<Comparison> compare(const Workpiece& part, const StockBody& target,
                                  const CompareOptions& options, Diagnostics& diagnostics,
                                  Progress* progress = nullptr);

/// The map from above, one pixel or more per column, or several columns per pixel: the target green, gouges
/// red, rests blue, fully saturated from a depth of `full`. At most `max_pixels` pixels per side.
Image draw_map(const Comparison& comparison, Length full, int max_pixels);
/// The colour of a depth in that map.
std::array<std::uint8_t, 3> difference_colour(double depth, Length full);

}  // namespace kerf
