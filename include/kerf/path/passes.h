// Passes: optimise a toolpath without changing the cut by more than a tolerance.
//
// Each takes a toolpath and returns a new one with the saving. Origins are kept: a step that replaces
// several has the origin of the first of them. Only consecutive motions with equal feeds are joined; any
// other step, a rotary axis, a height to be probed or an unknown position between them ends a chain.
//
//   PassResult fitted = chords_to_arcs(path, {.tolerance = mm(0.01)});
//   // fitted.path, fitted.before.steps, fitted.after.steps
#pragma once

#include <cstddef>

#include "kerf/base/tolerance.h"
#include "kerf/base/units.h"
#include "kerf/path/toolpath.h"

namespace kerf {

struct PassFigures {
  std::size_t steps = 0;
  double cut_mm = 0.0, rapid_mm = 0.0;
};

struct PassResult {
  Toolpath path;
  PassFigures before, after;
};

/// Arcs become chains of straight cuts within `chord` of them.
PassResult arcs_to_chords(const Toolpath& path, Length chord);

struct ArcFitOptions {
  Length tolerance = default_tolerance::kArcFitting;  // of a chord's ends and midpoint from the arc
  Length largest_radius = mm(500);                    // flatter chains stay straight
  std::size_t fewest = 3;                             // chords replaced by an arc
};
/// Chains of straight cuts in a plane of the machine become arcs (also helices about Z) where every point of
/// the chain lies within the tolerance. Corners stay.
PassResult chords_to_arcs(const Toolpath& path, const ArcFitOptions& options);

/// Consecutive straight cuts, and rapids, in one direction become one: every removed point lies within
/// `tolerance` of the result, and the path never reverses.
PassResult join_straight(const Toolpath& path, Length tolerance);

/// Removes rapids of zero length, and the common part of a rapid straight up followed by a rapid straight
/// down. No rapid goes where none went before.
PassResult shorten_rapids(const Toolpath& path);

/// The path without a change of tools in its first step if nothing is cut with that tool: front ends start
/// with a default tool, for which a machine must not stop.
Toolpath without_unused_first_tool(const Toolpath& path);

}  // namespace kerf
