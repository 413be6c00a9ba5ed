// How long a machine takes for a toolpath, as its controller plans it: acceleration, slower corners, and a
// look-ahead of few moves that brakes where moves are short.
//
//   TimeEstimate time = estimate_time(path, machine);
//   time.all.motion.seconds();
//
// The model is that of GRBL's page "Grbl v1.1 Configuration" ($11, $12, $110-$122): straight moves with
// constant acceleration, limited on each axis; the speed through a corner from the junction deviation; arcs
// as chords; a ring of planned moves of which the last ends at rest, filled again whenever a move is done (an
// infinitely fast sender). Spindle, coolant, pauses, dwells, tool changes and shifts of the zero bring the
// machine to rest where they change something. Feeds are those of the program; overrides stand at 100%.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kerf/machine.h"
#include "kerf/toolpath.h"
#include "kerf/units.h"

namespace kerf {

/// Times of a part of a toolpath.
struct TimeFigures {
  Duration motion;  // moves alone, braking for stops included
  Duration rapid;   // of `motion`: rapids
  Duration dwell;   // told waits, as told
  Duration halts;   // Machine::stop_time of every stop
  std::size_t stops = 0;
  Duration cutting() const { return motion - rapid; }
  Duration total() const { return motion + dwell + halts; }
};

struct ToolTime {
  std::optional<int> tool;  // nothing: before the first tool change
  TimeFigures time;
};

/// A stretch of the toolpath that a tool change, a layer or a note begins.
struct OperationTime {
  std::string name;  // the layer's or the note's text; empty where there is none
  std::optional<int> tool;
  std::size_t first_step = 0;
  TimeFigures time;
};

struct TimeEstimate {
  TimeFigures all;
  std::vector<ToolTime> tools;            // in order of first use; a tool used again is one entry
  std::vector<OperationTime> operations;  // those that move; at most 1000, the last then holds the rest
  std::size_t moves = 0;                  // planned ones: chords of arcs each count
  std::size_t not_timed = 0;              // moves without a feed, and turns of rotary axes alone
};

TimeEstimate estimate_time(const Toolpath& path, const Machine& machine);

/// Seconds that each step takes, dwells included; one number a step.
std::vector<float> step_seconds(const Toolpath& path, const Machine& machine);

}  // namespace kerf
