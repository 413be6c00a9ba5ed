// What a simulation needs to know before it begins.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "sim/sweep/sweep.h"

#include "kerf/diagnostics.h"
#include "kerf/simulation_options.h"
#include "kerf/stock.h"
#include "kerf/tool.h"
#include "kerf/toolpath.h"

namespace kerf::sim {

/// Whether the spindle stands, as far as the program has said.
inline bool spindle_stands(const MotionContext& motion) {
  return !motion.spindle_stated || motion.spindle.turn == SpindleTurn::off;
}
/// Whether an arc is cut along its way, not just at its end: from X0 or Y0 where those are not known.
inline bool is_walked(const MotionContext& arc) {
  constexpr unsigned kZ = 4;
  return (arc.unknown_from & kZ) == 0;
}

/// Which tool cuts where, found before anything is cut so that a missing tool costs no time.
struct Survey {
  std::map<int, std::uint32_t> index;  // tool number to place in `solids`
  std::vector<ToolSolids> solids;
  std::optional<int> only_tool;  // of a table with one tool: used until the program chooses
  bool judges_spindle = false;   // the program says something of the spindle and is not for a laser

  /// The number of the tool of a motion, if one is told or there is only one.
  std::optional<int> tool_of(const MotionContext& motion) const {
    return motion.tool ? motion.tool : only_tool;
  }
  /// Whether what the motion cuts is cut by a spindle that stands.
  bool spindle_off(const MotionContext& motion) const { return judges_spindle && spindle_stands(motion); }
};

struct Setup {
  Length pitch;
  Survey survey;
};
/// Nothing, with an error appended, where the stock, the resolution or a tool will not do.
std::optional<Setup> set_up(const Toolpath& path, const ToolTable& tools, const Stock& stock,
                            const SimulationOptions& options, Diagnostics& diagnostics);

}  // namespace kerf::sim
