// Passes: a toolpath made better without changing what it cuts by more than a tolerance.
//
// Each takes a toolpath and returns a new one with the saving. Origins are kept: a step that stands for
// several has the origin of the first of them. Only neighbouring motions with equal feeds are put together;
// any other step, a rotary axis, a height to be probed or an unknown place between them ends a chain.
//
//   PassResult fitted = fit_arcs(path, {.tolerance = mm(0.01)});
//   // fitted.path, fitted.before.steps, fitted.after.steps
#pragma once

#include <cstddef>

#include "kerf/tolerance.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

struct PassFigures {
  std::size_t steps = 0;
  double cut_mm = 0.0, rapid_mm = 0.0;
};

struct PassResult {
  Toolpath path;
  PassFigures before, after;
};

/// Arcs become chains of straight cuts that stray at most `chord` from them.
PassResult arcs_to_chords(const Toolpath& path, Length chord);

struct ArcFitOptions {
  Length tolerance = default_tolerance::kArcFitting;  // of a chord's ends and midpoint from the arc
  Length largest_radius = mm(500);                    // flatter chains stay straight
  std::size_t fewest = 3;                             // chords that an arc stands for
};
/// Chains of straight cuts in a plane of the machine become arcs (also helices about Z) where every point of
/// the chain lies within the tolerance. Corners stay.
PassResult fit_arcs(const Toolpath& path, const ArcFitOptions& options);

/// Straight cuts, and rapids, that go on in one direction become one: no point that is left out lies farther
/// than `tolerance` from what replaces it, and none goes back.
PassResult join_straight(const Toolpath& path, Length tolerance);

/// Leaves out rapids that lead nowhere (to where the tool stands), and rapids straight up that are followed
/// by a rapid straight down again, as far as both go. No rapid goes where none went before.
PassResult shorten_rapids(const Toolpath& path);

}  // namespace kerf
