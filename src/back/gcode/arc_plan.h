// How an arc is written: as arcs whose rounded words still close, or as chords.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kerf/geometry.h"
#include "kerf/post.h"

namespace kerf::gcode {

/// A place in whole counts of the last decimal that is written.
using Counts = std::array<std::int64_t, 3>;

/// Turns mm into counts. One scale for all three axes.
struct Grid {
  double counts_per_mm = 1000.0;
  std::int64_t count(double value) const {
    const double scaled = value * counts_per_mm;
    return static_cast<std::int64_t>(scaled + (scaled < 0.0 ? -0.5 : 0.5));
  }
  Counts counts(Point3 p) const { return {count(p.x), count(p.y), count(p.z)}; }
};

/// A chord or an arc in counts of the last digit that is written: integers, as the controller reads them.
struct ArcPiece {
  Counts to{};
  std::int64_t u = 0, v = 0;  // from its start to its centre, along the plane's axes (axes_of)
};

enum class ArcForm : std::uint8_t { arcs, chords, straight };

struct ArcPlan {
  ArcForm form = ArcForm::straight;
  bool uneven = false;           // its radii differ by more than controllers take
  std::vector<ArcPiece> pieces;  // chords have no centre
};

/// Plans the arc `walk` that begins at `from` as written and ends at `to` as written. `plan` is reused from
/// arc to arc.
void plan_arc(const ArcWalk& walk, const Counts& from, const Counts& to, const Grid& grid,
              const PostProfile& profile, ArcPlan& plan);

}  // namespace kerf::gcode
