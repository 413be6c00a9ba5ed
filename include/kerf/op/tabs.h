// Tabs: bridges of material that hold a part until all cuts are done. Where a tab is, the tool stays above
// it.
//
//   Diagnostics diagnostics;
//   const auto held = add_tabs(path, {.height = mm(1.5), .length = mm(6), .count = 4}, mm(6), diagnostics);
//
// Tabs are placed on the closed paths that are cut to the bottom, at equal distances and, if possible, on
// straight parts. All cuts along the same path that go below the top of a tab rise over it.
#pragma once

#include <cstddef>
#include <optional>

#include "kerf/base/diagnostics.h"
#include "kerf/base/limits.h"
#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

enum class TabShape : std::uint8_t {
  rectangular,  ///< the tool rises and descends straight
  triangular    ///< it rises and descends along the path: no stops, less material to remove
};
struct TabOptions {
  Length height{};   ///< above the bottom; 0: no tabs
  Length length{};   ///< of the material that remains, at the bottom; 0: the diameter of the tool
  int count = 4;     ///< on each path, unless `spacing` is given
  Length spacing{};  ///< distance of tabs along the path; 0: by `count`
  TabShape shape = TabShape::rectangular;
  Feed plunge{};  ///< maximum feed downwards; 0: half of the feed of the cut
  std::size_t max_steps = limits::kMaxPathSteps;
};
/// `diameter`: of the tool. Nothing, with an error (code pass_option), for options out of range; a path that
/// is too short for its tabs gets fewer, with a warning (pass_refused).
std::optional<Toolpath> add_tabs(const Toolpath& path, const TabOptions& options, Length diameter,
                                 Diagnostics& diagnostics);

}  // namespace kerf
