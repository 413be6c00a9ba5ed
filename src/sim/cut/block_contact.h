// Whether sweeps touch a block that nothing may touch: by the tool's and the block's shapes alone, so that no
// contact slips between two columns.
#pragma once

#include <vector>

#include "sim/sweep/sweep.h"

namespace kerf::sim {

/// Appends what a sweep touches of the block that reaches from the frame's origin to `size` and of which it
/// takes nothing away: at most one contact a part of the tool, of a rapid at most one. Contacts that are no
/// longer than `hazard_depth` in height are none. How much is met (Contact::removed) is left at 0.
void note_block_contacts(const Sweep& sweep, const ToolSolids& tool, Point3 size, double hazard_depth,
                         std::vector<Contact>& contacts);

}  // namespace kerf::sim
