// The simulator: what a toolpath leaves of the stock, what it touches that it should not, and which step made
// which surface.
//
// What is left is a Workpiece (workpiece.h). Its surface is a mesh (mesh.h, with exact edges exact_mesh.h),
// which can be drawn (render.h).
#pragma once

#include <optional>
#include <vector>

#include "kerf/diagnostics.h"
#include "kerf/hazard.h"
#include "kerf/progress.h"
#include "kerf/simulation_options.h"
#include "kerf/stock.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"
#include "kerf/workpiece.h"

namespace kerf {

struct Simulation {
  Workpiece workpiece;
  Volume stock, removed;
  std::vector<Hazard> hazards;         // in order of steps
  std::vector<float> removed_by_step;  // mm3, one per step of the toolpath
  double seconds = 0.0;                // of the simulation alone
  bool stopped = false;                // interrupted: all is as it was at that moment
};

/// Cuts the toolpath out of the stock. Appends errors (unknown tool, too many columns) and returns nothing
/// where it cannot run. Steps without effect on material (dwell, notes) are skipped.
std::optional<Simulation> simulate(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                                   const SimulationOptions& options, Diagnostics& diagnostics,
                                   Progress* progress = nullptr);

}  // namespace kerf
