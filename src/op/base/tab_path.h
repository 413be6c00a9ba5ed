// Tabs of one path: where they are, and the motions that rise over them.
#pragma once

#include <cstddef>
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
/// Paths that are too short for their tabs: one warning for all of them.
class ShortPaths {
 public:
  void add(const Track& track, double wanted, double has, const Origin& where);
  void report(Diagnostics& diagnostics) const;

 private:
  std::size_t count_ = 0;
  double length_ = 0.0, wanted_ = 0.0, has_ = 0.0;  // of the shortest, mm and numbers of tabs
  Point2 at_;
  Origin where_;
};
/// The tabs of a closed path, fewer where it is short.
std::vector<Tab> tabs_along(const Track& track, double bottom, const TabOptions& options, Length diameter,
                            const Origin& where, ShortPaths& short_paths);
/// The path with all cuts risen over tabs that they come within `reach` of (mm). Nothing, with an error,
/// where it has too many steps.
std::optional<Toolpath> over_tabs(const Toolpath& path, std::vector<Tab> tabs, double reach,
                                  const TabOptions& options, Length diameter, Diagnostics& diagnostics);

}  // namespace kerf::op_detail
