// Contacts of sweeps with a block that must not be touched, from the shapes of tool and block alone, so that
// no contact is lost between two columns.
#pragma once

#include <vector>

#include "sim/sweep/sweep.h"

namespace kerf::sim {

/// Appends the contacts of a sweep with the block from the frame's origin to `size`, of which nothing is
/// removed: at most one contact per part of the tool, for a rapid at most one in all. Contacts with a height
/// up to `hazard_depth` are ignored. Contact::removed stays 0.
void note_block_contacts(const Sweep& sweep, const ToolSolids& tool, Point3 size, double hazard_depth,
                         std::vector<Contact>& contacts);

}  // namespace kerf::sim
