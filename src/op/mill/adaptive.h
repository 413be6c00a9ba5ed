// Clearing with a limit of the engagement angle: rings, fronts and trochoidal loops that grow from an entry.
#pragma once

#include <optional>
#include <vector>

#include "op/base/cutter.h"

#include "kerf/geom/region.h"

namespace kerf::op_detail {

/// A motion of the axis on one level: down a helix, or along a path.
struct AdaptiveRun {
  std::optional<Circle> entry;  ///< of the axis; then `path` is empty
  Outline path{};
  bool linked = false;  ///< straight from the end of the run before, through what is cleared
};

struct AdaptivePlan {
  std::vector<AdaptiveRun> runs;
  Region left;    ///< of what the tool could reach: where the engagement would be above the limit
  Region narrow;  ///< where the axis could be, in slots too narrow for the limit; not their corners
};

struct AdaptiveOptions {
  double radius = 0.0;    ///< of the tool, mm
  double limit = 0.0;     ///< of the engagement angle, radians
  double max_step = 0.0;  ///< distance of neighbouring paths, mm
};

/// The diameter of a slot's inscribed circle over that of the tool, below which slots are not entered.
inline constexpr double kNarrowestSlot = 1.125;

/// Clears all that the axis reaches in `axis`. Nothing, with an error, where it cannot be computed, and
/// without one where it was stopped.
std::optional<AdaptivePlan> plan_adaptive(const Region& axis, const AdaptiveOptions& adaptive,
                                          const CutOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::op_detail
