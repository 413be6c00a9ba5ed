// The simulator for a fourth axis: a round bar that A turns about X, by indexes between cuts or while
// cutting.
//
// The workpiece is a grid of rays that stand on the bar's axis: so far along it, so far around it. Each ray
// has runs of material, as the columns of the plane simulator have, so that flats, wrapped engravings, holes
// from all sides and undercuts are one model, cut in time order without ever being sampled anew.
//
// The tool's axis is Z. As the right-hand rule says, a positive A takes the tool round the bar from Z+
// towards Y-, which is how most tables with a turning workpiece are set up (the bar itself turns the other
// way).
//
// A motion is cut as a row of standing tools that are half the rays' distance apart, at the bar's surface
// too: what is left between two of them is below (distance / 2)^2 / (8 r) on a surface of radius r, and
// (distance / 4) / tan(half angle) at the tip of a pointed tool.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/hazard.h"
#include "kerf/mesh.h"
#include "kerf/progress.h"
#include "kerf/round_bar.h"
#include "kerf/simulation_options.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"
#include "kerf/workpiece.h"

namespace kerf {

/// The material left, ray by ray: ray (i, j) stands at x_low + (i + 0.5) * dx, at A = (j + 0.5) * 360 /
/// around degrees, and is number j * along + i.
struct RotaryWorkpiece {
  RoundBar bar;
  int along = 0, around = 0;
  double dx = 0.0;                          // mm
  std::vector<std::vector<Interval>> rays;  // low and high: mm from the axis

  Volume volume() const;
};

struct RotarySimulation {
  RotaryWorkpiece workpiece;
  Volume stock, removed;
  std::vector<Hazard> hazards;         // in order of steps; places are in work coordinates as they were then
  std::vector<float> removed_by_step;  // mm3
  double seconds = 0.0;
  bool stopped = false;
};

/// Cuts a toolpath out of a bar. `options.resolution` is the rays' distance, along the bar and at its
/// surface; 0 chooses one of about a hundred thousand rays, from 0.02 to 1 mm. Hazards are those of
/// `simulate` but for below_floor. B and C are left out, with a warning. Errors as `simulate`'s, and
/// rotary_limit for more motion than is cut in hours.
std::optional<RotarySimulation> simulate_rotary(const Toolpath& path, const ToolTable& tools,
                                                const RoundBar& bar, const SimulationOptions& options,
                                                Diagnostics& diagnostics, Progress* progress = nullptr);

/// The surface of what is left, at A = 0. Closed; along A = 0 two faces lie upon each other inside the
/// material.
Mesh extract_mesh(const RotaryWorkpiece& workpiece, Progress* progress = nullptr);
/// What that should hold, as of columns.
VolumeRange mesh_volume(const RotaryWorkpiece& workpiece);

}  // namespace kerf
