// Compares a cut part with the mesh that it was to become: gouges, where material of the target is gone, and
// rests, where material stands that the target has not.
//
// Both are looked at on the part's columns. A difference's depth is how far its deepest point lies from the
// target's surface, so that a wall that is 0.1 mm off counts as 0.1 however high it is. A part that meets its
// target only touches it: walls between two columns are known to half a pitch, but what the columns' own
// lines say is exact.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/progress.h"
#include "kerf/render.h"
#include "kerf/stock_body.h"
#include "kerf/tolerance.h"
#include "kerf/workpiece.h"

namespace kerf {

enum class DifferenceKind : std::uint8_t { gouge, rest };
std::string_view to_string(DifferenceKind kind);

struct CompareOptions {
  Length tolerance = default_tolerance::kComparison;  // smaller differences are not reported
  std::size_t most_regions = 50;                      // the deepest are told
};

/// Neighbouring columns with the same kind of difference.
struct DifferenceRegion {
  DifferenceKind kind{};
  Length depth;   // largest distance from the target's surface
  Point3 at;      // mm, where that is
  Volume volume;  // deeper than the tolerance
  Box3 bounds;    // mm
  std::size_t columns = 0;
};

struct Comparison {
  Volume target, part;                    // both on the columns
  Volume gouge, rest;                     // of all differences, those within the tolerance too
  Volume gouge_beyond, rest_beyond;       // of those beyond it
  std::size_t region_count = 0;           // of all, told or not
  std::vector<DifferenceRegion> regions;  // deepest first
  int nx = 0, ny = 0;
  /// One a column (j * nx + i), mm: depth of its largest difference beyond the tolerance, below 0 for a
  /// gouge; 0 where there is none.
  std::vector<float> map;
  /// Whether the target has material on the column.
  std::vector<bool> in_target;
};

/// Appends an error and returns nothing where the target cannot tell its columns; a warning where it reaches
/// out of the stock. Nothing, without an error, if stopped.
std::optional<Comparison> compare(const Workpiece& part, const StockBody& target,
                                  const CompareOptions& options, Diagnostics& diagnostics,
                                  Progress* progress = nullptr);

/// The map from above, one pixel a column or a few: green the target, red gouges, blue rests, in full colour
/// from `full` on. At most `longest` pixels on a side.
Image draw_map(const Comparison& comparison, Length full, int longest);
/// The same colour for a depth of the map.
std::array<std::uint8_t, 3> difference_colour(double depth, Length full);

}  // namespace kerf
