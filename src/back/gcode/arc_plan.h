// How an arc is written: as arcs that are still consistent after rounding, or as chords.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kerf/geom/geometry.h"
#include "kerf/program/post.h"

namespace kerf::gcode {

/// A position in units of the last decimal that is written.
using Counts = std::array<std::int64_t, 3>;

/// Converts mm to counts, with one scale for all axes.
struct Grid {
  double counts_per_mm = 1000.0;
  std::int64_t count(double value) const {
    const double scaled = value * counts_per_mm;
    return static_cast<std::int64_t>(scaled + (scaled < 0.0 ? -0.5 : 0.5));
  }
  Counts counts(Point3 p) const { return {count(p.x), count(p.y), count(p.z)}; }
};

/// A chord or an arc in counts.
struct ArcSegment {
  Counts to{};
  std::int64_t u = 0, v = 0;  // from its start to its centre, along the plane's axes (axes_of)
};

enum class ArcForm : std::uint8_t { arcs, chords, straight };

struct ArcPlan {
  ArcForm form = ArcForm::straight;
  bool uneven = false;               // its radii differ by more than controllers permit
  std::vector<ArcSegment> segments;  // chords have no centre
};

/// Plans the arc `walk` with the start point `from` and the end point `to` as written. `plan` can be reused.
void plan_arc(const ArcWalk& walk, const Counts& from, const Counts& to, const Grid& grid,
              const PostProfile& profile, ArcPlan& plan);

}  // namespace kerf::gcode
