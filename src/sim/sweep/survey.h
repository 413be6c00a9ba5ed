// The survey of a toolpath and its tools before the simulation starts.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "sim/sweep/sweep.h"

#include "kerf/base/diagnostics.h"
#include "kerf/path/toolpath.h"
#include "kerf/sim/simulation_options.h"
#include "kerf/stock/stock.h"
#include "kerf/tool/tool.h"

namespace kerf::sim {

/// Whether the spindle is stopped, as far as the program states it.
inline bool spindle_stopped(const MotionContext& motion) {
  return !motion.spindle_stated || motion.spindle.turn == SpindleTurn::off;
}
/// Whether an arc is swept along its path and not only at its end. Unknown X or Y of its start count as 0.
inline bool is_walked(const MotionContext& arc) {
  constexpr unsigned kZ = 4;
  return (arc.unknown_from & kZ) == 0;
}

/// The tools that cut, found before anything is cut so that a missing tool costs no time.
struct Survey {
  std::map<int, std::uint32_t> index;  // tool number to index in `solids`
  std::vector<ToolSolids> solids;
  std::vector<double> deepest;   // below the top of the stock, mm, of each
  std::optional<int> only_tool;  // of a table with one tool: used until the program chooses
  Surroundings surroundings;
  std::vector<std::size_t> covered;  // steps that are not cut, sorted: see covered.h
  bool judges_spindle = false;       // the program states the spindle and is not for a laser

  /// The tool number of a motion, if one was chosen or there is only one tool.
  std::optional<int> tool_of(const MotionContext& motion) const {
    return motion.tool ? motion.tool : only_tool;
  }
  /// Whether the motion cuts with the spindle stopped.
  bool spindle_off(const MotionContext& motion) const { return judges_spindle && spindle_stopped(motion); }
};

struct Setup {
  Length pitch;
  Survey survey;
};
/// Nothing, with an error appended, if the stock, the resolution or a tool is invalid.
std::optional<Setup> set_up(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                            const SimulationOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::sim
