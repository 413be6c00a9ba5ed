// What a sweep meets that it should not: the passes over a tile, and the notes that are taken column by
// column. No part of the inner loops: most jobs never come here.
#pragma once

#include "sim/kernel/local_sweep.h"

namespace kerf::sim {

/// A pass over a tile: one solid, and what its meeting material means.
struct Pass {
  const LaneSolid* solid = nullptr;
  bool is_hazard = false;
  HazardKind kind{};
  Real ignore = 0;        // contacts up to this length are left alone
  Real report_above = 0;  // a depth
};

/// The passes of a sweep, in order: at most the cutting part, the flutes' end and three parts of the body.
struct PassList {
  Pass pass[6];
  int count = 0;
};
PassList list_passes(const Sweep& sweep, const LaneTool& tool, Real ignore);

/// The columns of a micro and what a solid takes from each, in the frame of the sweep's view.
struct MicroContact {
  int micro = 0;
  Lanes x, y;       // places
  Lanes weight;     // shares in the block
  Lanes low, high;  // what is swept
};

/// Notes the contacts of a micro and leaves in `low` and `high` only what is to be taken away.
void note_contacts(const TileJob& job, const Sweep& sweep, const LocalSweep& view, const Pass& pass,
                   MicroContact& columns, Contact& contact);
/// Keeps what a pass has found, if anything.
void keep_contact(const TileJob& job, const Pass& pass, Contact& contact);

}  // namespace kerf::sim
