// Depth per pass for a finished toolpath: each chain of cuts that goes deeper than the stepdown is cut in
// passes.
//
//   Diagnostics diagnostics;
//   const auto deeper = step_down(path, {.top = 0, .stepdown = mm(2)}, diagnostics);
//
// A chain is what is cut between two rapids. Every pass but the last is the chain with all heights below the
// level of the pass raised to that level, so a curved floor is approached in steps; the last is the chain
// itself. With ramps, a chain that starts with a descent at one point goes down back and forth along its
// first level part instead. A chain that ends where it starts continues down there, after another one the
// tool rises to the height of the rapid that led to it. All other steps are kept, with their origins.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/limits.h"
#include "kerf/op/leads.h"
#include "kerf/op/operation.h"
#include "kerf/tolerance.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

struct StepDownOptions {
  double top = 0.0;   ///< Z of the surface of the material
  Length stepdown{};  ///< maximum depth of a pass; the passes of a chain have the same depth. 0: one pass
  /// plunge: as the chain has it; ramp: along its first level part; helix: beside its start, where that
  /// crosses neither the chain nor a closed path, else as ramp.
  EntryKind entry = EntryKind::plunge;
  Angle entry_angle = degrees(3);                ///< maximum descent of a ramp or helix
  Length helix_radius{};                         ///< of the axis; required for a helix
  PartSide part = PartSide::right;               ///< a helix is on the other side of the path
  std::vector<std::size_t> whole{};              ///< first steps of chains that are cut as they are, in order
  Length chord = default_tolerance::kPostChord;  ///< of chords that replace an arc which is raised in part
  std::size_t max_steps = limits::kMaxPathSteps;
};
/// Nothing, with an error, for options out of range (code pass_option), and for a chain with an unknown
/// position, a rotary axis or a probed height (pass_refused).
std::optional<Toolpath> step_down(const Toolpath& path, const StepDownOptions& options,
                                  Diagnostics& diagnostics);

}  // namespace kerf
