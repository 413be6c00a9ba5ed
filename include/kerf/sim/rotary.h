// The simulator for a fourth axis: a round bar that A turns about X, by indexing between cuts or while
// cutting.
//
// The workpiece is a grid of rays perpendicular to the axis of the bar, along the axis and around it. Each
// ray has runs of material, like the columns of the simulator for three axes, so that flats, wrapped
// engravings, holes from all sides and undercuts are one model, cut in time order without resampling.
//
// The tool axis is Z. By the right-hand rule a positive A moves the tool around the bar from Z+ towards Y-,
// the usual setup of a table that turns the workpiece (the bar itself turns the other way).
//
// A ray is cut once by each piece of a motion: the deepest position of the tool is found by a descent, to
// 0.2 um. Volumes at walls and edges are means over several rays.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/base/diagnostics.h"
#include "kerf/base/progress.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/mesh.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/sim/workpiece.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf {

/// The remaining material: ray (i, j) is at x_low + (i + 0.5) * dx and A = (j + 0.5) * 360 / around degrees,
/// and has number j * along + i.
struct RotaryWorkpiece {
  RoundBar bar;
  int along = 0, around = 0;
  double dx = 0.0;                          // mm
  std::vector<std::vector<Interval>> rays;  // low and high: mm from the axis
  double wall_volume = 0.0;                 // mm3, what the rays lack at walls

  Volume volume() const;
};

struct RotarySimulation {
  RotaryWorkpiece workpiece;
  Volume stock, removed;
  std::vector<Hazard> hazards;  // sorted by step; positions are in work coordinates at the time of the step
  std::vector<float> removed_by_step;  // mm3
  double seconds = 0.0;
  bool stopped = false;
};

/// Cuts a toolpath out of a bar. `options.resolution` is the distance of rays, along the bar and at its
/// surface; 0 chooses one for about a hundred thousand rays, from 0.02 to 1 mm, and for four million
/// where these are more. Hazards are those of `simulate` without below_floor. B and C are ignored with a
/// warning. Errors as of `simulate`, and rotary_limit for motions that would take hours.
std::optional<RotarySimulation> simulate_rotary(const Toolpath& path, const ToolTable& tools,
                                                const RoundBar& bar, const SimulationOptions& options,
                                                Diagnostics& diagnostics, Progress* progress = nullptr);

/// The surface of the remaining material, at A = 0. Closed: every edge has two triangles.
Mesh extract_mesh(const RotaryWorkpiece& workpiece, Progress* progress = nullptr);
/// The volume that this mesh should have.
VolumeRange mesh_volume(const RotaryWorkpiece& workpiece);

}  // namespace kerf
