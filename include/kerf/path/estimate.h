// Machining time of a toolpath as planned by the controller: acceleration, slower corners, and a short
// look-ahead that brakes on short motions.
//
//   TimeEstimate time = estimate_time(path, machine);
//   time.all.motion.seconds();
//
// The model is that of GRBL's page "Grbl v1.1 Configuration" ($11, $12, $110-$122): straight motions with
// constant acceleration, limited on each axis; the speed through a corner from the junction deviation; arcs
// as chords; a queue of planned motions whose last one ends at rest, refilled after every motion (an
// infinitely fast sender). Changes of spindle and coolant, pauses, dwells, tool changes and changes of the
// work offset stop the machine. Feeds are those of the program; overrides are 100%.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kerf/base/units.h"
#include "kerf/path/machine.h"
#include "kerf/path/toolpath.h"

namespace kerf {

/// Times of a part of a toolpath.
struct TimeFigures {
  Duration motion;  // motions alone, including braking for stops
  Duration rapid;   // of `motion`: rapids
  Duration dwell;   // as programmed
  Duration halts;   // Machine::stop_time of every stop
  std::size_t stops = 0;
  Duration cutting() const { return motion - rapid; }
  Duration total() const { return motion + dwell + halts; }
};

struct ToolTime {
  std::optional<int> tool;  // nothing: before the first tool change
  TimeFigures time;
};

/// A section of the toolpath that a tool change, a layer or a note starts.
struct OperationTime {
  std::string name;  // text of the layer or note; may be empty
  std::optional<int> tool;
  std::size_t first_step = 0;
  TimeFigures time;
};

struct TimeEstimate {
  TimeFigures all;
  std::vector<ToolTime> tools;  // in order of first use; a tool used again is one entry
  std::vector<OperationTime>
      operations;         // those with motions; at most 1000, the last one then contains the rest
  std::size_t moves = 0;  // planned ones: chords of arcs each count
  /// Motions without a feed, and motions of rotary axes alone that are rapids or start at an unknown angle.
  /// Others of rotary axes alone take the time of their feed, from rest to rest, without acceleration.
  std::size_t not_timed = 0;
};

TimeEstimate estimate_time(const Toolpath& path, const Machine& machine);

/// Seconds per step, including dwells.
std::vector<float> step_seconds(const Toolpath& path, const Machine& machine);

}  // namespace kerf
