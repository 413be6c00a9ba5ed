// Tabs of one path: where they are, and the motions that rise over them.
#pragma once

#include <vector>

#include "op/base/track.h"

#include "kerf/op/operation.h"

namespace kerf::op_detail {

/// A tab by its centre on the path of the axis.
struct Tab {
  Point2 at;
  double bottom = 0.0;  // Z
};
/// False, with an error, where options are out of range.
bool valid(const TabOptions& options, Length diameter, Diagnostics& diagnostics);
/// The tabs of a closed path, fewer with a warning where it is short.
std::vector<Tab> tabs_along(const Track& track, double bottom, const TabOptions& options, Length diameter,
                            const Origin& where, Diagnostics& diagnostics);
/// The path with all cuts risen over tabs that they come within `reach` of (mm). Nothing, with an error,
/// where it has too many steps.
std::optional<Toolpath> over_tabs(const Toolpath& path, std::vector<Tab> tabs, double reach,
                                  const TabOptions& options, Length diameter, Diagnostics& diagnostics);

}  // namespace kerf::op_detail
