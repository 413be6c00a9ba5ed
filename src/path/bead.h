// The cross-section of printed beads, which all that lays or writes them has in common.
//
// A rectangle with half circles at its sides, as in the Slic3r manual ("Flow math"):
//
//   area = (width - height) * height + pi * (height / 2)^2
#pragma once

#include "kerf/base/units.h"

namespace kerf {

/// The volume of a bead of this length in plan, width and height; height <= width.
Volume bead_volume(Length length, Length width, Length height);

}  // namespace kerf
