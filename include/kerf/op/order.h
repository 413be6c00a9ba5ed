// The order of cuts: short rapids, and inner contours before those around them.
//
//   const Ordered made = order_cuts(path, {{1, mm(6)}});
//
// What is cut between two motions at the height of the highest rapid is a block. Blocks are put in another
// order within the steps of one tool and one spindle speed. Two blocks whose cuts come as near to each other
// as the tool is wide stay in their order (passes of one contour, a pocket in a pocket); of others, what lies
// inside a closed contour is cut before it.
#pragma once

#include <cstddef>
#include <map>

#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

struct Ordered {
  Toolpath path;
  std::size_t blocks = 0;     ///< that could be ordered
  double rapid_before = 0.0;  ///< mm, of rapids between blocks
  double rapid_after = 0.0;
};
/// `diameters`: of the tools by number; one that is missing counts as 0.
Ordered order_cuts(const Toolpath& path, const std::map<int, Length>& diameters);

}  // namespace kerf
