// Compares a cut part with the target mesh: gouges, where material of the target was removed, and rests,
// where material is left outside the target.
//
// Both are compared on the part's columns. The depth of a difference is the largest distance of its points
// from the target's surface: a wall that is off by 0.1 mm has a depth of 0.1 mm whatever its height. Along
// the columns' centre lines the comparison is exact. Between two columns walls are only known to half a
// pitch; of a simulation, columns at walls are compared by its exact mesh, at points all over their squares.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/base/tolerance.h"
#include "kerf/sim/render.h"
#include "kerf/sim/simulate.h"
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
  Volume target, part;  // both measured on the columns, and at the points at walls
  Volume gouge, rest;   // of all differences, including those within the tolerance
  /// Of those beyond the tolerance. Beside the target's wall a difference is within the tolerance; it counts
  /// if it is longer in Z than the tolerance and at most the tolerance, rounded up to whole columns, away
  /// from where the difference is deeper.
  Volume gouge_beyond, rest_beyond;
  std::size_t region_count = 0;           // all, also those that are not in `regions`
  std::vector<DifferenceRegion> regions;  // deepest first
  int nx = 0, ny = 0;
  /// Per column (j * nx + i), mm: depth of its largest difference beyond the tolerance, negative for a gouge;
  /// 0 if there is none.
  std::vector<float> map;
  /// Whether the target has material on the column.
  std::vector<bool> in_target;
};

/// Compares the columns at walls at 256 points each, or at fewer, down to 2, the longer the walls, and takes
/// depths from the walls of the exact mesh. Takes the time of extract_exact_mesh too, whose warnings it
/// appends. A difference between two walls that is narrower than a column is found if a wall of part or
/// target is found there by the columns (docs/decisions/0022-hazards-and-walls.md).
std::optional<Comparison> compare(const Simulation& part, const StockBody& target,
                                  const CompareOptions& options, Diagnostics& diagnostics,
                                  Progress* progress = nullptr);
/// Of the columns' centre lines alone: volumes and depths at walls are uncertain by half a pitch.
///
/// Both append an error and return nothing if the columns of the target cannot be computed; appends a warning
/// if the target extends beyond the stock. If stopped, nothing without an error.
std::optional<Comparison> compare(const Workpiece& part, const StockBody& target,
                                  const CompareOptions& options, Diagnostics& diagnostics,
                                  Progress* progress = nullptr);

/// The map from above, one pixel or more per column, or several columns per pixel: the target green, gouges
/// red, rests blue, fully saturated from a depth of `full`. At most `max_pixels` pixels per side.
Image draw_map(const Comparison& comparison, Length full, int max_pixels);
/// The colour of a depth in that map.
std::array<std::uint8_t, 3> difference_colour(double depth, Length full);

}  // namespace kerf
