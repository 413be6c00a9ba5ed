// The passes of a sweep over a tile, and the recording of contacts column by column. Not part of the inner
// loops: few sweeps touch what they must not.
#pragma once

#include "sim/kernel/local_sweep.h"

namespace kerf::sim {

/// A pass over a tile: one solid, and the hazard that its contact with material is.
struct Pass {
  const LaneSolid* solid = nullptr;
  bool is_hazard = false;
  HazardKind kind{};
  Real ignore = 0;        // contacts up to this length are ignored
  Real report_above = 0;  // depth
};

/// The passes of a sweep, in order: at most the cutting part, the end of the flutes, and three other parts.
struct PassList {
  Pass pass[6];
  int count = 0;
};
PassList list_passes(const Sweep& sweep, const LaneTool& tool, Real ignore);

/// The columns of a micro and the interval of a solid over each, in the frame of the sweep's view.
struct MicroContact {
  int micro = 0;
  Lanes x, y;       // positions
  Lanes weight;     // fractions inside the block
  Lanes low, high;  // swept interval
};

/// Records the contacts of a micro and leaves in `low` and `high` only what is to be removed.
void note_contacts(const TileJob& job, const Sweep& sweep, const LocalSweep& view, const Pass& pass,
                   MicroContact& columns, Contact& contact);
/// Appends the contact of a pass, if there is one.
void keep_contact(const TileJob& job, const Pass& pass, Contact& contact);

}  // namespace kerf::sim
